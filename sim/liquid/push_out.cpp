#include "sim/liquid/push_out.h"

#include "sim/core/parallel.h"
#include "sim/core/simd.h"
#include "sim/grid/seams.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numeric>
#include <optional>

namespace sim {

namespace {

using Places = std::array<AlignedArray<double>, kAxes>;  ///< coordinates of particles [cm]

constexpr int kRepeats = 2;             ///< the second for edges, and for distances that are only bounds
constexpr double kAcrossSeams = 2.0;    ///< as far a way out of solids that touch is looked for [cells]
constexpr int kContacts = 5;            ///< of a particle in one step: a corner has three surfaces, round ones are met again
constexpr double kResolution = 5.0e-3;  ///< of paths: thinner walls may be missed [cells]

/// The nearest place outside of all solids, a little in front.
Vec3 outside(const Obstacles& obstacles, double inFront, Vec3 x)
{
    const Vec3 start = x;
    for (int repeat = 0; repeat < kRepeats; ++repeat) {
        const double distance = obstacles.distance(x);
        if (distance >= 0.0) return x;
        x += (inFront - distance) * obstacles.normal(x);
    }
    if (obstacles.distance(x) >= 0.0) return x;
    // The shortest way out of one solid may lead into another that touches it.
    const std::optional<Vec3> surface = nearestSurface(obstacles, start, kAcrossSeams / kPushedInFront * inFront);
    return surface ? *surface + inFront * (*surface - start).normalized() : x;
}

/// What may be in front of some planes, and no further.
class Fronts {
 public:
    void add(const Vec3& normal, const Vec3& through)
    {
        normals_[count_] = normal;
        offsets_[count_++] = normal.dot(through);
    }
    bool hold(const Vec3& x, double tolerance) const
    {
        for (int n = 0; n < count_; ++n)
            if (normals_[n].dot(x) < offsets_[n] - tolerance) return false;
        return true;
    }
    /// The place in front of all of them that is nearest to x: on none, one, two or three of them. Nothing if there is none.
    std::optional<Vec3> nearest(const Vec3& x, double tolerance) const
    {
        std::optional<Vec3> best;
        for (unsigned chosen = 0; chosen < 1u << count_; ++chosen) {
            const std::optional<Vec3> place = std::popcount(chosen) > kAxes ? std::nullopt : onAll(chosen, x);
            if (place && hold(*place, tolerance) && (!best || (*place - x).squaredNorm() < (*best - x).squaredNorm())) best = place;
        }
        return best;
    }

 private:
    /// The place nearest to x on each of some planes; nothing if two of them are as good as parallel.
    std::optional<Vec3> onAll(unsigned chosen, Vec3 x) const
    {
        constexpr double kParallel = 1.0e-3;
        std::array<Vec3, kAxes> across;  // unit vectors, orthogonal to each other, that span the normals
        int count = 0;
        for (int n = 0; n < count_; ++n) {
            if ((chosen >> n & 1) == 0) continue;
            Vec3 free = normals_[n];
            for (int m = 0; m < count; ++m) free -= free.dot(across[m]) * across[m];
            if (free.norm() < kParallel) return std::nullopt;
            across[count] = free.normalized();
            x += (offsets_[n] - normals_[n].dot(x)) / normals_[n].dot(across[count]) * across[count];
            ++count;
        }
        return x;
    }

    std::array<Vec3, kContacts> normals_;
    std::array<double, kContacts> offsets_{};
    int count_ = 0;
};

/// Where a particle gets that wants to go from one place to another, along the surfaces that it meets.
/// @param normal  out: of the last of them
Vec3 slide(const Obstacles& obstacles, double dx, const Vec3& from, const Vec3& to, Vec3& normal)
{
    constexpr double kOnPlane = 1.0e-6;  // [cells]
    const double inFront = kPushedInFront * dx, resolution = kResolution * dx;
    Obstacles::Path way(from);
    Fronts fronts;
    Vec3 end = to, at = to;
    for (int n = 0; n < kContacts; ++n) {
        const auto contact = obstacles.firstContact(way, end, resolution);
        if (!contact) return end;
        normal = contact->normal;
        at = contact->x + inFront * normal;
        if (obstacles.distance(at) <= 0.0) at = contact->x;
        fronts.add(normal, contact->x + inFront * normal);
        way.addSegment(end, contact->share);
        const Vec3 along = fronts.nearest(to, kOnPlane * dx).value_or(at), moved = outside(obstacles, inFront, along);
        // Not out of one solid into or through another: that one is then met on the way.
        end = fronts.hold(moved, kOnPlane * dx) ? moved : along;
    }
    return obstacles.firstContact(way, end, resolution) ? at : end;
}

/// Take away the velocity towards the solid at a particle.
PushOutTotals stop(const Vec3& wall, const Vec3& normal, std::size_t p, LiquidParticles& particles, Vec3& onSolid)
{
    const Vec3 velocity = particles.velocity(p);
    const double towards = std::min(0.0, (velocity - wall).dot(normal)), mass = particles.mass[p];
    for (int a = 0; a < kAxes; ++a) particles.mode(a, 0)[p] -= towards * normal[a];
    onSolid = mass * towards * normal;
    return {0.5 * mass * towards * (2.0 * velocity.dot(normal) - towards), -mass * towards * wall.dot(normal), Vec3::Zero()};
}

PushOutTotals keepOut(const Obstacles& obstacles, double dx, const Places* before, std::size_t p, LiquidParticles& particles,
                      std::span<Impulse> onSolids)
{
    const Vec3 x = particles.position(p);
    Vec3 moved = x, normal = Vec3::Zero();
    if (before != nullptr) moved = slide(obstacles, dx, {(*before)[0][p], (*before)[1][p], (*before)[2][p]}, x, normal);
    if (normal.isZero() && obstacles.distance(moved) < 0.0) {
        normal = obstacles.normal(moved);
        moved = outside(obstacles, kPushedInFront * dx, moved);
    }
    if (normal.isZero()) return {};
    for (int a = 0; a < kAxes; ++a) particles.x[a][p] = moved[a];
    const Vec3 wall = obstacles.anyMoving() ? obstacles.velocity(moved) : Vec3(Vec3::Zero());
    Vec3 onSolid;
    PushOutTotals pushed = stop(wall, normal, p, particles, onSolid);
    onSolids[obstacles.nearest(moved)] += Impulse::at(moved, onSolid);
    if (!wall.isZero()) pushed.carried = particles.mass[p] * (moved - x);
    return pushed;
}

/// Places of eight particles in a row.
struct PlacePack {
    Pack x[kAxes];

    PlacePack(const Places& places, std::size_t first)
    {
        for (int a = 0; a < kAxes; ++a) x[a] = loadPack(places[a].data() + first);
    }
};

/// What all vessels leave, but for what is as good as at their walls.
struct InVessels {
    const Obstacles& obstacles;
    double margin;  ///< [cm]

    bool holds(const Vec3& x) const
    {
        return std::ranges::all_of(obstacles.vessels(), [&](const Obstacles::Vessel& v) { return v.holds(x, margin); });
    }
    PackMask holds(const PlacePack& at) const
    {
        PackMask held = ~PackMask{};
        for (const Obstacles::Vessel& vessel : obstacles.vessels()) {
            Pack furthest = broadcast(-1.0e300), squares = broadcast(0.0);
            for (int a = 0; a < kAxes; ++a) {
                const Pack beyond = absPack(at.x[a] - vessel.center[a]) - vessel.half[a], out = maxPack(beyond, broadcast(0.0));
                furthest = maxPack(furthest, beyond);
                squares += out * out;
            }
            const double within = vessel.round - margin;
            held &= within > 0.0 ? squares < within * within : furthest < within;
        }
        return held;
    }
};

/// A ball without solids.
struct ClearBall {
    Vec3 center;
    double radius;  ///< [cm]

    bool holds(const Vec3& x) const { return radius > 0.0 && (x - center).squaredNorm() < radius * radius; }
    PackMask holds(const PlacePack& at) const
    {
        Pack squares = broadcast(0.0);
        for (int a = 0; a < kAxes; ++a) squares += (at.x[a] - center[a]) * (at.x[a] - center[a]);
        return (squares < radius * radius) & (broadcast(radius) > 0.0);
    }
};

/// Call f(p) for those of the particles first … end − 1 that are, or were, not in what is clear of solids. Ways are straight: they are in it if both
/// ends are.
/// @param before  where they were; null if they have no way behind them
template <class Clear, class F>
void forEachNotIn(const Clear& clear, const Places& now, const Places* before, int first, int end, F&& f)
{
    for (int p = first; p < end; p += kLanes) {
        const int count = std::min(kLanes, end - p);
        unsigned clearOnes = 0;
        if (static_cast<std::size_t>(p) + kLanes <= std::min(now[0].size(), before != nullptr ? before->front().size() : now[0].size())) {
            PackMask held = clear.holds(PlacePack(now, p));
            if (before != nullptr) held &= clear.holds(PlacePack(*before, p));
            clearOnes = maskBits(held);
        } else
            for (int l = 0; l < count; ++l) {
                const auto placeIn = [&](const Places& x) { return Vec3(x[0][p + l], x[1][p + l], x[2][p + l]); };
                const bool isClear = clear.holds(placeIn(now)) && (before == nullptr || clear.holds(placeIn(*before)));
                clearOnes |= static_cast<unsigned>(isClear) << l;
            }
        for (unsigned left = ~clearOnes & ((1u << count) - 1); left != 0; left &= left - 1) f(static_cast<std::size_t>(p + std::countr_zero(left)));
    }
}

/// The largest ball around the middle of a cell, or of one beside it where solids rest, that no solid reaches. That of a cell in front of a wall leaves
/// of the cell at the wall a film only.
/// @param sweep  as far solids have moved near the block in this step [cm]
ClearBall clearAround(const CutGrid& cut, int block, const Vec3i& cell, double sweep)
{
    const double dx = cut.grid.dx;
    const Vec3 center = cut.grid.lowerCorner(block) + dx * (cell.cast<double>() + Vec3::Constant(0.5));
    if (!cut.field.nearSolid(block)) return {center, 0.0};
    ClearBall largest{center, cut.field.centerDistance(block)[cellInBlock(cell.x(), cell.y(), cell.z())] - sweep};
    for (int a = 0; a < kAxes && !cut.obstacles.anyMoving(); ++a)
        for (const double side : {-1.0, 1.0}) {
            const Vec3i at = cell + static_cast<int>(side) * Vec3i::Unit(a);
            const CellRef beside = cellNear(cut.grid, block, at.x(), at.y(), at.z());
            if (beside.block == cut.grid.count()) continue;
            const double radius = cut.field.centerDistance(beside.block)[beside.cell];
            if (radius > largest.radius) largest = {center + side * dx * Vec3::Unit(a), radius};
        }
    largest.radius /= cut.obstacles.steepest();
    return largest;
}

}  // namespace

PushOutTotals pushOutOfObstacles(const ParticleOrder& order, const CutGrid& cut, double farthest, const Places* before, LiquidParticles& particles,
                                 ChunkSums<Impulse>& onSolids)
{
    constexpr double kAtWall = 1.0e-6;  // [cells]
    const InVessels inVessels{cut.obstacles, kAtWall * cut.grid.dx};
    const auto ofBlock = [&](std::size_t n, std::span<Impulse> impulses) {
        const int b = order.occupied[n];
        PushOutTotals pushed;
        // Solids are known where they are now: on its way a particle has been no nearer to them than this.
        const double half = 0.5 * kBlockEdge * cut.grid.dx;
        const double sweep = cut.obstacles.anyMoving() ? cut.obstacles.farthestMove(cut.grid.lowerCorner(b) + Vec3::Constant(half), half) : 0.0;
        const double reach = farthest + sweep, safe = 0.5 * std::sqrt(3.0) * cut.grid.dx + reach;
        if (!cut.field.nearSolid(b) && reach < ObstacleField::kExactDistance * cut.grid.dx) return pushed;
        const bool onlyVessels = !cut.obstacles.reach(cut.grid.lowerCorner(b) + Vec3::Constant(half), half, reach, Obstacles::Which::NotVessels);
        for (int rank = 0; rank < kBlockCells; ++rank) {  // in the order of the particles in memory
            const Vec3i cell(rank >> 6, rank >> 3 & 7, rank & 7);
            const int* start = order.cells(b) + rank;
            if (start[0] == start[1]) continue;
            if (cut.field.nearSolid(b) && cut.field.centerDistance(b)[cellInBlock(cell.x(), cell.y(), cell.z())] > safe) continue;
            const auto keepOutOne = [&](std::size_t p) { pushed = pushed + keepOut(cut.obstacles, cut.grid.dx, before, p, particles, impulses); };
            // Vessels are convex and rest: who is in one now was in it all the way, or began in its wall.
            if (onlyVessels) forEachNotIn(inVessels, particles.x, nullptr, start[0], start[1], keepOutOne);
            else forEachNotIn(clearAround(cut, b, cell, sweep), particles.x, before, start[0], start[1], keepOutOne);
        }
        return pushed;
    };
    const Chunks chunks(order.occupied.size());
    std::array<PushOutTotals, kMaxChunks> partial;
    onSolids.begin(chunks.count(), cut.obstacles.count());
    parallelFor(chunks.count(), [&](std::size_t c) {
        for (std::size_t n = chunks.begin(c); n < chunks.end(c); ++n) partial[c] = partial[c] + ofBlock(n, onSolids.of(c));
    });
    return std::accumulate(partial.begin(), partial.begin() + chunks.count(), PushOutTotals{});
}

}  // namespace sim
