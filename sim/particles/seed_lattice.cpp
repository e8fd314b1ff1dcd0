#include "sim/core/check.h"
#include "sim/particles/seed_patterns.h"

#include <cmath>

namespace sim {

namespace {

/// Place (0, 0, 0) of a pattern that does not move: half a pitch inside the source's bounds; with two places per cell,
/// a quarter cell inside of a cell of the grid.
Vec3 firstPlace(const SeedPlan& plan, double pitch)
{
    const Vec3 half = Vec3::Constant(0.5 * pitch), corner = plan.source.bounds().min();
    if (plan.fill.spacing != 0.5) return corner + half;
    const Vec3 places = ((corner - plan.gridOrigin) / pitch).array().floor();
    return plan.gridOrigin + pitch * places + half;
}

/// A lattice, its places moved at random within their cubes if it is jittered, carried along by `shift`.
struct Sites {
    PlaceLattice lattice;
    CounterRandom random;
    bool jittered;

    /// @param ahead  how far beyond the source's bounds there may be places [cm]
    Sites(const SeedPlan& plan, const Vec3& shift, const Vec3& ahead = Vec3::Zero())
        : random(plan.fill.seed, plan.stream), jittered(plan.fill.pattern == FillSettings::Pattern::Jittered)
    {
        const double pitch = particleSpacing(plan.fill, plan.dx);
        Eigen::AlignedBox3d box = plan.source.bounds();
        if (!box.isEmpty()) box.extend(Eigen::AlignedBox3d(box.min() + ahead, box.max() + ahead));
        lattice = PlaceLattice::inBox(box, firstPlace(plan, pitch) + shift, pitch, 0.5);
    }
    Vec3 position(int i, int j, int k) const
    {
        Vec3 x = lattice.position(i, j, k);
        if (jittered)
            for (int a = 0; a < kAxes; ++a)
                x[a] += (random.uniform(lattice.randomIndex(i, j, k), a) - 0.5) * lattice.pitch;
        return x;
    }
};

}  // namespace

PlaceLattice PlaceLattice::inBox(const Eigen::AlignedBox3d& box, const Vec3& origin, double pitch, double margin)
{
    if (box.isEmpty()) return {origin, pitch};
    constexpr double kMostPlaces = 4.0e8, kMostAlong = 1 << 20;
    const Vec3 low = ((box.min() - origin) / pitch).array() - margin,
               high = ((box.max() - origin) / pitch).array() + margin;
    if (!(low.cwiseAbs().maxCoeff() < kMostAlong && high.cwiseAbs().maxCoeff() < kMostAlong))
        throw InputError("is unbounded, or too large to be filled with particles " + std::to_string(pitch) +
                         " cm apart");
    PlaceLattice lattice;
    lattice.pitch = pitch;
    lattice.low = low.array().ceil().cast<int>();
    lattice.size = (high.array().floor().cast<int>() - lattice.low.array() + 1).max(0);
    if (!(lattice.size.cast<double>().prod() <= kMostPlaces))
        throw InputError("is too large to be filled with particles " + std::to_string(pitch) + " cm apart");
    lattice.first = origin + pitch * lattice.low.cast<double>();
    return lattice;
}

PatternPlaces latticePlaces(const SeedPlan& plan, const Shape& region, const std::vector<Vec3>& existing)
{
    const Inlet inlet(region, plan.solids, plan.moved, particleSpacing(plan.fill, plan.dx));
    const Sites sites(plan, plan.age * plan.velocity, plan.moved);
    const double half = 0.5 * sites.lattice.pitch;
    struct Found {
        Vec3 x;
        bool taken;
    };
    // A place is taken when there is a particle in its cube: wherever liquid of the right density lies, that is one
    // per cube, however it is shifted against the pattern.
    const PointBins bins(existing, half);
    const auto found = sites.lattice.collect<Found>([&](int i, int j, int k, std::vector<Found>& list) {
        const Vec3 x = sites.position(i, j, k);
        if (!(region.distance(x) < -kOnSurface * sites.lattice.pitch) && !inlet.hasPassed(x)) return;
        const Vec3 middle = sites.lattice.position(i, j, k);
        const bool taken =
            bins.anyNear(middle, [&](std::size_t p) { return (existing[p] - middle).cwiseAbs().maxCoeff() < half; });
        list.push_back({x, taken});
    });
    PatternPlaces places;
    places.count = found.size();
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
        const Sites sites(plan, (pitch * kPitches * (phase + 0.5) / kPhases) * direction);
        const std::size_t rows = static_cast<std::size_t>(sites.lattice.size[1]) * sites.lattice.size[2];
        sum += parallelSum(rows, [&](std::size_t row) {
            const int j = static_cast<int>(row % sites.lattice.size[1]),
                      k = static_cast<int>(row / sites.lattice.size[1]);
            int inside = 0;
            for (int i = 0; i < sites.lattice.size[0]; ++i)
                inside += region.distance(sites.position(i, j, k)) < -kOnSurface * pitch;
            return static_cast<double>(inside);
        });
    }
    return sum / kPhases;
}

}  // namespace sim
