#include "tests/sim/sources/seed_plans.h"

#include "sim/core/random.h"
#include "sim/sources/seed.h"

#include "sim/core/check.h"
#include "sim/core/units.h"
#include "sim/particles/point_bins.h"
#include "sim/shapes/volume.h"

#include <gtest/gtest.h>

#include <random>

#include <oneapi/tbb/global_control.h>
#include <oneapi/tbb/task_arena.h>

#include <cmath>
#include <functional>
#include <numeric>
#include <set>

namespace sim {
namespace {

/// Shadows of boxes, balls and cylinders turned any way, thin ones, too.
TEST(Seed, AreaAcrossIsThatOfTheShadow)
{
    const Vec3 axis(0.3, -0.5, 0.8), to(0.1, 0.7, -0.3);
    for (const double angle : {0.0, 0.3, 1.1})
        for (const Vec3& half : {Vec3(0.5, 0.33, 0.41), Vec3(0.5, 0.01, 0.41), Vec3(0.2, 1.3, 0.1)})
            for (const Vec3& velocity : {Vec3(0.0, -2.0, 0.0), Vec3(1.0, 2.0, 0.5)}) {
                const Eigen::Isometry3d place = turned(angle, axis, to);
                const Vec3 d = (place.linear().transpose() * velocity).normalized().cwiseAbs();
                const double shadow = 4.0 * (d[0] * half[1] * half[2] + d[1] * half[2] * half[0] + d[2] * half[0] * half[1]);
                EXPECT_NEAR(areaAcross(Shape::box(Vec3::Zero(), half).moved(place), velocity, 0.1152) / shadow, 1.0, 0.01)
                    << angle << ' ' << half.transpose() << ", " << velocity.transpose();
            }
    EXPECT_NEAR(areaAcross(Shape::ball(to, 0.5), axis, 0.1152) / (kPi * 0.25), 1.0, 0.01);
    EXPECT_NEAR(areaAcross(Shape::cylinder(to, axis.normalized(), 0.5, 0.2, 0.0), axis, 0.1152) / (kPi * 0.25), 1.0, 0.01);
}

double leastDistance(const std::vector<Vec3>& x, double reach)
{
    const PointBins bins(x, reach);
    double least = reach;
    for (std::size_t p = 0; p < x.size(); ++p)
        bins.anyNear(x[p], [&](std::size_t q) {
            if (q != p) least = std::min(least, (x[q] - x[p]).norm());
            return false;
        });
    return least;
}

TEST(Seed, ReferenceGivesAsManyParticlesAsPublished)
{
    EXPECT_NEAR(countOf(seedParticles(damBreak(Pattern::Reference))) / 313501.0, 1.0, 0.02);
    const Shape ball = Shape::ball({7.2, 5.76, 7.2}, 1.44);
    EXPECT_NEAR(countOf(seedParticles(planOf(ball, Pattern::Reference))) / 9876.0, 1.0, 0.02);
    EXPECT_NEAR(countOf(seedParticles(planOf(ball, Pattern::Reference, 0.25))) / 26532.0, 1.0, 0.02);
}

TEST(Seed, ReferenceKeepsThePublishedVolume)
{
    const Seeds seeds = seedParticles(planOf(Shape::ball(Vec3::Zero(), 1.44), Pattern::Reference));
    EXPECT_NEAR(seeds.volume, 8.5104e-4, 1e-8);
    EXPECT_NEAR(nominalRadius({Pattern::Reference, 1, 0.0}, 0.288), 0.058788, 1e-6);
    EXPECT_NEAR(nominalRadius({Pattern::Lattice, 1, 0.0}, 0.288), 0.058788, 1e-5);
}

TEST(Seed, ALatticeIsAsLargeAsItsSource)
{
    for (const SeedPlan& plan : {damBreak(Pattern::Lattice), planOf(Shape::ball({0.3, 0.1, 0.2}, 1.44), Pattern::Lattice)}) {
        const Seeds seeds = seedParticles(plan);
        const double region = boundedVolume(plan.source, plan.dx), count = countOf(seeds);
        EXPECT_NEAR(count * std::pow(0.4 * 0.288, 3) / region, 1.0, 0.02);
        EXPECT_NEAR(count * seeds.volume / region, 1.0, 1e-12);
    }
}

TEST(Seed, EveryPatternButTheReferenceFillsItsSource)
{
    for (Pattern pattern : {Pattern::Lattice, Pattern::Jittered, Pattern::Poisson}) {
        const SeedPlan plan = planOf(Shape::ball(Vec3::Zero(), 2.0), pattern);
        const Seeds seeds = seedParticles(plan);
        const double region = boundedVolume(plan.source, plan.dx);
        EXPECT_NEAR(countOf(seeds) * seeds.volume / region, 1.0, 1e-12);
        EXPECT_NEAR(seeds.volume / std::pow(0.4 * 0.288, 3), 1.0, 0.05);
    }
}

TEST(Seed, ALatticeBeginsHalfAPitchInside)
{
    const Seeds seeds = seedParticles(planOf(Shape::box({1.0, 1.0, 1.0}, {0.5, 0.5, 0.5}), Pattern::Lattice));
    EXPECT_TRUE(seeds.positions.front().isApprox(Vec3::Constant(0.5 + 0.5 / 9.0), 1e-12));
    EXPECT_EQ(seeds.positions.size(), 729u);  // 1 / .1152 = 8.7 per edge
    const Seeds round = seedParticles(planOf(Shape::ball(Vec3::Constant(1.0), 0.7), Pattern::Lattice));
    for (const Vec3& x : round.positions)
        for (int a = 0; a < kAxes; ++a) EXPECT_NEAR(std::remainder(x[a] - 0.3 - 0.5 * 0.1152, 0.1152), 0.0, 1e-12);
}

/// A pool is even from the floor to its level, wherever that is, however much of its source is within solids.
TEST(Seed, LayersLieEvenlyBetweenPlanes)
{
    std::mt19937 random(5);
    std::uniform_real_distribution<double> unit(0.0, 1.0);
    for (int n = 0; n < 40; ++n) {
        const Vec3 low(unit(random), unit(random), unit(random)), size = Vec3::Constant(0.3) + 2.0 * Vec3(unit(random), unit(random), unit(random));
        const double cut = 0.2 * unit(random) * size[1];
        SeedPlan plan = planOf(Shape::box(low + 0.5 * size, 0.5 * size), n % 2 == 0 ? Pattern::Lattice : Pattern::Jittered);
        plan.solids.push_back(Shape::box(low + Vec3(0.0, cut - 5.0, 0.0), Vec3::Constant(5.0)));  // up to low.y + cut
        const Seeds seeds = seedParticles(plan);
        const Vec3 bottom = low + Vec3(0.0, cut, 0.0), room = size - Vec3(0.0, cut, 0.0);
        const Vec3 layers = (room / particleSpacing(plan.fill, plan.dx)).array().round().max(1.0);
        EXPECT_EQ(countOf(seeds), layers.prod()) << n;
        EXPECT_NEAR(seeds.volume, room.prod() / layers.prod(), 1e-3 * seeds.volume);  // as exactly as the region is measured
        for (const Vec3& x : seeds.positions)
            for (int a = 0; a < kAxes && plan.fill.pattern == Pattern::Lattice; ++a)
                EXPECT_NEAR(std::remainder((x[a] - bottom[a]) / room[a] * layers[a] - 0.5, 1.0), 0.0, 1e-6);
    }
}

TEST(Seed, TwoPerCellLieOnTheGrid)
{
    SeedPlan plan = planOf(Shape::box({0.96, 0.96, 0.96}, Vec3::Constant(0.576)), Pattern::Lattice, 0.5);
    plan.gridOrigin = Vec3::Constant(0.096);
    const Seeds seeds = seedParticles(plan);
    EXPECT_EQ(seeds.positions.size(), 512u);
    EXPECT_NEAR(seeds.volume, std::pow(0.144, 3), 1e-6 * seeds.volume);
    for (const Vec3& x : seeds.positions)
        for (int a = 0; a < kAxes; ++a) {
            const double q = (x[a] - 0.096) / 0.288 - std::floor((x[a] - 0.096) / 0.288);
            EXPECT_NEAR(std::abs(q - 0.5), 0.25, 1e-9);
        }
}

TEST(Seed, ParticlesLieInTheSourceAndOutsideOfSolids)
{
    for (Pattern pattern : kPatterns) {
        SeedPlan plan = planOf(Shape::ball(Vec3::Zero(), 1.44), pattern);
        plan.solids = {Shape::ball({1.0, 0.0, 0.0}, 0.8), Shape::box({0.0, -1.6, 0.0}, {2.0, 0.5, 2.0})};
        const Seeds seeds = seedParticles(plan);
        EXPECT_GT(seeds.positions.size(), 3000u);
        for (const Vec3& x : seeds.positions) {
            EXPECT_LT(plan.source.distance(x), 1e-6);
            for (const Shape& solid : plan.solids) EXPECT_GT(solid.distance(x), -1e-9);
        }
        if (pattern == Pattern::Reference) continue;
        const Shape region = Shape::subtract({plan.source, plan.solids[0], plan.solids[1]});
        EXPECT_NEAR(countOf(seeds) * seeds.volume, boundedVolume(region, plan.dx), 1e-9);
    }
}

TEST(Seed, ParticlesKeepTheirDistance)
{
    for (Pattern pattern : {Pattern::Lattice, Pattern::Reference, Pattern::Poisson}) {
        const SeedPlan plan = planOf(Shape::ball(Vec3::Zero(), 1.44), pattern);
        const double least = minimumDistance(plan.fill, plan.dx);
        EXPECT_GT(least, 0.05);
        EXPECT_GE(leastDistance(seedParticles(plan).positions, 2.0 * least), least * (1.0 - 1e-12));
    }
}

TEST(Seed, ParticlesKeepTheirDistanceFromLiquidThatIsThere)
{
    const Shape ball = Shape::ball(Vec3::Zero(), 1.2);
    for (Pattern pattern : {Pattern::Reference, Pattern::Poisson}) {
        const SeedPlan first = planOf(ball, pattern), second = planOf(Shape::ball({0.6, 0.0, 0.0}, 1.2), pattern, 0.0, 2);
        LiquidNearby nearby;
        nearby.positions = seedParticles(first).positions;
        std::vector<Vec3> all = nearby.positions;
        const auto added = seedParticles(second, nearby).positions;
        EXPECT_GT(added.size(), 1000u);
        all.insert(all.end(), added.begin(), added.end());
        const double least = minimumDistance(first.fill, first.dx);
        EXPECT_GE(leastDistance(all, 2.0 * least), least * (1.0 - 1e-12));
    }
}

TEST(Seed, AFullSourceTakesNoMore)
{
    for (Pattern pattern : kPatterns) {
        SeedPlan plan = planOf(Shape::box(Vec3::Zero(), {0.6, 0.7, 0.8}), pattern);
        const Seeds seeds = seedParticles(plan);
        LiquidNearby nearby{seeds.positions, countOf(seeds) * seeds.volume};
        EXPECT_TRUE(seedParticles(plan, nearby).positions.empty());
    }
}

TEST(Seed, AShiftedLatticeOfLiquidLeavesNoGaps)
{
    SeedPlan plan = planOf(Shape::box(Vec3::Zero(), Vec3::Constant(1.152)), Pattern::Lattice);
    LiquidNearby nearby;
    for (const Vec3& x : seedParticles(planOf(Shape::box(Vec3::Zero(), Vec3::Constant(1.3824)), Pattern::Lattice)).positions)
        nearby.positions.push_back(x + 0.1152 * Vec3(0.49, 0.31, 0.44));
    EXPECT_TRUE(seedParticles(plan, nearby).positions.empty());
}

TEST(Seed, GivesTheSameBitsForAnyNumberOfThreads)
{
    for (Pattern pattern : kPatterns) {
        const SeedPlan plan = planOf(Shape::ball(Vec3::Zero(), 1.44), pattern);
        std::vector<Seeds> found;
        for (int threads : {1, 2, 8}) {
            tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
            tbb::task_arena arena(threads);
            arena.execute([&] { found.push_back(seedParticles(plan)); });
        }
        for (const Seeds& other : found) {
            EXPECT_EQ(other.volume, found[0].volume);
            EXPECT_EQ(other.positions, found[0].positions);
        }
    }
}

TEST(Seed, OtherSeedsAndSourcesDrawOtherNumbers)
{
    for (Pattern pattern : {Pattern::Reference, Pattern::Jittered, Pattern::Poisson}) {
        const SeedPlan plan = planOf(Shape::ball(Vec3::Zero(), 1.0), pattern), other = planOf(plan.source, pattern, 0.0, 2);
        SeedPlan stream = plan;
        stream.stream = 1;
        EXPECT_NE(seedParticles(plan).positions, seedParticles(other).positions);
        EXPECT_NE(seedParticles(plan).positions, seedParticles(stream).positions);
    }
}

TEST(Seed, RefusesTheUnboundedAndTheHuge)
{
    for (Pattern pattern : kPatterns) {
        EXPECT_THROW(seedParticles(planOf(Shape::ball(Vec3::Zero(), 1.0).inverted(), pattern)), InputError);
        EXPECT_THROW(seedParticles(planOf(Shape::ball(Vec3::Zero(), 1000.0), pattern)), InputError);
        EXPECT_TRUE(seedParticles(planOf(Shape(), pattern)).positions.empty());
    }
}

}  // namespace
}  // namespace sim
