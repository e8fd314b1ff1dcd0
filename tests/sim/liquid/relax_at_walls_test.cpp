#include "sim/liquid/relax_at_walls.h"

#include "sim/particles/relax.h"
#include "tests/sim/fixtures.h"

#include <gtest/gtest.h>

namespace sim::test {
namespace {

constexpr double kCell = 0.25, kReach = 0.8 * kCell, kRate = 125.0, kInterval = 1.0e-3;  // cm, cm, 1/s, s

using Displacements = std::array<AlignedArray<double>, kAxes>;

Vec3 randomVector(std::mt19937& random)
{
    std::uniform_real_distribution<double> unit(-1.0, 1.0);
    Vec3 v;
    do v = Vec3(unit(random), unit(random), unit(random));
    while (v.norm() < 0.1 || v.norm() > 1.0);
    return v;
}

/// Crowded liquid beside or around a solid, and how the relaxation would move it.
struct Crowd {
    SortedLiquid liquid;
    Obstacles obstacles;
    ObstacleField field;
    Displacements asPushed, kept;

    Crowd(Shape solid, const Vec3& gravity, unsigned seed)
    {
        obstacles.add(std::move(solid), {});
        const SortedLiquid all = randomLiquid(5000, 1, {14, 14, 14}, {-7, -7, -7}, kCell, seed);
        liquid.grid.dx = kCell;
        liquid.grid.origin = all.grid.origin;
        for (std::size_t p = 0; p < all.particles.count; ++p)
            if (obstacles.distance(all.particles.position(p)) >= 0.0)
                liquid.particles.add(all.particles.position(p), all.particles.mass[p], static_cast<std::uint32_t>(p), Vec3::Zero());
        liquid.sort();
        field.update(liquid.grid, std::vector<int>(liquid.grid.count(), BlockGrid::kNone), obstacles, false);
        RelaxScratch scratch;
        relaxationDisplacements({liquid.particles, liquid.order, liquid.grid}, kRate, kReach, kInterval, scratch, asPushed);
        kept = asPushed;
        keepRelaxationFromLifting(liquid.order, {liquid.grid, field, obstacles}, gravity, kReach, liquid.particles, kept);
    }

    static Vec3 at(const Displacements& all, std::size_t s) { return {all[0][s], all[1][s], all[2][s]}; }
    /// [erg]
    double lifted(const Vec3& gravity) const
    {
        double sum = 0.0;
        for (std::size_t s = 0; s < liquid.particles.count; ++s) sum -= liquid.particles.mass[s] * gravity.dot(at(kept, s));
        return sum;
    }
};

TEST(RelaxAtWalls, LiftsNoWeightAndLeavesParticlesInFrontOfAnySurface)
{
    std::mt19937 random(5);
    int lifting = 0;
    for (unsigned n = 0; n < 40; ++n) {
        const Vec3 gravity = 981.0 * randomVector(random).normalized();
        // Floors at any angle, the one below among them, and balls: distances that are convex.
        const Vec3 up = n % 4 == 0 ? Vec3(-gravity.normalized()) : randomVector(random).normalized();
        const Vec3 middle = 0.5 * randomVector(random);
        const Shape solid = n % 2 == 0 ? Shape::cylinder(middle - 5.0 * up, up, 50.0, 5.0, 0.0) : Shape::ball(middle, 1.0);
        const Crowd crowd(solid, gravity, n + 1);
        double lifted = 0.0;
        for (std::size_t s = 0; s < crowd.liquid.particles.count; ++s) {
            const Vec3 x = crowd.liquid.particles.position(s), d = Crowd::at(crowd.kept, s), as = Crowd::at(crowd.asPushed, s);
            ASSERT_GT(crowd.obstacles.distance(x + d), -1.0e-9) << "state " << n << ", particle " << s;
            ASSERT_LE(d.norm(), as.norm() * (1.0 + 1.0e-9));
            if (crowd.obstacles.distance(x) < kCell) continue;
            ASSERT_LE(d.cross(as).norm(), 1.0e-9 * as.squaredNorm()) << "far from walls only lengths change";
            ASSERT_TRUE(as.dot(gravity) < 0.0 || d == as) << "and of those that go up";
            lifted += (d - as).norm();
        }
        lifting += lifted > 0.0;
        EXPECT_LT(crowd.lifted(gravity), 1.0e-9) << "state " << n;
    }
    EXPECT_GT(lifting, 10) << "states whose relaxation lifted weight";
}

TEST(RelaxAtWalls, WithoutWeightOnlyWhatGoesIntoTheWallIsLeftOut)
{
    const Crowd crowd(Shape::ball(Vec3(0.3, 0.2, 0.1), 1.0), Vec3::Zero(), 3);
    for (std::size_t s = 0; s < crowd.liquid.particles.count; ++s) {
        const Vec3 x = crowd.liquid.particles.position(s), change = Crowd::at(crowd.kept, s) - Crowd::at(crowd.asPushed, s);
        ASSERT_GT(crowd.obstacles.distance(x + Crowd::at(crowd.kept, s)), -1.0e-9);
        ASSERT_TRUE(crowd.obstacles.distance(x) < kReach || change.isZero(0.0));
    }
}

}  // namespace
}  // namespace sim::test
