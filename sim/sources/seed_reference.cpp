#include "sim/sources/seed_patterns.h"

#include <cmath>

namespace sim {

namespace {

constexpr int kPullSteps = 5;

struct Candidate {
    Vec3 x;
    std::uint64_t rank;  ///< place in the random order of visits
};

/// One candidate per place of a lattice over the source's bounds, each moved by up to a whole pitch, those outside of
/// the source by up to √3 pitches pulled to its surface.
std::vector<Candidate> candidates(const SeedPlan& plan, const Shape& solids, double pitch)
{
    const CounterRandom random(plan.fill.seed, plan.stream);
    Eigen::AlignedBox3d box = plan.source.bounds();
    if (!box.isEmpty()) box = {box.min() - Vec3::Constant(pitch), box.max() + Vec3::Constant(pitch)};
    const Vec3 first = box.min() + Vec3::Constant(0.5 * pitch) + plan.age * plan.velocity;
    const auto lattice = PlaceLattice::inBox(box, first, Vec3::Constant(pitch), 0.0);
    constexpr std::uint64_t kRankDraw = 3;
    return lattice.collect<Candidate>([&](int i, int j, int k, std::vector<Candidate>& list) {
        const std::uint64_t index = lattice.randomIndex(i, j, k);
        Vec3 x = lattice.position(i, j, k);
        for (int a = 0; a < kAxes; ++a) x[a] += (2.0 * random.uniform(index, a) - 1.0) * pitch;
        double d = plan.source.distance(x);
        if (d > std::sqrt(3.0) * pitch || solids.distance(x) < 0.0) return;
        if (d > 0.0) {
            for (int step = 0; step < kPullSteps && d > 0.0; ++step, d = plan.source.distance(x)) x -= d * plan.source.normal(x);
            if (solids.distance(x) < -1.0e-9 * pitch) return;
        }
        list.push_back({x, random.bits(index, kRankDraw)});
    });
}

}  // namespace

PatternPlaces referencePlaces(const SeedPlan& plan, const std::vector<Vec3>& existing)
{
    const double pitch = particleSpacing(plan.fill, plan.dx), distance = minimumDistance(plan.fill, plan.dx);
    const std::vector<Candidate> all = candidates(plan, Shape::unite(plan.solids), pitch);
    std::vector<Vec3> positions(all.size());
    parallelFor(all.size(), 4096, [&](std::size_t c) { positions[c] = all[c].x; });

    // Visited in random order, a candidate is dropped if another that is not dropped yet is near. Those not visited yet
    // are not dropped: what remains are the candidates that come last among their neighbours.
    const PointBins bins(positions, distance), taken(existing, distance);
    std::vector<char> keep(all.size());
    parallelFor(all.size(), 256, [&](std::size_t c) {
        const auto beats = [&](std::size_t other) {
            const bool later = all[other].rank != all[c].rank ? all[other].rank > all[c].rank : other > c;
            return other != c && later && (positions[other] - positions[c]).squaredNorm() < distance * distance;
        };
        keep[c] = !bins.anyNear(positions[c], beats);
    });
    PatternPlaces places;
    for (std::size_t c = 0; c < all.size(); ++c) {
        if (!keep[c]) continue;
        ++places.count;
        if (!taken.anyNearer(positions[c], distance)) places.free.push_back(positions[c]);
    }
    return places;
}

}  // namespace sim
