#include "sim/core/units.h"
#include "sim/fabric/grid/grid_solver.h"
#include "sim/fabric/solids/guard.h"
#include "sim/fabric/vertex_solver.h"
#include "tests/sim/fabric/solid_crossings.h"

#include <gtest/gtest.h>

#include <functional>

namespace sim::testing {
namespace {

/// A solid anywhere about the origin, turned: thin, pointed or round.
ObstacleSettings anySolid(Noise& noise)
{
    ObstacleSettings solid;
    const int kind = static_cast<int>(2.5 * (1.0 + noise()));
    const double size = 0.6 + 0.4 * noise();
    if (kind == 0) solid.shape = Shape::box(Vec3::Zero(), {size, 0.01, size});
    if (kind == 1) solid.shape = Shape::box(Vec3::Zero(), {0.01, size, 0.02});
    if (kind == 2) solid.shape = Shape::capsule({0.0, -size, 0.0}, {0.0, size, 0.0}, 0.03);
    if (kind == 3) solid.shape = Shape::ball(Vec3::Zero(), 0.5 * size);
    if (kind >= 4)
        solid.shape = Shape::subtract(
            {Shape::box(Vec3::Zero(), Vec3::Constant(size)), Shape::box({0.0, 0.1, 0.0}, {size - 0.05, size, size - 0.05})});
    const Vec3 axis = noise.vector().normalized();
    solid.shape = solid.shape.moved(Eigen::Isometry3d(Eigen::AngleAxisd(kPi * noise(), axis)));
    return solid;
}

FabricPiece anyFabric(Noise& noise)
{
    FabricPiece piece;
    if (noise() < 0.3) {
        ClothGrid grid;
        grid.nodes = Vec2i(9, 9);
        const double pitch = 0.12 + 0.08 * noise();
        grid.spacing = {pitch, pitch};
        piece = pieceOf(clothGrid(grid), wool(), {0.0165, 0.0165});
        piece.material.poisson = 0.2;
    } else {
        piece = pieceOf(strand(Vec3(-0.8, 0.0, 0.1 * noise()), Vec3(0.8, 0.1 * noise(), 0.0), 12), wool(), {0.03, 0.03});
    }
    return piece;
}

void moveTo(FabricPiece& piece, const Vec3& middle, const Mat3& turn)
{
    Vec3 mean = Vec3::Zero();
    for (const Vec3& x : piece.points) mean += x / static_cast<double>(piece.points.size());
    for (Vec3& x : piece.points) x = middle + turn * (x - mean);
}

/// Fabric in front of a solid that goes through it, if nothing keeps it from that.
struct Encounter {
    explicit Encounter(unsigned seed, double speed)
    {
        Noise noise(seed);
        solid = anySolid(noise);
        const Mat3 turn = Eigen::AngleAxisd(kPi * noise(), noise.vector().normalized()).toRotationMatrix();
        FabricPiece piece = anyFabric(noise);
        const Vec3 way = noise.vector().normalized();
        moveTo(piece, Vec3::Zero(), turn);
        // Out of the solid along the way, until no vertex or middle is within it.
        for (double ahead = 0.0; clearance(assembleFabric({&piece, 1}), piece.points, solid.shape) < 0.1; ahead += 0.05)
            moveTo(piece, ahead * way, turn);
        solid.motion.addTranslation(0.0, 1.0, 0.5 * speed * way + 0.1 * speed * noise.vector(), 0.0, 0.0);
        solid.motion.addRotation(0.0, 1.0, noise.vector().normalized(), 20.0 * noise(), Vec3::Zero(), Motion::Frame::Local, 0.0, 0.0);
        piece.velocity = -0.5 * speed * way;
        pieces = {piece};
    }
    ObstacleSettings solid;
    std::vector<FabricPiece> pieces;
};

TEST(SolidGuard, NoMoveGetsThroughASolid)
{
    int without = 0;
    for (unsigned seed = 1; seed <= 60; ++seed) {
        const Encounter scene(seed, 500.0);
        Noise noise(1000 + seed);
        const Fabric fabric = assembleFabric(scene.pieces);
        SolidGuard guard(fabric, {&scene.solid, 1});
        std::vector<Vec3> x = fabric.rest, u(x.size());
        for (int step = 0; step < 8; ++step) {
            const double t0 = 2.0e-3 * step, t1 = t0 + 2.0e-3;
            for (Vec3& move : u) move = 2.0e-3 * scene.pieces[0].velocity + 0.05 * noise.vector();
            guard.moveTo(t0, t1);
            without += crossings(fabric, scene.solid, t0, t1, x, u) > 0;
            GuardReport report;
            guard.limit(x, fabric.mass, u, report);
            EXPECT_EQ(report.left, 0) << "seed " << seed << " step " << step;
            ASSERT_EQ(crossings(fabric, scene.solid, t0, t1, x, u), 0) << "seed " << seed << " step " << step;
            const Eigen::Isometry3d toEnd = scene.solid.motion.transform(t1).inverse();
            for (std::size_t v = 0; v < x.size(); ++v) {
                x[v] += u[v];
                ASSERT_GT(scene.solid.shape.distance(toEnd * x[v]), 0.56 * fabric.radius[v]) << "seed " << seed << " step " << step;
            }
        }
    }
    EXPECT_GT(without, 60);  // of 480 moves
}

/// Takes steps with a solver: step(t).
/// @return crossings, along straight ways from one step to the next where `isStraight`; a solver may go around a corner in parts of a step
int crossingsOf(const Encounter& scene, const Fabric& fabric, FabricState& state, double h, int steps, bool isStraight,
                const std::function<void(double)>& step)
{
    int count = 0;
    double time = 0.0;
    for (int i = 0; i < steps; ++i, time += h) {
        const std::vector<Vec3> before = state.x;
        step(time);
        std::vector<Vec3> u(before.size());
        for (std::size_t v = 0; v < u.size(); ++v) u[v] = isStraight ? state.x[v] - before[v] : Vec3(Vec3::Zero());
        const double start = isStraight ? time : time + h;
        count += crossings(fabric, scene.solid, start, time + h, isStraight ? before : state.x, u);
    }
    return count;
}

const Vec3 kGravity(0.0, -kEarthGravity, 0.0);

int crossingsInVertexSolver(const Encounter& scene, double h, int steps, bool isStraight)
{
    const Fabric fabric = assembleFabric(scene.pieces);
    FabricState state = initialState(fabric, scene.pieces);
    VertexSolver solver(fabric, {}, {&scene.solid, 1});
    return crossingsOf(scene, fabric, state, h, steps, isStraight, [&](double t) {
        StepReport report;
        StageClock clock(report);
        solver.step(t, h, kGravity, state, clock);
    });
}

TEST(FabricAtSolids, IsNeverCrossedBySolverVertex)
{
    for (unsigned seed = 1; seed <= 15; ++seed) {
        const Encounter scene(seed, 500.0);
        EXPECT_EQ(crossingsInVertexSolver(scene, 2.0e-4, 40, true), 0) << "seed " << seed;
        EXPECT_EQ(crossingsInVertexSolver(scene, 2.0e-3, 10, false), 0) << "seed " << seed;
    }
}

TEST(FabricAtSolids, IsNeverCrossedBySolverGrid)
{
    Settings settings;
    settings.cell = 0.25;
    settings.fabric.solver = FabricSolver::Grid;
    for (unsigned seed = 1; seed <= 15; ++seed) {
        const Encounter scene(seed, 500.0);
        const Fabric fabric = assembleFabric(scene.pieces);
        FabricState state = initialState(fabric, scene.pieces);
        GridFabricSolver solver(fabric, settings, {&scene.solid, 1});
        const double h = seed % 2 == 0 ? 1.0e-3 : 2.5e-4;
        EXPECT_EQ(crossingsOf(scene, fabric, state, h, 15, true, [&](double t) {
            StepReport report;
            StageClock clock(report);
            solver.step(t, h, kGravity, state, clock);
        }), 0) << "seed " << seed;
    }
}

}  // namespace
}  // namespace sim::testing
