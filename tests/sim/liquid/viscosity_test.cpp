#include "tests/sim/liquid/viscous_scene.h"

#include "sim/liquid/liquid_on_solids.h"
#include "sim/liquid/viscosity.h"
#include "tests/sim/fixtures.h"
#include "tests/sim/grid/random_solids.h"
#include "tests/sim/liquid/grid_scene.h"

#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include <numeric>

namespace sim::test {
namespace {

/// Parts of a step are steps: of liquid of one density, to the last bit.
TEST(Viscosity, SubstepsAreStepsOfAPart)
{
    ViscousScene whole = ball(), parts = ball(), once = ball();
    whole.scene.settings.viscositySubsteps = 4;
    const SolveReport report = whole.solve(1.0e-2);
    int iterations = 0;
    for (int n = 0; n < 4; ++n) iterations += parts.solve(2.5e-3).iterations;
    once.solve(1.0e-2);
    EXPECT_TRUE(report.converged);
    EXPECT_EQ(report.iterations, iterations);
    double change = 0.0;
    whole.scene.forEachFace([&](int a, const Vec3i& c) {
        EXPECT_EQ(whole.scene.velocity(a, c), parts.scene.velocity(a, c));
        change = std::max(change, std::abs(whole.scene.velocity(a, c) - once.scene.velocity(a, c)));
    });
    EXPECT_GT(change, 1.0e-3);
}

/// V1. Rigid motions are strained by nothing but rounding, whatever the masses and however stiff.
TEST(Viscosity, RigidMotionOfABallStays)
{
    ViscousScene viscous = ball();
    viscous.scene.settings.viscosity = 1.0e4;
    const Vec3 turn(3.0, -2.0, 5.0), shift(10.0, 20.0, -5.0);
    const auto motion = [&](const Vec3& x) { return Vec3(shift + turn.cross(x)); };
    viscous.scene.setVelocities(motion);
    EXPECT_TRUE(viscous.solve(1.0e-3, 1.0e-10).converged);
    double worst = 0.0;
    viscous.scene.forEachFace(
        [&](int a, const Vec3i& c) { worst = std::max(worst, std::abs(viscous.scene.velocity(a, c) - motion(viscous.scene.faceMiddle(a, c))[a])); });
    EXPECT_LT(worst, 1.0e-10 * shift.norm());
}

TEST(Viscosity, KeepsMomentumAndAngularMomentumAndTakesEnergy)
{
    ViscousScene viscous = ball();
    viscous.solve(0.0);  // marks the unknowns
    const Vec3 momentum = viscous.momentum(), angular = viscous.angularMomentum();
    const double energy = viscous.energy();
    EXPECT_TRUE(viscous.solve(1.0e-2).converged);
    EXPECT_LT((viscous.momentum() - momentum).norm(), 1.0e-10 * momentum.norm());
    EXPECT_LT((viscous.angularMomentum() - angular).norm(), 1.0e-10 * angular.norm());
    EXPECT_LT(viscous.energy(), 0.1 * energy);
    EXPECT_GT(viscous.energy(), 0.0);
}

TEST(Viscosity, TakesEnergyAtWallsToo)
{
    for (double friction : {0.0, 0.5, 1.0}) {
        ViscousScene viscous = puddle(friction);
        viscous.solve(0.0);
        double last = viscous.energy();
        for (int step = 0; step < 5; ++step) {
            EXPECT_TRUE(viscous.solve(1.0e-4, 1.0e-6).converged);
            EXPECT_LT(viscous.energy(), last);
            last = viscous.energy();
        }
    }
}

TEST(Viscosity, AddsNoMoreEnergyThanTheWorkOfWallsThatMove)
{
    Chance chance(8);
    double given = 0.0;
    for (int n = 0; n < 60; ++n) {
        ViscousScene viscous({-8, -8, -8}, {16, 16, 16});
        GridScene& scene = viscous.scene;
        scene.settings.wallFriction = n % 3 == 0 ? 0.0 : chance.between(0.1, 1.0);
        const Kind& kind = kSolidKinds[n % 9];
        scene.obstacles.add(kind.make(chance).moved(chance.turn(1.5)), randomMotion(chance, 50.0, 30.0));
        scene.obstacles.moveTo(0.0, 1.0e-3);
        scene.updateObstacles();
        scene.fill([](const Vec3& x) { return (x - kMiddle).norm() - 2.4; });
        scene.setRandomVelocities(n % 2 == 0 ? 0.0 : 20.0, n);
        viscous.solve(0.0);
        const double before = viscous.energy();
        LiquidOnSolids onSolids;
        onSolids.begin(scene.cut(), scene.liquid.faces);
        const LiquidOnSolids::KeptVelocities kept = onSolids.keepVelocities(scene.liquid.faces.velocity);
        ASSERT_TRUE(viscous.solve(1.0e-3).converged);
        const double work = onSolids.afterViscosity(kept, scene.cut(), viscous.work.system, scene.liquid), after = viscous.energy();
        EXPECT_LE(after, before + work + 1.0e-10 * (before + after)) << kind.name << ", state " << n << ", work " << work;
        given = std::max(given, (after - before) / after);
    }
    EXPECT_GT(given, 0.5);
}

/// Honey at 10^4 P in long steps: as stiff as any scene will be.
TEST(Viscosity, IsStableWhereItIsStiff)
{
    for (double dt : {1.0e-3, 4.0e-3, 1.0}) {
        ViscousScene viscous = puddle(1.0);
        viscous.scene.settings.viscosity = 1.0e4;
        viscous.solve(0.0);
        const double energy = viscous.energy();
        const SolveReport report = viscous.solve(dt, 1.0e-6);
        EXPECT_TRUE(report.converged);
        EXPECT_LT(report.iterations, 60) << dt;  // hundreds without the coarse grids
        EXPECT_LT(viscous.energy(), 1.0e-3 * energy) << dt;
    }
}

/// A slab between two plates `height` cells apart, the lower one `shift` cells above a plane of faces, long and open at
/// all ends, driven along x for so long that inertia is nothing: Poiseuille's parabola in its middle. Returns the
/// largest error there, relative to the largest velocity.
double poiseuilleError(int height, double shift)
{
    const int length = 6 * height;
    ViscousScene viscous({-1, -2, -1}, {length + 1, height + 2, 7});
    GridScene& scene = viscous.scene;
    const double dx = scene.grid.dx, low = scene.corner({0, 0, 0}).y() + shift * dx, high = low + (height - 1) * dx;
    scene.add(Shape::box(Vec3(0.0, low - 5.0, 0.0), Vec3(1.0e3, 5.0, 1.0e3)));
    scene.add(Shape::box(Vec3(0.0, high + 5.0, 0.0), Vec3(1.0e3, 5.0, 1.0e3)));
    scene.settings.wallFriction = 1.0;
    scene.fill([&](const Vec3& x) {
        const Vec3 from = scene.corner({0, 0, 0}), to = scene.corner({length, 0, 6});
        return std::max({from.x() - x.x(), x.x() - to.x(), from.z() - x.z(), x.z() - to.z()});
    });
    const double gap = high - low, nu = scene.settings.viscosity / scene.settings.density, dt = 1.0e6 * gap * gap / nu;
    const double push = 1.0;  // [cm/s^2]
    scene.setVelocities([&](const Vec3&) { return Vec3(push * dt, 0.0, 0.0); });
    EXPECT_TRUE(viscous.solve(dt, 1.0e-12).converged);
    double worst = 0.0;
    for (int j = 0; j < height; ++j) {
        const Vec3i c(length / 2, j, 3);
        if (!viscous.isUnknown(0, c)) continue;
        const double y = scene.faceMiddle(0, c).y() - low;
        if (y < 0.0 || y > gap) continue;
        worst = std::max(worst, std::abs(scene.velocity(0, c) - push / (2.0 * nu) * y * (gap - y)));
    }
    return worst / (push / (8.0 * nu) * gap * gap);
}

/// V3.
TEST(Viscosity, PoiseuilleProfileIsOfSecondOrder)
{
    const double coarse = poiseuilleError(9, 0.0), fine = poiseuilleError(17, 0.0);
    std::printf("walls in planes of faces: error %.2e between walls 8 cells apart, %.2e at 16\n", coarse, fine);
    EXPECT_LT(fine, 0.35 * coarse);  // a quarter, and what the ends still make of it in the middle
    EXPECT_LT(coarse, 0.02);         // (dx/gap)² of the largest velocity, 1/64
    for (double shift : {0.2, 0.4, 0.7}) {
        const double a = poiseuilleError(9, shift), b = poiseuilleError(17, shift);
        std::printf("walls %.1f cells off: error %.2e, %.2e\n", shift, a, b);
        EXPECT_LT(b, std::max(0.35 * a, 1.0e-3));  // wherever walls stand; what is left below a thousandth the ends make
        EXPECT_LT(a, 0.02);
    }
}

/// A turning drum takes the liquid in it along, and leaves alone what turns with it.
TEST(Viscosity, LiquidTurnsRigidlyWithItsWalls)
{
    ViscousScene viscous({-3, -3, -3}, {13, 13, 13});
    GridScene& scene = viscous.scene;
    Motion motion;
    motion.addRotation(-1.0, 1.0, {Vec3::UnitZ(), kMiddle}, 4.0, 0.0, 0.0);
    scene.add(Shape::ball(kMiddle, 1.1).inverted(), motion);
    scene.obstacles.moveTo(0.0, 1.0e-9);  // its velocity is that of a chord
    scene.updateObstacles();
    scene.settings.wallFriction = 1.0;
    scene.settings.full = true;
    scene.findInside();
    scene.setMasses();
    const auto turning = [](const Vec3& x) { return Vec3(2.0 * Vec3::UnitZ().cross(x - kMiddle)); };
    scene.setVelocities([](const Vec3&) { return Vec3(Vec3::Zero()); });
    EXPECT_TRUE(viscous.solve(1.0e6).converged);
    double worst = 0.0;
    scene.forEachFace([&](int a, const Vec3i& c) {
        if (viscous.isUnknown(a, c)) worst = std::max(worst, std::abs(scene.velocity(a, c) - turning(scene.faceMiddle(a, c))[a]));
    });
    EXPECT_LT(worst, 1.0e-6);  // inertia over viscosity is 1e-9, the tolerance on top
}

TEST(Viscosity, SameBitsForAnyThreadCount)
{
    const auto solved = [] {
        ViscousScene viscous = puddle(1.0);
        viscous.solve(1.0e-3, 1.0e-6);
        return viscous.scene.liquid.faces.velocity;
    };
    const BlockArray<double, 3> one = onThreads(1, solved);
    for (int threads : {2, 8}) {
        const BlockArray<double, 3> many = onThreads(threads, solved);
        EXPECT_EQ(std::memcmp(one.block(0), many.block(0), one.size() * sizeof(double)), 0) << threads;
    }
}

}  // namespace
}  // namespace sim::test
