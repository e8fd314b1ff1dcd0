#include "sim/sources/seed.h"

#include "sim/core/units.h"
#include "sim/shapes/volume.h"
#include "sim/sources/even_volumes.h"
#include "sim/sources/seed_patterns.h"

#include <algorithm>
#include <cmath>

namespace sim {

namespace {

using Pattern = FillSettings::Pattern;

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

/// Is the region laid once, where there is no liquid?
bool isNewBody(const SeedPlan& plan, const LiquidNearby& nearby) { return plan.velocity.isZero(0.0) && nearby.positions.empty(); }

void fillEvenly(const SeedPlan& plan, const Shape& region, Seeds& seeds)
{
    const double volume = seeds.volume * static_cast<double>(seeds.positions.size());
    seeds.volumes = evenVolumes(region, seeds.positions, volume, plan.dx, plan.gridOrigin);
}

Seeds seedReference(const SeedPlan& plan, const LiquidNearby& nearby)
{
    const double radius = nominalRadius(plan.fill, plan.dx);
    Seeds seeds{referencePlaces(plan, nearby.positions).free, 4.0 / 3.0 * kPi * radius * radius * radius, {}};
    if (isNewBody(plan, nearby) && !seeds.positions.empty()) fillEvenly(plan, regionOf(plan), seeds);
    return seeds;
}

}  // namespace

double packingOf(FillSettings::Pattern pattern)
{
    // Measured of the small dam break's column; it is 0.567 deep inside and more at the surface, onto which places are pulled.
    constexpr double kReference = 0.58;
    return pattern == Pattern::Reference ? kReference : 1.0;
}

double particleSpacing(const FillSettings& fill, double dx) { return dx * fill.pitch(); }

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
        case Pattern::Lattice: return pitch;
        case Pattern::Reference: return 0.57735 * pitch;
        case Pattern::Poisson: return kPoissonDistance * pitch;
        default: return 0.0;
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

bool Inlet::isInside(const Vec3& x) const { return region_.distance(x) < -kOnSurface * pitch_; }

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

namespace {

/// Parallel rays on a lattice over the shadow of a box.
struct RayLattice {
    Vec3 first, alongU, alongW, direction;  ///< first ray's beginning, before the box; from one to the next [cm]
    std::size_t countU = 0, countW = 0;
    double length = 0.0;  ///< length of the way that they have to go [cm]

    RayLattice(const Eigen::AlignedBox3d& box, const Vec3& unit, double pitch) : direction(unit)
    {
        // Along an axis the lattice lies along the others: the edges of boxes fall between rays.
        const Vec3 u = unit.cross(unit.cwiseAbs().maxCoeff() == std::abs(unit[2]) ? Vec3::UnitX() : Vec3::UnitZ()).normalized(), w = unit.cross(u);
        const Vec3 half = 0.5 * box.sizes();
        const auto reach = [&](const Vec3& axis) { return half.dot(axis.cwiseAbs()); };
        constexpr double kFinest = 512.0, kCoarsest = 32.0, kPerPitch = 8.0;
        const auto count = [&](double width) { return std::clamp(std::ceil(2.0 * width / pitch * kPerPitch), kCoarsest, kFinest); };
        countU = static_cast<std::size_t>(count(reach(u)));
        countW = static_cast<std::size_t>(count(reach(w)));
        alongU = 2.0 * reach(u) / static_cast<double>(countU) * u;
        alongW = 2.0 * reach(w) / static_cast<double>(countW) * w;
        length = 2.0 * reach(unit);
        first = box.center() - reach(unit) * unit - 0.5 * (static_cast<double>(countU) - 1.0) * alongU -
                0.5 * (static_cast<double>(countW) - 1.0) * alongW;
    }
    double area() const { return alongU.norm() * alongW.norm(); }
};

/// How often a ray comes into a region: it looks again where the surface may be at the soonest.
int entries(const Shape& region, const Vec3& begin, const Vec3& direction, double length, double leastStep)
{
    int count = 0;
    bool wasInside = false;
    for (double way = 0.0; way < length;) {
        const double distance = region.distance(begin + way * direction);
        const bool isInside = distance < 0.0;
        count += isInside && !wasInside;
        wasInside = isInside;
        way += std::max(leastStep, std::abs(distance));
    }
    return count;
}

}  // namespace

double areaAcross(const Shape& region, const Vec3& direction, double pitch)
{
    const Eigen::AlignedBox3d box = region.bounds();
    if (box.isEmpty()) return 0.0;
    const RayLattice rays(box, direction.normalized(), pitch);
    constexpr double kLeastStep = 1.0e-3;  // [pitches]: thinner regions may be missed
    return rays.area() * parallelSum(rays.countW, [&](std::size_t w) {
               int sum = 0;
               for (std::size_t u = 0; u < rays.countU; ++u)
                   sum += entries(region, rays.first + static_cast<double>(u) * rays.alongU + static_cast<double>(w) * rays.alongW, rays.direction,
                                  rays.length, kLeastStep * pitch);
               return static_cast<double>(sum);
           });
}

Seeds seedParticles(const SeedPlan& plan, const LiquidNearby& nearby)
{
    if (plan.fill.pattern == Pattern::Reference) return seedReference(plan, nearby);
    const bool moves = !plan.velocity.isZero(0.0), darts = plan.fill.pattern == Pattern::Poisson;
    const Shape region = regionOf(plan);

    PatternPlaces places = darts ? poissonPlaces(plan, region, nearby.positions) : latticePlaces(plan, region, nearby.positions);
    const double count = moves && !darts ? meanLatticePlaces(plan, region) : static_cast<double>(places.count);
    if (!(count > 0.0)) return {{}, std::pow(particleSpacing(plan.fill, plan.dx), 3), {}};
    const double regionVolume = plan.regionVolume > 0.0 ? plan.regionVolume : boundedVolume(region, plan.dx), volume = regionVolume / count;

    // Liquid that is packed more tightly than the pattern leaves gaps, too; filling all of them would make too much.
    const double room = std::max(0.0, static_cast<double>(places.count) - nearby.volumeInside / volume);
    const auto most = static_cast<std::size_t>(std::lround(room));
    if (places.free.size() > most) places.free = chooseSome(places.free, most, CounterRandom(plan.fill.seed, plan.stream, 1));
    Seeds seeds{std::move(places.free), volume, {}};
    constexpr double kTiled = 2.0e-3;  // of the region's volume: as exactly as that is measured
    if (isNewBody(plan, nearby) && std::abs(places.tiled - regionVolume) > kTiled * regionVolume) fillEvenly(plan, region, seeds);
    return seeds;
}

}  // namespace sim
