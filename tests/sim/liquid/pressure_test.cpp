#include "tests/sim/liquid/tanks.h"

#include "tests/sim/liquid/grid_scene.h"

#include <gtest/gtest.h>
#include <Eigen/Cholesky>
#include <Eigen/Geometry>

namespace sim::test {
namespace {

TEST(Pressure, ThinnestSurfaceFractionIsOneHundredth)
{
    // The surface 0.001 cells above a middle: its pressure is that of 0.01 cells, and the column below is exact on top
    // of that.
    GridScene scene = column(3.501);
    EXPECT_TRUE(scene.project(kDt).converged);
    const double perCell = kGravity * scene.grid.dx;
    // Mass balance of the top cell: (p − 0)/0.01 = perCell.
    EXPECT_NEAR(scene.pressureAt({2, 3, 2}), 0.01 * perCell, 1.0e-9 * perCell);
    EXPECT_NEAR(scene.pressureAt({2, 1, 2}), 2.01 * perCell, 1.0e-9 * perCell);
}

/// A closed box of 10 × 9 × 8 cells with a ball in it, full of liquid.
GridScene fullBoxWithBall(const Vec3i& shift = Vec3i::Zero())
{
    GridScene scene(Vec3i(-3, -3, -3) + shift, Vec3i(13, 12, 11) + shift);
    scene.settings.full = true;
    scene.add(tankOfCells(scene, shift, Vec3i(10, 9, 8) + shift));
    scene.add(Shape::ball(scene.corner(Vec3i(4, 5, 4) + shift) + scene.grid.dx * Vec3(0.3, 0.2, 0.6), 2.3 * scene.grid.dx));
    scene.findInside();
    scene.setMasses();
    return scene;
}

TEST(Pressure, ClosedBoxWithBallBecomesDivergenceFree)
{
    GridScene scene = fullBoxWithBall();
    ASSERT_GT(scene.countLiquid(), 600u);
    scene.setRandomVelocities(100.0);
    const double before = scene.divergence();
    EXPECT_TRUE(scene.project(kDt).converged);
    EXPECT_LT(scene.divergence(), 1.0e-11 * before);
    const BlockArray<double, 3> once = scene.liquid.faces.velocity;
    scene.project(kDt);
    scene.forEachFace([&](int a, const Vec3i& c) {
        const CellRef ref = scene.at(c);
        EXPECT_NEAR(scene.velocity(a, c), once.block(ref.block, a)[ref.cell], 1.0e-9);
    });
}

TEST(Pressure, IsTheNearestDivergenceFreeField)
{
    // What the projection takes away is orthogonal (weighted by the open fractions) to what it leaves.
    GridScene scene = fullBoxWithBall();
    scene.setRandomVelocities(100.0);
    const BlockArray<double, 3> before = scene.liquid.faces.velocity;
    scene.project(kDt);
    double product = 0.0, square = 0.0;
    scene.forEachFace([&](int a, const Vec3i& c) {
        if (!scene.isValid(a, c)) return;
        const CellRef ref = scene.at(c);
        const double left = scene.velocity(a, c), taken = before.block(ref.block, a)[ref.cell] - left;
        product += scene.open(a, c) * left * taken;
        square += scene.open(a, c) * left * left;
    });
    EXPECT_LT(std::abs(product), 1.0e-10 * square);
}

TEST(Pressure, FlowAlongATurnedWallStays)
{
    // A channel between turned walls, open (p = 0) at both ends, with a uniform flow along it.
    GridScene scene({-4, -4, 4}, {26, 26, 14});
    const double angle = 0.4;
    scene.add(turnedTank(scene, angle, {40.0, 4.3, 40.0}));
    scene.fill([&](const Vec3& x) { return (x - scene.corner({10, 10, 10})).cwiseAbs().maxCoeff() - 4.2 * scene.grid.dx; });
    const Vec3 flow(30.0 * std::cos(angle), 30.0 * std::sin(angle), 0.0);
    scene.setVelocities([&](const Vec3&) { return flow; });
    EXPECT_LT(scene.divergence(), 1.0e-10 / scene.grid.dx) << "the open fractions of a plane wall close";
    scene.project(kDt);
    EXPECT_LT(scene.largestError([&](const Vec3&) { return flow; }), 1.0e-10);
}

TEST(Pressure, BlobInFreeFallHasNone)
{
    GridScene scene({-8, -8, -8}, {8, 8, 8});
    scene.fill([&](const Vec3& x) { return (x - scene.corner({0, 0, 0})).norm() - 4.7 * scene.grid.dx; });
    scene.setVelocities(kFalling);
    scene.project(kDt);
    EXPECT_EQ(scene.largestError(kFalling), 0.0);
    scene.forEachCell([&](const Vec3i& c) { EXPECT_EQ(scene.pressureAt(c), 0.0); });
}

TEST(Pressure, MatrixIsSymmetricAndPositiveDefinite)
{
    std::mt19937 random(11);
    std::uniform_real_distribution<double> unit(-1.0, 1.0);
    GridScene scene({-8, 0, 0}, {8, 8, 8});
    scene.add(Shape::ball(scene.corner({1, 4, 4}), 2.6 * scene.grid.dx));
    scene.forEachCell([&](const Vec3i& c) {
        const bool rim = c.x() == -8 || c.x() == 7 || c.y() % 7 == 0 || c.z() % 7 == 0;
        scene.phi(c) = rim ? scene.grid.dx : (unit(random) - 0.3) * scene.grid.dx;
    });
    scene.findInside();
    scene.setMasses();
    scene.project(kDt);
    std::vector<Vec3i> cells;
    scene.forEachCell([&](const Vec3i& c) {
        if (scene.isInside(c)) cells.push_back(c);
    });
    ASSERT_GT(cells.size(), 200u);
    Eigen::MatrixXd a = Eigen::MatrixXd::Zero(static_cast<int>(cells.size()), static_cast<int>(cells.size()));
    const auto indexOf = [&](const Vec3i& c) { return static_cast<int>(std::find(cells.begin(), cells.end(), c) - cells.begin()); };
    // From the definition (liquid/README.md, Pressure), not from the way the matrix is stored.
    scene.forEachFace([&](int axis, const Vec3i& c) {
        const Vec3i below = c - Vec3i::Unit(axis);
        if (below[axis] < scene.lower[axis]) return;
        const bool above = scene.isInside(c), under = scene.isInside(below);
        const double fraction = std::max(scene.ghostFraction(c, below), 0.01);
        if (!scene.liquid.wet.test(scene.at(c).block, scene.at(c).cell, axis)) return;
        const double k = scene.open(axis, c) * kDt / (scene.grid.dx * scene.grid.dx);
        if (above && under) {
            const int i = indexOf(c), j = indexOf(below);
            a(i, i) += k, a(j, j) += k, a(i, j) -= k, a(j, i) -= k;
        } else if (above || under) {
            a(indexOf(above ? c : below), indexOf(above ? c : below)) += k / fraction;
        }
    });
    for (std::size_t n = 0; n < cells.size(); ++n) {
        const CellRef ref = scene.at(cells[n]);
        EXPECT_NEAR(scene.work.matrix.diagonal(ref.block)[ref.cell], a(n, n), 1.0e-13 * a(n, n));
        for (int axis = 0; axis < kAxes; ++axis) {
            const Vec3i below = cells[n] - Vec3i::Unit(axis);
            const double stored = scene.work.matrix.coupling(axis, ref.block)[ref.cell];
            const double expected = below[axis] >= scene.lower[axis] && scene.isInside(below) ? -a(n, indexOf(below)) : 0.0;
            EXPECT_NEAR(stored, expected, 1.0e-13);
        }
    }
    EXPECT_EQ(Eigen::LLT<Eigen::MatrixXd>(a).info(), Eigen::Success) << "positive definite";
}

TEST(Pressure, MovingTheSceneByWholeCellsChangesNothing)
{
    GridScene scene = fullBoxWithBall();
    scene.setVelocities([](const Vec3& x) { return Vec3(40.0 * std::sin(3.0 * x.y()), 40.0 * x.x() * x.z(), 40.0 * std::cos(2.0 * x.x() + x.z())); });
    const BlockArray<double, 3> start = scene.liquid.faces.velocity;
    scene.project(kDt);
    for (const Vec3i& shift : {Vec3i(8, -16, 8), Vec3i(3, 1, -2), Vec3i(-7, 5, 4)}) {
        // The origin moves the other way, so that the solids stay exactly where they are.
        GridScene other = fullBoxWithBall(shift);
        scene.forEachFace([&](int a, const Vec3i& c) {
            const CellRef ref = scene.at(c);
            const Vec3i to = c + shift;
            if (other.at(to).block != BlockGrid::kNone) other.velocity(a, to) = start.block(ref.block, a)[ref.cell];
        });
        other.project(kDt);
        scene.forEachFace([&](int a, const Vec3i& c) {
            if (!scene.isValid(a, c)) return;
            EXPECT_TRUE(other.isValid(a, c + shift));
            EXPECT_NEAR(other.velocity(a, c + shift), scene.velocity(a, c), 1.0e-8) << shift.transpose();
        });
    }
}

TEST(Pressure, MirroredSceneGivesTheMirrorImage)
{
    const auto build = [](double sign) {
        GridScene scene({-8, -8, -8}, {8, 8, 8}, 0.288, Vec3::Zero());
        scene.add(tankOfCells(scene, {-6, -6, -6}, {6, 6, 6}));
        scene.add(Shape::ball({sign * 0.4, 0.2, -0.3}, 0.5));
        scene.fill([&](const Vec3& x) { return x.y() - 0.3 - 0.2 * sign * x.x(); });
        scene.setVelocities([&](const Vec3& x) {
            const Vec3 y(sign * x.x(), x.y(), x.z());
            return Vec3(sign * 50.0 * std::sin(2.0 * y.x() + y.y()), -30.0 + 20.0 * y.x(), 10.0 * y.z() * y.x());
        });
        scene.project(kDt);
        return scene;
    };
    GridScene scene = build(1.0), image = build(-1.0);
    scene.forEachFace([&](int a, const Vec3i& c) {
        if (!scene.isValid(a, c)) return;
        const Vec3i to(a == 0 ? -c.x() : -1 - c.x(), c.y(), c.z());
        EXPECT_TRUE(image.isValid(a, to));
        EXPECT_NEAR(image.velocity(a, to), (a == 0 ? -1.0 : 1.0) * scene.velocity(a, c), 1.0e-8);
    });
}

TEST(Pressure, MovingWallPushesTheLiquid)
{
    // A piston fills one end of a full tube whose other end is open: everything moves with it.
    GridScene scene({-8, -8, -8}, {16, 8, 8});
    scene.add(tankOfCells(scene, {-6, -2, -2}, {14, 2, 2}));
    Motion motion;
    motion.addTranslation(0.0, 1.0, {10.0, 0.0, 0.0}, 0.0, 0.0);
    const Vec3 low = scene.corner({-8, -4, -4}), high = scene.corner({-3, 4, 4});
    scene.obstacles.add(Shape::box(0.5 * (low + high), 0.5 * (high - low)), motion);
    scene.obstacles.moveTo(0.0, 1.0e-9);
    scene.updateObstacles();
    const double end = scene.corner({9, 0, 0}).x() + 0.2 * scene.grid.dx;
    scene.fill([&](const Vec3& x) { return x.x() - end; });
    scene.project(kDt);
    EXPECT_LT(scene.largestError([](const Vec3&) { return Vec3(10.0, 0.0, 0.0); }), 1.0e-6);
    EXPECT_GT(scene.countLiquid(), 12u * 16u - 1u);
}

TEST(Pressure, DryFacesOfCellsInObstaclesGetNoVelocity)
{
    // A cell cut by a ball is liquid through its wet lower face; its upper face is open to the air but carries no
    // liquid.
    GridScene scene({0, 0, 0}, {8, 8, 8});
    scene.add(Shape::ball(scene.middle({4, 4, 4}) + scene.grid.dx * Vec3(0.0, 0.1, 0.0), 0.45 * scene.grid.dx));
    scene.phi({4, 3, 4}) = -0.3 * scene.grid.dx;
    scene.findInside();
    scene.setMasses();
    scene.phi({4, 4, 4}) = -0.1 * scene.grid.dx;
    scene.findInside();
    ASSERT_TRUE(scene.isInside({4, 4, 4}));
    ASSERT_GT(scene.open(1, {4, 5, 4}), 0.0);
    scene.setRandomVelocities(10.0);
    scene.project(kDt);
    EXPECT_TRUE(scene.isValid(1, {4, 4, 4}));
    EXPECT_FALSE(scene.isValid(1, {4, 5, 4})) << "the solution knows nothing of this face";
}

/// Largest error of the pressure of a ball of radius 1 cm in which p = sin(r²) − sin(1), relative to its largest value.
double errorInBall(int cellsPerRadius)
{
    const double dx = 1.0 / cellsPerRadius;
    const int n = cellsPerRadius + 3;
    GridScene scene(Vec3i::Constant(-n), Vec3i::Constant(n), dx, Vec3::Zero());
    const Vec3 middle = dx * Vec3(0.31, -0.22, 0.13);
    const auto exact = [&](const Vec3& x) { return std::sin((x - middle).squaredNorm()) - std::sin(1.0); };
    scene.fill([&](const Vec3& x) { return (x - middle).norm() - 1.0; });
    // What the gradient takes away again.
    scene.setVelocities(
        [&](const Vec3& x) { return Vec3((kDt / scene.settings.density) * 2.0 * std::cos((x - middle).squaredNorm()) * (x - middle)); });
    EXPECT_TRUE(scene.project(kDt).converged);
    double largest = 0.0;
    scene.forEachCell([&](const Vec3i& c) {
        if (scene.isInside(c)) largest = std::max(largest, std::abs(scene.pressureAt(c) - exact(scene.middle(c))));
    });
    return largest / std::sin(1.0);
}

TEST(Pressure, WithGhostFluidFractionsIsOfSecondOrderAtACurvedSurface)
{
    const double coarse = errorInBall(8), fine = errorInBall(16), finest = errorInBall(32);
    std::printf("error of the pressure in a ball: %.2e, %.2e, %.2e at 8, 16, 32 cells per radius\n", coarse, fine, finest);
    EXPECT_LT(coarse, 0.02);
    EXPECT_LT(finest, coarse / 12.0) << "second order: a sixteenth";
}

}  // namespace
}  // namespace sim::test
