#include "sim/core/check.h"
#include "sim/sources/seed_patterns.h"

#include <cmath>
#include <limits>

namespace sim {

namespace {

constexpr double kMostAlong = 1 << 20;  ///< places
constexpr double kFlat = 0.02;          ///< how far from a plane what lies in it may be [pitches]

/// Place (0, 0, 0) of a pattern that does not move: half a pitch inside the source's bounds; with two places per cell,
/// a quarter cell inside of a cell of the grid.
Vec3 firstPlace(const SeedPlan& plan, double pitch)
{
    const Vec3 half = Vec3::Constant(0.5 * pitch), corner = plan.source.bounds().min();
    if (plan.fill.spacing != 0.5) return corner + half;
    const Vec3 places = ((corner - plan.gridOrigin) / pitch).array().floor();
    return plan.gridOrigin + pitch * places + half;
}

/// Where a ray along an axis first comes into a region, from `begin` on, no further than `length`; that where it does not [cm].
double entry(const Shape& region, const Vec3& begin, const Vec3& direction, double length, double pitch)
{
    constexpr double kLeastStep = 1.0e-3;  // [pitches]
    constexpr int kHalvings = 48;
    double outside = 0.0, way = 0.0;
    while (way < length && !(region.distance(begin + way * direction) < 0.0)) {
        outside = way;
        way += std::max(kLeastStep * pitch, region.distance(begin + way * direction));
    }
    if (!(way < length)) return length;
    for (int n = 0; n < kHalvings; ++n) {
        const double middle = 0.5 * (outside + way);
        (region.distance(begin + middle * direction) < 0.0 ? way : outside) = middle;
    }
    return way;
}

/// The plane across an axis that bounds a region within a box on one side: how far it is from that side of the box [cm]; infinite where less than
/// half of the region that is seen from there ends at a plane.
double planeFrom(const Eigen::AlignedBox3d& box, const Shape& region, int axis, bool isUpper, double pitch)
{
    constexpr std::size_t kMostRays = 32;  // along each side
    const int u = (axis + 1) % kAxes, v = (axis + 2) % kAxes;
    const Vec3 size = box.sizes();
    const auto rays = [&](int a) { return std::clamp<std::size_t>(static_cast<std::size_t>(std::lround(size[a] / pitch)), 1, kMostRays); };
    std::vector<double> found(rays(u) * rays(v));
    parallelFor(found.size(), 16, [&](std::size_t n) {
        Vec3 begin = isUpper ? box.max() : box.min();
        begin[u] = box.min()[u] + size[u] * (static_cast<double>(n % rays(u)) + 0.5) / static_cast<double>(rays(u));
        begin[v] = box.min()[v] + size[v] * (static_cast<double>(n / rays(u)) + 0.5) / static_cast<double>(rays(v));
        found[n] = entry(region, begin, (isUpper ? -1.0 : 1.0) * Vec3::Unit(axis), size[axis], pitch);
    });
    const double nearest = *std::ranges::min_element(found);
    const auto seen = std::ranges::count_if(found, [&](double way) { return way < size[axis]; }),
               flat = std::ranges::count_if(found, [&](double way) { return way < size[axis] && way < nearest + kFlat * pitch; });
    return 2 * flat > seen ? nearest : std::numeric_limits<double>::infinity();
}

/// Between two planes across an axis, as many layers as come nearest to the pitch, half of one away from both: liquid that fills a tank is then as
/// dense as it is to be from the floor to its level, and nothing has to move for that when the run begins.
void fitBetweenPlanes(const Eigen::AlignedBox3d& box, const Shape& region, double spacing, Vec3& first, Vec3& pitch)
{
    constexpr double kFits = 1.0e-6;  // [pitches]
    if (box.isEmpty() || !(box.sizes().maxCoeff() < kMostAlong * spacing)) return;
    for (int a = 0; a < kAxes; ++a) {
        const double low = planeFrom(box, region, a, false, spacing), high = planeFrom(box, region, a, true, spacing),
                     thickness = box.sizes()[a] - low - high;
        if (!(thickness > 0.0)) continue;
        const double layers = std::max(1.0, std::round(thickness / spacing));
        if (std::abs(thickness / spacing - layers) < kFits && low < kFits * spacing) continue;
        pitch[a] = thickness / layers;
        first[a] = box.min()[a] + low + 0.5 * pitch[a];
    }
}

/// A lattice, its places moved at random within their cubes if it is jittered, carried along by `shift`.
struct Sites {
    PlaceLattice lattice;
    CounterRandom random;
    bool jittered;

    /// @param ahead  how far beyond the source's bounds there may be places [cm]
    Sites(const SeedPlan& plan, const Vec3& first, const Vec3& pitch, const Vec3& ahead = Vec3::Zero())
        : random(plan.fill.seed, plan.stream), jittered(plan.fill.pattern == FillSettings::Pattern::Jittered)
    {
        Eigen::AlignedBox3d box = plan.source.bounds();
        if (!box.isEmpty()) box.extend(Eigen::AlignedBox3d(box.min() + ahead, box.max() + ahead));
        lattice = PlaceLattice::inBox(box, first, pitch, 0.5);
    }
    Vec3 position(int i, int j, int k) const
    {
        Vec3 x = lattice.position(i, j, k);
        if (jittered)
            for (int a = 0; a < kAxes; ++a) x[a] += (random.uniform(lattice.randomIndex(i, j, k), a) - 0.5) * lattice.pitch[a];
        return x;
    }
};

/// A place of a lattice in a region.
struct Found {
    Vec3 x;
    bool taken;  ///< whether a particle that was there before takes the place
};

/// Are all of the cubes around the places in the region?
bool areInside(const Shape& region, const std::vector<Found>& places, const Vec3& half)
{
    const double radius = half.norm(), slack = kFlat * half.minCoeff();
    return parallelSum(places.size(), [&](std::size_t n) {
               if (region.distance(places[n].x) < -radius) return 0.0;
               for (int corner = 0; corner < 8; ++corner) {
                   const Vec3 side(corner & 1 ? 1.0 : -1.0, corner & 2 ? 1.0 : -1.0, corner & 4 ? 1.0 : -1.0);
                   if (region.distance(places[n].x + half.cwiseProduct(side)) > slack) return 1.0;
               }
               return 0.0;
           }) == 0.0;
}

}  // namespace

PlaceLattice PlaceLattice::inBox(const Eigen::AlignedBox3d& box, const Vec3& origin, const Vec3& pitch, double margin)
{
    if (box.isEmpty()) return {origin, pitch};
    constexpr double kMostPlaces = 4.0e8;
    const Vec3 low = (box.min() - origin).cwiseQuotient(pitch).array() - margin, high = (box.max() - origin).cwiseQuotient(pitch).array() + margin;
    if (!(low.cwiseAbs().maxCoeff() < kMostAlong && high.cwiseAbs().maxCoeff() < kMostAlong))
        throw InputError("is unbounded, or too large to be filled with particles " + std::to_string(pitch.minCoeff()) + " cm apart");
    PlaceLattice lattice;
    lattice.pitch = pitch;
    lattice.low = low.array().ceil().cast<int>();
    lattice.size = (high.array().floor().cast<int>() - lattice.low.array() + 1).max(0);
    if (!(lattice.size.cast<double>().prod() <= kMostPlaces))
        throw InputError("is too large to be filled with particles " + std::to_string(pitch.minCoeff()) + " cm apart");
    lattice.first = origin + pitch.cwiseProduct(lattice.low.cast<double>());
    return lattice;
}

PatternPlaces latticePlaces(const SeedPlan& plan, const Shape& region, const std::vector<Vec3>& existing)
{
    const double spacing = particleSpacing(plan.fill, plan.dx);
    const Inlet inlet(region, plan.solids, plan.moved, spacing);
    Vec3 first = firstPlace(plan, spacing) + plan.age * plan.velocity, pitch = Vec3::Constant(spacing);
    if (plan.velocity.isZero(0.0)) fitBetweenPlanes(plan.source.bounds(), region, spacing, first, pitch);
    const Sites sites(plan, first, pitch, plan.moved);
    const Vec3 half = 0.5 * pitch;
    // A place is taken when there is a particle in its cube: wherever liquid of the right density lies, that is one
    // per cube, however it is shifted against the pattern.
    const PointBins bins(existing, half.maxCoeff());
    const auto found = sites.lattice.collect<Found>([&](int i, int j, int k, std::vector<Found>& list) {
        const Vec3 x = sites.position(i, j, k);
        if (!(region.distance(x) < -kOnSurface * spacing) && !inlet.hasPassed(x)) return;
        const Vec3 middle = sites.lattice.position(i, j, k);
        const bool taken = bins.anyNear(middle, [&](std::size_t p) { return ((existing[p] - middle).cwiseAbs().array() < half.array()).all(); });
        list.push_back({x, taken});
    });
    PatternPlaces places;
    places.count = found.size();
    if (!sites.jittered && areInside(region, found, half)) places.tiled = pitch.prod() * static_cast<double>(places.count);
    for (const Found& f : found)
        if (!f.taken) places.free.push_back(f.x);
    return places;
}

double meanLatticePlaces(const SeedPlan& plan, const Shape& region)
{
    // Phases along the velocity: for a velocity along an axis they divide the pitch evenly, for others they spread over
    // several. None is a multiple of the pitch: a region of so many pitches would have places on both its faces, which count as outside.
    constexpr int kPhases = 16, kPitches = 7;
    const double pitch = particleSpacing(plan.fill, plan.dx);
    const Vec3 direction = plan.velocity / plan.velocity.cwiseAbs().maxCoeff();
    double sum = 0.0;
    for (int phase = 0; phase < kPhases; ++phase) {
        const Sites sites(plan, firstPlace(plan, pitch) + (pitch * kPitches * (phase + 0.5) / kPhases) * direction, Vec3::Constant(pitch));
        const std::size_t rows = static_cast<std::size_t>(sites.lattice.size[1]) * sites.lattice.size[2];
        sum += parallelSum(rows, [&](std::size_t row) {
            const int j = static_cast<int>(row % sites.lattice.size[1]), k = static_cast<int>(row / sites.lattice.size[1]);
            int inside = 0;
            for (int i = 0; i < sites.lattice.size[0]; ++i) inside += region.distance(sites.position(i, j, k)) < -kOnSurface * pitch;
            return static_cast<double>(inside);
        });
    }
    return sum / kPhases;
}

}  // namespace sim
