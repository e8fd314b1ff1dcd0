#include "sim/liquid/strain_correction.h"

#include "sim/core/units.h"
#include "tests/sim/liquid/grid_scene.h"

#include <gtest/gtest.h>

namespace sim::test {
namespace {

constexpr double kDt = 1.0e-3;

/// A scene with its pressure's system and what the strain correction works in.
struct StrainedScene {
    GridScene scene;
    StrainWorkspace strain;
    BlockArray<double, 3> before;  ///< 0 at first [cm/s]

    explicit StrainedScene(GridScene given) : scene(std::move(given))
    {
        scene.pressureFaces(kDt);  // with the coefficients that masses are told by
        const int blocks = scene.grid.count();
        strain.acts.resize(blocks);
        std::fill_n(strain.acts.block(0), static_cast<std::size_t>(blocks) * kAxes * BlockBits<3>::kWords, ~std::uint64_t{0});
        before.resize(blocks);
        std::fill_n(before.block(0), before.size(), 0.0);
        scene.liquid.unpressed = before;
    }

    BlockArray<double, 3>& velocity() { return scene.liquid.faces.velocity; }
    /// Mass of a face by the pressure's coefficient, relative to a full one.
    double mass(int a, const CellRef& ref) const
    {
        const double k = scene.work.coefficient.block(ref.block, a)[ref.cell];
        const double room = scene.field.open(ref.block, a)[ref.cell] * scene.field.room(ref.block, a)[ref.cell];
        return k > 0.0 ? scene.work.ofFull * room / k : 0.0;
    }
    double dot(const BlockArray<double, 3>& u, const BlockArray<double, 3>& v) const
    {
        double sum = 0.0;
        scene.forEachFace([&](int a, const Vec3i& c) {
            const CellRef ref = scene.at(c);
            sum += mass(a, ref) * u.block(ref.block, a)[ref.cell] * v.block(ref.block, a)[ref.cell];
        });
        return sum;
    }
    /// α² M⁻¹ L of these velocities.
    BlockArray<double, 3> correctionOf(const BlockArray<double, 3>& u)
    {
        const BlockArray<double, 3> kept = velocity();
        velocity() = u;
        correct();
        BlockArray<double, 3> correction = velocity();
        for (std::size_t i = 0; i < correction.size(); ++i) correction.block(0)[i] -= u.block(0)[i];
        velocity() = kept;
        return correction;
    }
    BlockArray<double, 3> randomVelocities(unsigned seed)
    {
        scene.setRandomVelocities(1.0, seed);
        return velocity();
    }
    void correct() { correctStrain(scene.cut(), before, scene.pressureFaces(kDt), strain, scene.liquid); }
    void project() { scene.project(kDt); }
};

/// A ball of liquid that nothing holds.
GridScene ball()
{
    GridScene scene({-8, -8, -8}, {8, 8, 8});
    const Vec3 middle = scene.corner({0, 0, 0}) + scene.grid.dx * Vec3(0.3, -0.1, 0.2);
    scene.fill([&](const Vec3& x) { return (x - middle).norm() - 5.3 * scene.grid.dx; });
    return scene;
}

/// A tank with liquid up to a wavy level.
GridScene wavyTank(double level)
{
    GridScene scene({-3, -3, -3}, {13, 19, 11});
    scene.add(tankOfCells(scene, {0, 0, 0}, {10, 16, 8}));
    const double high = scene.corner({0, 0, 0}).y() + level * scene.grid.dx, cells = scene.grid.dx;
    scene.fill([&](const Vec3& x) { return x.y() - high - 0.7 * cells * std::sin(x.x() / cells + 0.4) * std::cos(0.8 * x.z() / cells); });
    return scene;
}

TEST(StrainCorrection, KeepsBothMomenta)
{
    StrainedScene scene(ball());
    const BlockArray<double, 3> correction = scene.correctionOf(scene.randomVelocities(3));
    Vec3 linear = Vec3::Zero(), angular = Vec3::Zero();
    double size = 0.0;
    scene.scene.forEachFace([&](int a, const Vec3i& c) {
        const CellRef ref = scene.scene.at(c);
        const double impulse = scene.mass(a, ref) * correction.block(ref.block, a)[ref.cell];
        linear[a] += impulse;
        angular += scene.scene.faceMiddle(a, c).cross(impulse * Vec3::Unit(a));
        size += std::abs(impulse);
    });
    EXPECT_GT(size, 1.0);
    EXPECT_LT(linear.norm(), 1.0e-14 * size);
    EXPECT_LT(angular.norm(), 1.0e-14 * size);
}

TEST(StrainCorrection, IsSymmetricAndPositive)
{
    for (StrainedScene& scene : std::array{StrainedScene(ball()), StrainedScene(wavyTank(6.3))}) {
        const BlockArray<double, 3> u = scene.randomVelocities(4), v = scene.randomVelocities(5);
        const BlockArray<double, 3> ofU = scene.correctionOf(u), ofV = scene.correctionOf(v);
        EXPECT_NEAR(scene.dot(u, ofV), scene.dot(v, ofU), 1.0e-12 * scene.dot(u, ofU));
        EXPECT_GT(scene.dot(u, ofU), 0.0);
        EXPECT_GT(scene.dot(v, ofV), 0.0);
    }
}

TEST(StrainCorrection, KnowsNothingOfRigidMotion)
{
    StrainedScene scene(ball());
    scene.scene.setVelocities([](const Vec3& x) { return Vec3(Vec3(1.0, -2.0, 0.5) + Vec3(0.7, 0.4, -1.1).cross(x)); });
    const BlockArray<double, 3> u = scene.velocity(), correction = scene.correctionOf(u);
    for (std::size_t i = 0; i < correction.size(); ++i) EXPECT_LT(std::abs(correction.block(0)[i]), 1.0e-12);
}

/// Amid liquid what pressure did is a gradient, the correction is one, too, and the pressure takes it out: without a surface nothing changes.
TEST(StrainCorrection, DoesNothingWithoutASurface)
{
    GridScene box({-3, -3, -3}, {13, 11, 11});
    box.add(tankOfCells(box, {0, 0, 0}, {10, 8, 8}));
    box.field.update(box.grid, std::vector<int>(box.grid.count(), BlockGrid::kNone), box.obstacles, true);  // walls of mirrors
    box.settings.full = true;
    box.fill([](const Vec3&) { return -1.0; });
    StrainedScene scene(std::move(box));
    scene.scene.forEachFace([&](int a, const Vec3i& c) {
        const CellRef ref = scene.scene.at(c);
        scene.scene.velocity(a, c) = scene.mass(a, ref) > 0.0 ? std::sin(1.3 * c.x() + a) * std::cos(0.9 * c.y() - 0.4 * c.z()) : 0.0;
    });
    scene.before = scene.scene.liquid.unpressed = scene.velocity();
    scene.project();
    const BlockArray<double, 3> once = scene.velocity();
    scene.correct();
    double changed = 0.0, kept = 0.0;
    for (std::size_t i = 0; i < once.size(); ++i) changed = std::max(changed, std::abs(scene.velocity().block(0)[i] - once.block(0)[i]));
    scene.project();
    for (std::size_t i = 0; i < once.size(); ++i) kept = std::max(kept, std::abs(scene.velocity().block(0)[i] - once.block(0)[i]));
    EXPECT_GT(changed, 1.0e-2);
    EXPECT_LT(kept, 1.0e-9);
}

/// Kinetic energy before and after both projections, and that of stretching, relative to the kinetic one before.
struct StepEnergies {
    double kinetic, strainBefore, strainAfter;
};
StepEnergies stepFrom(StrainedScene& scene, const BlockArray<double, 3>& given)
{
    const auto strainOf = [&](const BlockArray<double, 3>& u) {
        std::fill_n(scene.before.block(0), scene.before.size(), 0.0);
        scene.scene.liquid.unpressed = scene.before;
        return scene.dot(u, scene.correctionOf(u));
    };
    const double kinetic = scene.dot(given, given), strain = strainOf(given);
    scene.velocity() = scene.before = scene.scene.liquid.unpressed = given;
    scene.project();
    scene.correct();
    scene.project();
    const BlockArray<double, 3> end = scene.velocity();
    return {scene.dot(end, end) / kinetic, strain / kinetic, strainOf(end) / kinetic};
}

/// Four waves of random directions, not longer than `shortest` cells; at 0 noise.
void setWaves(double shortest, unsigned seed, StrainedScene& scene)
{
    scene.randomVelocities(seed);
    if (shortest == 0.0) return;
    std::mt19937 random(seed + 100);
    std::uniform_real_distribution<double> unit(-1.0, 1.0);
    std::array<Vec3, 4> waves, amplitudes;
    for (int n = 0; n < 4; ++n) {
        waves[n] = 2.0 * kPi / (shortest * scene.scene.grid.dx) * Vec3(unit(random), unit(random), unit(random));
        amplitudes[n] = Vec3(unit(random), unit(random), unit(random));
    }
    scene.scene.setVelocities([&](const Vec3& x) {
        Vec3 u = Vec3::Zero();
        for (int n = 0; n < 4; ++n) u += amplitudes[n] * std::sin(waves[n].dot(x));
        return u;
    });
}

/// The correction gives kinetic energy that the store of stretching gets, or less; what the first projection takes of states far from free of
/// divergence is more than that.
TEST(StrainCorrection, GivesNoMoreThanItsStore)
{
    double most = 0.0;
    for (const double shortest : {0.0, 4.0, 8.0, 16.0})
        for (const double far : {1.0, 0.1, 0.01, 0.001})
            for (unsigned seed = 0; seed < 6; ++seed) {
                StrainedScene scene(seed % 2 == 0 ? ball() : wavyTank(5.2 + 0.3 * seed));
                setWaves(shortest, seed, scene);
                BlockArray<double, 3> given = scene.velocity();
                scene.project();
                for (std::size_t i = 0; i < given.size(); ++i)
                    given.block(0)[i] = scene.velocity().block(0)[i] + far * (given.block(0)[i] - scene.velocity().block(0)[i]);
                const StepEnergies e = stepFrom(scene, given);
                EXPECT_LE(e.kinetic - 1.0, std::max(0.0, e.strainAfter - e.strainBefore) + 1.0e-10) << shortest << ", " << far << ", " << seed;
                most = std::max(most, e.kinetic - 1.0);
            }
    EXPECT_GT(most, 1.0e-6) << "there are states that it gives anything to";
}

}  // namespace
}  // namespace sim::test
