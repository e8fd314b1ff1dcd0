// How evenly bodies are filled.
#include "tests/sim/sources/seed_plans.h"

#include <gtest/gtest.h>

namespace sim {
namespace {

/// How far the volume that particles bring to the middles of cells by quadratic B-splines is from the region's there: the root of its mean square
/// over cells of which the region has more than a half [-].
double unevenness(const Shape& region, const std::vector<Vec3>& positions, const std::function<double(std::size_t)>& volume, double dx)
{
    const auto spline = [](double r) {
        r = std::abs(r);
        return r < 0.5 ? 0.75 - r * r : r < 1.5 ? 0.5 * (1.5 - r) * (1.5 - r) : 0.0;
    };
    const auto weight = [&](const Vec3& x) { return spline(x[0] / dx) * spline(x[1] / dx) * spline(x[2] / dx); };
    const Eigen::AlignedBox3d box = region.bounds();
    const PointBins bins(positions, 1.5 * dx);
    double squares = 0.0, all = 0.0;
    constexpr int kPoints = 8192;
    for (double z = box.min()[2]; z < box.max()[2]; z += dx)
        for (double y = box.min()[1]; y < box.max()[1]; y += dx)
            for (double x = box.min()[0]; x < box.max()[0]; x += dx) {
                const Vec3 middle(x, y, z);
                double is = 0.0, should = 0.0;
                bins.anyNear(middle, [&](std::size_t p) {
                    is += volume(p) * weight(positions[p] - middle);
                    return false;
                });
                for (int n = 0; n < kPoints; ++n) {  // an additive sequence (Roberts 2018)
                    const Vec3 at = n * Vec3(0.8191725133961645, 0.6710436067037893, 0.5497004779019703);
                    const Vec3 to = 3.0 * dx * (at.array() - at.array().floor() - 0.5);
                    if (region.distance(middle + to) < 0.0) should += std::pow(3.0 * dx, 3) / kPoints * weight(to);
                }
                if (!(should > 0.5 * std::pow(dx, 3))) continue;
                squares += (is / should - 1.0) * (is / should - 1.0);
                all += 1.0;
            }
    return std::sqrt(squares / all);
}

TEST(Seed, BodiesFillTheirRegionsEvenly)
{
    const Shape box = Shape::box(Vec3::Zero(), {0.9, 1.1, 0.8}), post = Shape::cylinder(Vec3::Zero(), Vec3::UnitY(), 0.4, 3.0, 0.0);
    for (const Shape& shape : {Shape::ball({0.1, 0.2, 0.0}, 1.2), box.moved(turned(0.4, {0.3, 1.0, 0.2}, Vec3::Zero())), box})
        for (const Pattern pattern : kPatterns)
            for (const bool hasPost : {false, true}) {
                SeedPlan plan = planOf(shape, pattern);
                if (hasPost) plan.solids = {post};
                const Shape region = regionOf(plan);
                const Seeds seeds = seedParticles(plan);
                const double sum = std::accumulate(seeds.volumes.begin(), seeds.volumes.end(), 0.0);
                if (pattern == Pattern::Lattice && shape.axisBox() && !hasPost) {
                    EXPECT_TRUE(seeds.volumes.empty()) << "a lattice that fits is even as it is";
                    continue;
                }
                ASSERT_EQ(seeds.volumes.size(), seeds.positions.size());
                EXPECT_NEAR(sum / (countOf(seeds) * seeds.volume), 1.0, 1e-12);
                EXPECT_GT(*std::ranges::min_element(seeds.volumes), 0.02 * seeds.volume);
                EXPECT_LT(*std::ranges::max_element(seeds.volumes), 6.0 * seeds.volume);
                const double scale = pattern == Pattern::Reference ? boundedVolume(region, plan.dx) / sum : 1.0;
                const double alike = unevenness(
                                 region, seeds.positions, [&](std::size_t) { return scale * seeds.volume; }, plan.dx),
                             even = unevenness(
                                 region, seeds.positions, [&](std::size_t p) { return scale * seeds.volumes[p]; }, plan.dx);
                // Rooms of cut cells are as exact as that.
                EXPECT_LT(even, 0.025) << "pattern " << static_cast<int>(pattern) << ", alike " << alike;
                EXPECT_LT(even, 0.5 * alike + 0.006) << "pattern " << static_cast<int>(pattern);
            }
}

/// Crescents, shells and slivers, of which the grid sees next to nothing, at any place: every particle has a volume.
TEST(Seed, ThinBodiesHaveParticlesWithVolumes)
{
    const CounterRandom random(7, 1);
    std::uint64_t next = 0;
    const auto draw = [&](double low, double high) { return low + (high - low) * random.uniform(next++); };
    for (int n = 0; n < 100; ++n) {
        const Vec3 at(draw(-1.0, 1.0), draw(-1.0, 1.0), draw(-1.0, 1.0)), off(draw(-0.5, 0.5), draw(-0.5, 0.5), draw(-0.5, 0.5));
        const double radius = draw(0.3, 0.8);
        const Shape hole = n % 3 == 0 ? Shape::ball(at, draw(0.8, 0.97) * radius) : Shape::ball(at + off, radius);
        const SeedPlan plan = planOf(Shape::subtract({Shape::ball(at, radius), hole}), kPatterns[n % 4], draw(0.3, 0.7));
        const Seeds seeds = seedParticles(plan);
        if (seeds.volumes.empty()) continue;
        const double sum = std::accumulate(seeds.volumes.begin(), seeds.volumes.end(), 0.0);
        EXPECT_NEAR(sum / (countOf(seeds) * seeds.volume), 1.0, 1e-12) << "body " << n;
        EXPECT_GT(*std::ranges::min_element(seeds.volumes), 0.005 * seeds.volume) << "body " << n;
    }
}

}  // namespace
}  // namespace sim
