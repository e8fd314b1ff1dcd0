// Curvature of surfaces that are known, and what its pressure does on the grid (liquid/README.md, Surface tension).
#include "sim/liquid/surface_tension.h"
#include "sim/core/units.h"
#include "sim/time_step.h"
#include "tests/sim/fixtures.h"
#include "tests/sim/liquid/grid_scene.h"

#include <gtest/gtest.h>

#include <optional>

namespace sim::test {
namespace {

/// Spread of the fill that P2G leaves along each axis: B-splines and the mean over a cell's faces [cells].
const double kSpread = std::sqrt(1.0 / 3.0);

double gauss(double x) { return std::exp(-0.5 * x * x / (kSpread * kSpread)) / (kSpread * std::sqrt(2.0 * kPi)); }
/// Fill at a distance from a plane surface [cells].
double planeFill(double distance) { return 0.5 * std::erfc(distance / (std::sqrt(2.0) * kSpread)); }
/// And r from the middle of a ball: a ball smoothed by a Gaussian, in closed form.
double ballFill(double r, double radius)
{
    return planeFill(r - radius) - planeFill(r + radius) - kSpread * kSpread / r * (gauss(r - radius) - gauss(r + radius));
}

/// Liquid that is given by the fill of the cells, and the curvatures found on the faces of its surface.
struct Surface {
    struct Face {
        Vec3 x;        ///< [cells]
        double kappa;  ///< [1/cell]
    };
    GridScene scene;
    SurfaceTensionWorkspace work;
    std::vector<Face> faces;

    /// @param fill  of the cell at x [cells]
    template <class Fill>
    Surface(const Vec3i& lower, const Vec3i& upper, Fill&& fill, const std::optional<Shape>& wall = {}, double cell = 1.0)
        : scene(lower, upper, cell, Vec3::Zero())
    {
        if (wall) scene.add(*wall);
        LiquidGrid& liquid = scene.liquid;
        scene.forEachCell([&](const Vec3i& c) {
            const CellRef at = scene.at(c);
            liquid.fill.block(at.block)[at.cell] = fill(Vec3(c.cast<double>() + Vec3::Constant(0.5)));
            scene.phi(c) = kLiquidFill - liquid.fill.block(at.block)[at.cell];
            for (int a = 0; a < kAxes; ++a) liquid.wet.set(at.block, at.cell, a);
        });
        scene.findInside();
        scene.settings.surfaceTension = 1.0;
        findSteps();
        scene.forEachFace([&](int a, const Vec3i& c) {
            const double step = work.step.block(scene.at(c).block, a)[scene.at(c).cell];
            if (step == 0.0) return;
            const double kappa = (scene.isInside(c) ? -step : step) * cell;
            faces.push_back({c.cast<double>() + Vec3::Constant(0.5) - 0.5 * Vec3::Unit(a), kappa});
        });
    }
    SurfaceSteps findSteps() { return findSurfaceSteps(scene.cut(), scene.settings, scene.givenSurface(), work); }
};

struct Errors {
    double mean = 0.0, rms = 0.0;
};
/// Relative errors of the curvatures, of faces within a box around `middle`.
Errors errorsOf(const Surface& surface, double exact, const Vec3& middle = Vec3::Zero(), double halfWidth = 1.0e9)
{
    Errors errors;
    int count = 0;
    for (const Surface::Face& face : surface.faces) {
        if ((face.x - middle).cwiseAbs().maxCoeff() > halfWidth) continue;
        const double error = face.kappa / exact - 1.0;
        errors.mean += error;
        errors.rms += error * error;
        ++count;
    }
    EXPECT_GT(count, 50);
    errors.mean /= count;
    errors.rms = std::sqrt(errors.rms / count);
    return errors;
}

Errors errorsOfBall(double radius)
{
    const int reach = static_cast<int>(radius) + 4;
    const Vec3 middle(0.31, 0.17, -0.43);
    const Surface ball(Vec3i::Constant(-reach), Vec3i::Constant(reach), [&](const Vec3& x) { return ballFill((x - middle).norm(), radius); });
    const Errors errors = errorsOf(ball, 2.0 / radius);
    std::printf("ball of %2.0f cells: curvature %+.2f %% on average, %.2f %% rms\n", radius, 100.0 * errors.mean, 100.0 * errors.rms);
    return errors;
}

/// What is left falls with the first power of the cell: linear interpolation to the surface, where it crosses the
/// face's line, and where it only grazes it the curvature of a level up to half a cell off.
TEST(SurfaceTension, CurvatureOfABallConverges)
{
    const Errors coarse = errorsOfBall(6.0), middle = errorsOfBall(10.0), fine = errorsOfBall(20.0);
    EXPECT_LT(std::abs(coarse.mean), 0.02);
    EXPECT_LT(std::abs(middle.mean), 0.01);
    EXPECT_LT(std::abs(fine.mean), 0.006);
    EXPECT_LT(middle.rms, 0.02);
    EXPECT_LT(middle.rms, coarse.rms / 1.3);
    EXPECT_LT(fine.rms, middle.rms / 1.3);
}

TEST(SurfaceTension, CurvatureOfACylinder)
{
    const double radius = 10.0;
    // A Gaussian moves a cylinder's surface inwards by s² / 2R.
    const Surface cylinder({-16, -16, -24}, {16, 16, 24}, [&](const Vec3& x) {
        const double r = std::hypot(x.x() - 0.3, x.y() + 0.2);
        return planeFill(r - radius + kSpread * kSpread / (2.0 * radius));
    });
    const Errors errors = errorsOf(cylinder, 1.0 / radius, {0.0, 0.0, 0.0}, 13.0);
    std::printf("cylinder: curvature %+.2f %% on average, %.2f %% rms\n", 100.0 * errors.mean, 100.0 * errors.rms);
    EXPECT_LT(std::abs(errors.mean), 0.01);
    EXPECT_LT(errors.rms, 0.02);
}

TEST(SurfaceTension, PlanesAreFlat)
{
    for (const Vec3& direction : {Vec3(0.0, 1.0, 0.0), Vec3(1.0, 2.0, 0.0), Vec3(2.0, -1.0, 3.0)}) {
        const Vec3 normal = direction.normalized();
        const Surface plane(Vec3i::Constant(-32), Vec3i::Constant(32), [&](const Vec3& x) { return planeFill(normal.dot(x) - 0.37); });
        double largest = 0.0;
        int count = 0;
        for (const Surface::Face& face : plane.faces) {  // far from where the blocks end, and the liquid with them
            if (face.x.cwiseAbs().maxCoeff() > 14.0) continue;
            largest = std::max(largest, std::abs(face.kappa));
            ++count;
        }
        std::printf("plane (%g, %g, %g): curvature up to %.1e of a cell's\n", direction.x(), direction.y(), direction.z(), largest);
        EXPECT_GT(count, 100);
        EXPECT_LT(largest, 1.0e-3);  // of a ball of 10 cells it is 0.2
    }
}

/// Half a ball on a wall in a plane of faces has the curvatures that the whole ball has there, to the rounding of sums.
TEST(SurfaceTension, WallsMirror)
{
    const auto fill = [&](const Vec3& x) { return ballFill((x - Vec3(0.2, 0.0, -0.3)).norm(), 9.0); };
    const Surface whole(Vec3i::Constant(-16), Vec3i::Constant(16), fill);
    const Surface half(Vec3i::Constant(-16), Vec3i::Constant(16), fill, Shape::box({0.0, -100.0, 0.0}, {200.0, 100.0, 200.0}));
    std::size_t compared = 0;
    for (const Surface::Face& face : whole.faces) {
        const auto same = [&](const Surface::Face& other) { return other.x == face.x; };
        const auto found = std::find_if(half.faces.begin(), half.faces.end(), same);
        if (face.x.y() <= 0.0) continue;
        ASSERT_NE(found, half.faces.end());
        EXPECT_NEAR(found->kappa, face.kappa, 1.0e-12);
        ++compared;
    }
    EXPECT_EQ(compared, half.faces.size());
    EXPECT_GT(compared, 500u);
}

/// The same pressure in all the air around a drop leaves it at rest, and is found in it.
TEST(SurfaceTension, ConstantCurvatureIsHeldToRounding)
{
    constexpr double kPressure = 1000.0, kStep = 1.0e-3;
    Surface drop(
        Vec3i::Constant(-12), Vec3i::Constant(12), [&](const Vec3& x) { return ballFill(x.norm() + 1.0e-9, 7.0); }, {}, 0.288);
    GridScene& scene = drop.scene;
    scene.setMasses();
    const SurfaceSteps steps = drop.findSteps();
    for (int b = 0; b < scene.grid.count(); ++b)
        for (int n = 0; n < 3 * kBlockCells; ++n) {
            double& step = drop.work.step.block(b)[n];
            if (step != 0.0) step = std::copysign(kPressure, step);
        }
    const PressureSystem system = scene.system(kStep);
    applySurfaceSteps(scene.cut(), system, 1.0, steps, scene.liquid);
    const SolveReport report = scene.project(system);
    EXPECT_TRUE(report.converged);
    const double scale = kStep * kPressure / scene.grid.dx;  // what it would do to a full face alone
    scene.forEachFace([&](int a, const Vec3i& c) { EXPECT_LT(std::abs(scene.velocity(a, c)), 1.0e-10 * scale); });
    int inside = 0;
    scene.forEachCell([&](const Vec3i& c) {
        if (!scene.isInside(c)) return;
        EXPECT_NEAR(scene.pressureAt(c), kPressure, 1.0e-9 * kPressure);
        ++inside;
    });
    EXPECT_GT(inside, 1000);
}

TEST(SurfaceTension, SameBitsForAnyThreadCount)
{
    const auto steps = [&] {
        const Surface ball(Vec3i::Constant(-16), Vec3i::Constant(16), [&](const Vec3& x) { return ballFill((x - Vec3(0.3, 0.2, 0.1)).norm(), 9.0); });
        std::vector<double> kappa;
        for (const Surface::Face& face : ball.faces) kappa.push_back(face.kappa);
        return kappa;
    };
    const std::vector<double> one = onThreads(1, steps);
    EXPECT_EQ(one, onThreads(2, steps));
    EXPECT_EQ(one, onThreads(8, steps));
}

TEST(SurfaceTension, BoundsTheStepInEveryMode)
{
    Settings settings;
    settings.cell = 0.288;
    settings.time.dt = 1.0;
    settings.time.cfl = settings.time.maxCflLiquid = 100.0;
    State state;
    state.liquid.add(Vec3::Zero(), 1.0, 0, Vec3::Zero());
    for (const TimeMode mode : {TimeMode::Fixed, TimeMode::Cfl}) {
        settings.time.mode = mode;
        settings.liquid.surfaceTensionForce = false;
        EXPECT_GT(chooseTimeStep(settings, state, 0.0), 0.5);
        settings.liquid.surfaceTensionForce = true;
        EXPECT_NEAR(chooseTimeStep(settings, state, 0.0), 5.14e-3, 1.0e-5);  // √(0.288³ / (4 π 72))
        settings.liquid.full = true;
        EXPECT_GT(chooseTimeStep(settings, state, 0.0), 0.5);
        settings.liquid.full = false;
    }
}

}  // namespace
}  // namespace sim::test
