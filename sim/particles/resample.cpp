#include "sim/particles/resample.h"

#include "sim/core/check.h"
#include "sim/core/parallel.h"
#include "sim/core/random.h"
#include "sim/core/units.h"
#include "sim/particles/point_bins.h"
#include "sim/transfer/modes.h"

#include <cmath>
#include <limits>
#include <numeric>

namespace sim {

namespace {

// Bounds of the classes of mass relative to the nominal one: S | s | o | l | L.
constexpr double kSmallest = 0.5, kLight = 0.9, kHeavy = 1.1, kHuge = 2.0;
constexpr int kMostChildren = 8;
constexpr double kSpread = 0.75;  ///< of the room that the children have

enum Draw : std::uint64_t { kRotation = 0, kMerges = 3 };

using Velocity = std::array<Modes, kAxes>;

Velocity velocityOf(const LiquidParticles& particles, std::size_t p)
{
    Velocity v{};
    for (int a = 0; a < kAxes; ++a)
        for (int r = 0; r < particles.modeCount; ++r) v[a][r] = particles.mode(a, r)[p];
    return v;
}

void setVelocity(const Velocity& v, std::size_t p, LiquidParticles& particles)
{
    for (int a = 0; a < kAxes; ++a)
        for (int r = 0; r < particles.modeCount; ++r) particles.mode(a, r)[p] = v[a][r];
}

void setPosition(const Vec3& x, std::size_t p, LiquidParticles& particles)
{
    for (int a = 0; a < kAxes; ++a) particles.x[a][p] = x[a];
}

/// The particles for which isMeant(p), by their ids: what follows then does not depend on how they stand in the arrays.
template <class IsMeant>
std::vector<std::size_t> inOrderOfIds(const LiquidParticles& particles, IsMeant&& isMeant)
{
    std::vector<std::size_t> found;
    for (std::size_t p = 0; p < particles.count; ++p)
        if (isMeant(p)) found.push_back(p);
    std::sort(found.begin(), found.end(),
              [&](std::size_t a, std::size_t b) { return particles.id[a] < particles.id[b]; });
    return found;
}

/// n well-spaced points on the unit sphere with their centre in the middle: a ring, from 4 points on with two poles.
std::array<Vec3, kMostChildren> spreadPoints(int n)
{
    std::array<Vec3, kMostChildren> points;
    const int poles = n < 4 ? 0 : 2, ring = n - poles;
    for (int k = 0; k < ring; ++k) {
        const double angle = 2.0 * kPi * k / ring;
        points[k] = {std::cos(angle), std::sin(angle), 0.0};
    }
    for (int k = 0; k < poles; ++k) points[ring + k] = {0.0, 0.0, k == 0 ? 1.0 : -1.0};
    return points;
}

/// A rotation, all being equally likely: a unit quaternion from three numbers (Shoemake 1992).
Mat3 randomRotation(const CounterRandom& random, std::uint64_t id)
{
    const double u = random.uniform(id, kRotation), a = 2.0 * kPi * random.uniform(id, kRotation + 1),
                 b = 2.0 * kPi * random.uniform(id, kRotation + 2);
    const double s = std::sqrt(1.0 - u), t = std::sqrt(u);
    return Eigen::Quaterniond(t * std::cos(b), s * std::sin(a), s * std::cos(a), t * std::sin(b)).toRotationMatrix();
}

/// The first child takes the parent's place in the arrays. Each carries the parent's polynomial, seen from where it is,
/// less a constant so that their mean velocity is the parent's.
void split(const ResampleSettings& settings, const CounterRandom& random, std::size_t parent,
           LiquidParticles& particles, std::uint32_t& nextId)
{
    const double relative = particles.mass[parent] / settings.nominalMass;
    const int n = static_cast<int>(std::min<double>(std::ceil(relative), kMostChildren));
    const double oldRadius = settings.nominalRadius * std::cbrt(relative), newRadius = oldRadius / std::cbrt(n);
    const double distance = kSpread * std::max(newRadius, oldRadius - newRadius);
    const Mat3 rotation = randomRotation(random, particles.id[parent]);
    const auto points = spreadPoints(n);
    const Vec3 x = particles.position(parent), v = particles.velocity(parent);
    const Velocity velocity = velocityOf(particles, parent);
    if (n - 1 > static_cast<std::int64_t>(std::numeric_limits<std::uint32_t>::max() - nextId))
        throw RunError("splitting has made more particles than can be numbered (2^32)");

    std::array<std::size_t, kMostChildren> child{parent};
    std::iota(child.begin() + 1, child.begin() + n, particles.count);
    particles.resize(particles.count + n - 1);
    particles.mass[parent] /= n;
    Vec3 mean = Vec3::Zero();
    for (int k = 0; k < n; ++k) {
        const Vec3 offset = distance * (rotation * points[k]);
        if (k > 0) {
            particles.copy(parent, child[k]);
            particles.id[child[k]] = nextId++;
        }
        setPosition(x + offset, child[k], particles);
        Velocity seen;
        for (int a = 0; a < kAxes; ++a) seen[a] = shifted(offset / settings.dx, velocity[a]);
        setVelocity(seen, child[k], particles);
        mean += particles.velocity(child[k]) / n;
    }
    for (int k = 0; k < n; ++k)
        for (int a = 0; a < kAxes; ++a) particles.mode(a, 0)[child[k]] += v[a] - mean[a];
}

/// Give some of one particle's mass to another, which moves to the centroid of both and takes the mass-weighted average
/// of both polynomials, as seen from there, with the mean velocity that the momentum asks for. The giver keeps velocity
/// and place.
void give(double dx, double given, std::size_t from, std::size_t to, LiquidParticles& particles)
{
    const double kept = particles.mass[to], share = given / (kept + given);
    const Vec3 x = (1.0 - share) * particles.position(to) + share * particles.position(from);
    const Velocity giver = velocityOf(particles, from), taker = velocityOf(particles, to);
    Velocity merged;
    for (int a = 0; a < kAxes; ++a) {
        const Modes ofGiver = shifted((x - particles.position(from)) / dx, giver[a]),
                    ofTaker = shifted((x - particles.position(to)) / dx, taker[a]);
        for (int r = 0; r < kMaxModes; ++r) merged[a][r] = (1.0 - share) * ofTaker[r] + share * ofGiver[r];
        merged[a][0] += (1.0 - share) * meanOf(taker[a]) + share * meanOf(giver[a]) - meanOf(merged[a]);
    }
    setPosition(x, to, particles);
    setVelocity(merged, to, particles);
    particles.mass[to] += given;
    particles.mass[from] -= given;
}

/// Neighbours that may take from a particle, in the order of their ids.
std::vector<std::size_t> takers(const ResampleSettings& settings, const PointBins& bins,
                                const std::vector<Vec3>& places, std::size_t giver, const LiquidParticles& particles)
{
    const bool tiny = particles.mass[giver] < kSmallest * settings.nominalMass;
    const double reach = 2.0 * settings.nominalRadius;
    std::vector<std::size_t> found;
    bins.anyNear(places[giver], [&](std::size_t p) {
        const double relative = particles.mass[p] / settings.nominalMass;
        const bool takes =
            p != giver && relative > 0.0 && (tiny ? relative <= 1.0 : relative >= kSmallest && relative < kLight);
        if (takes && (places[p] - places[giver]).squaredNorm() < reach * reach) found.push_back(p);
        return false;
    });
    std::sort(found.begin(), found.end(),
              [&](std::size_t a, std::size_t b) { return particles.id[a] < particles.id[b]; });
    return found;
}

/// Particles that are below half of the nominal mass or well above it, and whose turn it is.
std::vector<std::size_t> givers(const ResampleSettings& settings, const CounterRandom& random,
                                const LiquidParticles& particles)
{
    return inOrderOfIds(particles, [&](std::size_t p) {
        const double relative = particles.mass[p] / settings.nominalMass;
        const bool gives = relative < kSmallest || (relative > kHeavy && relative <= kHuge);
        return gives && random.uniform(particles.id[p], kMerges) * settings.mergeInterval < 1.0;
    });
}

void merge(const ResampleSettings& settings, const CounterRandom& random, LiquidParticles& particles)
{
    const std::vector<std::size_t> turn = givers(settings, random, particles);
    if (turn.empty()) return;
    std::vector<Vec3> places(particles.count);
    for (std::size_t p = 0; p < particles.count; ++p) places[p] = particles.position(p);
    const PointBins bins(places, 2.0 * settings.nominalRadius);
    for (std::size_t p : turn) {
        const bool tiny = particles.mass[p] < kSmallest * settings.nominalMass;
        // One that has taken in the meantime may be neither any more.
        const double surplus = tiny ? particles.mass[p] : particles.mass[p] - settings.nominalMass;
        const std::vector<std::size_t> to = takers(settings, bins, places, p, particles);
        if (to.empty() || surplus <= 0.0) continue;
        for (std::size_t taker : to) give(settings.dx, surplus / static_cast<double>(to.size()), p, taker, particles);
        if (tiny) particles.mass[p] = 0.0;  // but for round-off it is
    }
}

/// Close the ranks: the order of those that remain is kept.
void removeMassless(LiquidParticles& particles)
{
    std::size_t kept = 0;
    for (std::size_t p = 0; p < particles.count; ++p) {
        if (particles.mass[p] == 0.0) continue;
        if (kept != p) particles.copy(p, kept);
        ++kept;
    }
    particles.resize(kept);
}

}  // namespace

bool needsResampling(const LiquidParticles& particles, double nominalMass)
{
    return parallelReduce(
        particles.count, false,
        [&](std::size_t p) {
            return particles.mass[p] < kLight * nominalMass || particles.mass[p] > kHeavy * nominalMass;
        },
        [](bool a, bool b) { return a || b; });
}

void resample(const ResampleSettings& settings, std::int64_t step, LiquidParticles& particles, std::uint32_t& nextId)
{
    const CounterRandom random(settings.seed, 0, static_cast<std::uint64_t>(step));
    for (std::size_t p :
         inOrderOfIds(particles, [&](std::size_t q) { return particles.mass[q] > kHuge * settings.nominalMass; }))
        split(settings, random, p, particles, nextId);
    merge(settings, random, particles);
    removeMassless(particles);
}

}  // namespace sim
