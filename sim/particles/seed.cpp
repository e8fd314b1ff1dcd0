#include "sim/particles/seed.h"

#include "sim/core/units.h"
#include "sim/particles/seed_patterns.h"
#include "sim/shapes/volume.h"

#include <algorithm>
#include <cmath>

namespace sim {

namespace {

using Pattern = FillSettings::Pattern;

/// The pattern's own pitch [cells] (model-fluid 5.1, 5.2).
double ownSpacing(Pattern pattern)
{
    return pattern == Pattern::Reference ? 0.35355339059327379 : 0.4;
}

/// Some of the positions, chosen at random, in their old order.
std::vector<Vec3> chooseSome(const std::vector<Vec3>& positions, std::size_t count, const CounterRandom& random)
{
    struct Lot {
        std::uint64_t rank;
        std::size_t index;
        bool operator<(const Lot& other) const { return rank != other.rank ? rank < other.rank : index < other.index; }
    };
    std::vector<Lot> lots(positions.size());
    for (std::size_t i = 0; i < lots.size(); ++i) lots[i] = {random.bits(i), i};
    std::nth_element(lots.begin(), lots.begin() + count, lots.end());
    lots.resize(count);
    std::sort(lots.begin(), lots.end(), [](const Lot& a, const Lot& b) { return a.index < b.index; });
    std::vector<Vec3> chosen;
    for (const Lot& lot : lots) chosen.push_back(positions[lot.index]);
    return chosen;
}

Seeds seedReference(const SeedPlan& plan, const LiquidNearby& nearby)
{
    const double radius = nominalRadius(plan.fill, plan.dx);
    return {referencePlaces(plan, nearby.positions).free, 4.0 / 3.0 * kPi * radius * radius * radius};
}

}  // namespace

double packingOf(FillSettings::Pattern pattern)
{
    // Measured of the small dam break's column; it is 0.567 deep inside and more at the surface, onto which places are pulled.
    constexpr double kReference = 0.58;
    return pattern == Pattern::Reference ? kReference : 1.0;
}

double particleSpacing(const FillSettings& fill, double dx)
{
    return dx * (fill.spacing > 0.0 ? fill.spacing : ownSpacing(fill.pattern));
}

double nominalRadius(const FillSettings& fill, double dx)
{
    // 0.5103 makes the default lattice's radius equal to the default reference's.
    constexpr double kRadiusPerPitch = 0.5103;
    const double pitch = particleSpacing(fill, dx);
    return fill.pattern == Pattern::Reference ? pitch / std::sqrt(3.0) : kRadiusPerPitch * pitch;
}

double minimumDistance(const FillSettings& fill, double dx)
{
    const double pitch = particleSpacing(fill, dx);
    switch (fill.pattern) {
        case Pattern::Lattice:
            return pitch;
        case Pattern::Reference:
            return 0.57735 * pitch;
        case Pattern::Poisson:
            return kPoissonDistance * pitch;
        default:
            return 0.0;
    }
}

Shape regionOf(const SeedPlan& plan)
{
    std::vector<Shape> parts = {plan.source};
    parts.insert(parts.end(), plan.solids.begin(), plan.solids.end());
    return Shape::subtract(parts);
}

Inlet::Inlet(const Shape& region, const std::vector<Shape>& solids, const Vec3& moved, double pitch)
    : region_(region), solids_(Shape::unite(solids)), moved_(moved), length_(moved.norm()), pitch_(pitch)
{
}

bool Inlet::isInside(const Vec3& x) const
{
    return region_.distance(x) < -kOnSurface * pitch_;
}

/// Looks back along the way, never further at once than it is to the region or to a solid.
bool Inlet::hasPassed(const Vec3& x) const
{
    constexpr int kMostLooks = 256;
    constexpr double kLeastStep = 1.0e-3;  // [pitches]
    if (!(region_.distance(x) < length_) || isInside(x) || isInside(x - moved_)) return false;
    double back = 0.0;
    for (int look = 0; look < kMostLooks && back < length_; ++look) {
        const Vec3 y = x - (back / length_) * moved_;
        const double toSolid = solids_.distance(y);
        if (toSolid < 0.0) return false;
        if (isInside(y)) return true;
        back += std::max(kLeastStep * pitch_, std::min(region_.distance(y), toSolid));
    }
    return false;
}

double areaAcross(const Shape& region, const Vec3& direction, double length)
{
    // What is left when the region moves on: of one thinner than the length only a part, and less of it with shorter ones.
    constexpr int kHalvings = 8;
    constexpr double kSame = 1.0e-3;
    double area = 0.0;
    for (int halving = 0; halving < kHalvings; ++halving, length *= 0.5) {
        Eigen::Isometry3d along = Eigen::Isometry3d::Identity();
        along.translation() = length * direction.normalized();
        const double last = area, cell = 4.0 * length;
        area = (boundedVolume(region, cell) - boundedVolume(Shape::intersect({region, region.moved(along)}), cell)) / length;
        if (halving > 0 && std::abs(area - last) <= kSame * area) break;
    }
    return area;
}

Seeds seedParticles(const SeedPlan& plan, const LiquidNearby& nearby)
{
    if (plan.fill.pattern == Pattern::Reference) return seedReference(plan, nearby);
    const bool moves = !plan.velocity.isZero(0.0), darts = plan.fill.pattern == Pattern::Poisson;
    const Shape region = regionOf(plan);

    PatternPlaces places =
        darts ? poissonPlaces(plan, region, nearby.positions) : latticePlaces(plan, region, nearby.positions);
    const double count = moves && !darts ? meanLatticePlaces(plan, region) : static_cast<double>(places.count);
    if (!(count > 0.0)) return {{}, std::pow(particleSpacing(plan.fill, plan.dx), 3)};
    const double volume = (plan.regionVolume > 0.0 ? plan.regionVolume : boundedVolume(region, plan.dx)) / count;

    // Liquid that is packed more tightly than the pattern leaves gaps, too; filling all of them would make too much.
    const double room = std::max(0.0, static_cast<double>(places.count) - nearby.volumeInside / volume);
    const auto most = static_cast<std::size_t>(std::lround(room));
    if (places.free.size() > most)
        places.free = chooseSome(places.free, most, CounterRandom(plan.fill.seed, plan.stream, 1));
    return {std::move(places.free), volume};
}

}  // namespace sim
