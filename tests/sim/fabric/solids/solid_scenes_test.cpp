#include "sim/core/units.h"
#include "sim/fabric/grid/grid_solver.h"
#include "sim/fabric/vertex/vertex_solver.h"
#include "sim/shapes/tessellate.h"
#include "tests/physics/intersection_check.h"
#include "tests/sim/fabric/solids/solid_crossings.h"

#include <gtest/gtest.h>

#include <numeric>

namespace sim::testing {
namespace {

constexpr double kRadius = 0.0165;

FabricPiece sheet(int nodes, double size, const Vec3& middle, const Mat3& turn = Mat3::Identity())
{
    ClothGrid grid;
    grid.nodes = Vec2i(nodes, nodes);
    const double pitch = size / (nodes - 1);
    grid.spacing = {pitch, pitch};
    FabricPiece piece = pieceOf(clothGrid(grid), wool(), {kRadius, kRadius});
    piece.material.poisson = 0.2;
    Vec3 mean = Vec3::Zero();
    for (const Vec3& x : piece.points) mean += x / static_cast<double>(piece.points.size());
    for (Vec3& x : piece.points) x = middle + turn * (x - mean);
    return piece;
}

/// Fabric among solids under both solvers.
struct SolidRun {
    SolidRun(std::vector<FabricPiece> p, std::vector<ObstacleSettings> s, FabricSolver kind)
        : pieces(std::move(p)), solids(std::move(s)), fabric(assembleFabric(pieces)), state(initialState(fabric, pieces))
    {
        settings.cell = 0.25;
        settings.fabric.solver = kind;
        if (kind == FabricSolver::Vertex) vertex.emplace(fabric, settings.fabric, solids);
        else grid.emplace(fabric, settings, solids);
    }
    void step(double h)
    {
        StageTimes stages;
        StageClock clock(stages);
        if (vertex) report = vertex->step(time, h, gravity, state, clock);
        else report = grid->step(time, h, gravity, state, clock);
        time += h;
    }
    /// Vertices, edges and faces that solids reach into now.
    int pierced() const
    {
        int count = 0;
        const std::vector<Vec3> still(state.x.size(), Vec3::Zero());
        for (const ObstacleSettings& solid : solids) count += crossings(fabric, solid, time, time, state.x, still);
        return count;
    }
    double lowestAbove(const ObstacleSettings& solid, double top) const
    {
        double least = 1.0e9;
        const Eigen::Isometry3d to = solid.motion.transform(time).inverse();
        for (const Vec3& x : state.x) least = std::min(least, (to * x).y() - top);
        return least;
    }
    double fastest() const
    {
        double speed = 0.0;
        for (const Vec3& v : state.v) speed = std::max(speed, v.norm());
        return speed;
    }
    std::vector<FabricPiece> pieces;
    std::vector<ObstacleSettings> solids;
    Settings settings;
    Fabric fabric;
    FabricState state;
    std::optional<VertexSolver> vertex;
    std::optional<GridFabricSolver> grid;
    FabricReport report;
    Vec3 gravity = Vec3(0.0, -kEarthGravity, 0.0);
    double time = 0.0;
};

constexpr std::array kSolvers = {FabricSolver::Vertex, FabricSolver::Grid};

ObstacleSettings solidOf(const Shape& shape)
{
    ObstacleSettings solid;
    solid.shape = shape;
    return solid;
}

TEST(FabricAtSolids, LayersAreCarriedAheadOfAFastPlate)
{
    for (const FabricSolver kind : kSolvers)
        for (const double h : {2.0e-3, 5.0e-4}) {
            ObstacleSettings plate = solidOf(Shape::box({0.0, -0.01, 0.0}, {3.0, 0.01, 3.0}));
            plate.motion.addTranslation(0.0, 0.1, Vec3(0.0, 50.0, 0.0), 0.0, 0.0);
            SolidRun run({sheet(9, 2.0, {0.0, 0.3, 0.0}), sheet(8, 1.7, {0.1, 0.4, 0.0}), sheet(7, 1.5, {0.0, 0.5, 0.1})}, {plate}, kind);
            for (int i = 0; i < 20; ++i) {
                run.step(h);
                ASSERT_GT(run.lowestAbove(plate, 0.0), 0.5 * kRadius) << "h " << h << " step " << i << " solver " << int(kind);
                if (kind == FabricSolver::Vertex) {
                    ASSERT_EQ(test::piercedFaces(run.fabric, run.state.x), 0) << "h " << h << " step " << i;
                }
            }
            EXPECT_LT(run.fastest(), 1500.0) << h << " " << int(kind);
        }
}

TEST(FabricAtSolids, APinnedSheetIsNotPiercedByWhatSweepsThroughIt)
{
    for (const FabricSolver kind : kSolvers)
        for (int shape = 0; shape < 3; ++shape) {
            ObstacleSettings solid =
                solidOf(shape == 0   ? Shape::capsule({0.13, -0.5, 0.07}, {0.13, -3.0, 0.07}, 0.02)
                        : shape == 1 ? Shape::box({0.13, -1.5, 0.07}, {0.01, 1.0, 0.4})
                                     : Shape::box(Vec3::Zero(), {0.4, 0.4, 0.4})
                                           .moved(Eigen::Translation3d(0.1, -1.3, 0.0) * Eigen::AngleAxisd(0.9, Vec3(1.0, 0.3, 0.8).normalized())));
            solid.motion.addTranslation(0.0, 0.01, Vec3(0.1, 1.2, 0.1), 0.0, 0.0);
            solid.motion.addRotation(0.0, 0.01, {Vec3::UnitY(), Vec3::Zero()}, 1.0, 0.0, 0.0);
            FabricPiece piece = sheet(9, 2.0, Vec3::Zero());
            PinGroup pins;
            pins.vertices = {0, 8, 72, 80};
            piece.pins = {pins};
            SolidRun run({piece}, {solid}, kind);
            for (int i = 0; i < 40; ++i) {
                run.step(5.0e-4);
                ASSERT_EQ(run.pierced(), 0) << "shape " << shape << " step " << i << " solver " << int(kind);
            }
        }
}

TEST(FabricAtSolids, APressSqueezesButDoesNotPierce)
{
    for (const FabricSolver kind : kSolvers) {
        ObstacleSettings table = solidOf(Shape::box({0.0, -0.05, 0.0}, {2.0, 0.05, 2.0})),
                         press = solidOf(Shape::box({0.0, 1.0, 0.0}, {0.6, 0.1, 0.6}));
        press.motion.addTranslation(0.0, 0.01, Vec3(0.0, -0.87, 0.0), 0.002, 0.002);  // to 0.03 above the table
        SolidRun run({sheet(11, 2.0, {0.0, 0.05, 0.0})}, {table, press}, kind);
        for (int i = 0; i < 40; ++i) {
            run.step(5.0e-4);
            ASSERT_EQ(run.pierced(), 0) << "step " << i << " solver " << int(kind);
        }
    }
}

TEST(FabricAtSolids, ATurningDrumKeepsWhatIsInIt)
{
    for (const FabricSolver kind : kSolvers) {
        ObstacleSettings drum = solidOf(Shape::box(Vec3::Zero(), {1.0, 1.0, 1.0}).inverted());
        drum.motion.addRotation(0.0, 1.0, {Vec3::UnitZ(), Vec3::Zero()}, 60.0, 0.0, 0.0);
        SolidRun run({sheet(9, 1.2, {0.0, -0.3, 0.0})}, {drum}, kind);
        for (int i = 0; i < 100; ++i) {
            run.step(1.0e-3);
            ASSERT_EQ(run.pierced(), 0) << "step " << i << " solver " << int(kind);
        }
    }
}

TEST(FabricAtSolids, AMeshHoldsAsItsSamplesSay)
{
    const TriangleMesh mesh = tessellate(Shape::unite({Shape::ball(Vec3::Zero(), 0.5), Shape::capsule(Vec3::Zero(), {0.0, 1.0, 0.0}, 0.2)}), 0.1);
    for (const FabricSolver kind : kSolvers) {
        ObstacleSettings solid = solidOf(Shape::mesh(mesh.vertices, mesh.triangles, 0.05));
        solid.motion.addTranslation(0.0, 1.0, Vec3(0.0, 300.0, 0.0), 0.0, 0.0);
        SolidRun run({sheet(9, 3.0, {0.2, 1.4, 0.1})}, {solid}, kind);
        for (int i = 0; i < 40; ++i) {
            run.step(1.0e-3);
            ASSERT_EQ(run.pierced(), 0) << "step " << i << " solver " << int(kind);
        }
    }
}

TEST(FabricAtSolids, InitialOverlapIsResolved)
{
    for (const FabricSolver kind : kSolvers) {
        const ObstacleSettings table = solidOf(Shape::box({0.0, -0.5, 0.0}, {2.0, 0.5, 2.0}));
        SolidRun run({sheet(9, 1.0, {0.0, -0.01, 0.0}, Eigen::AngleAxisd(0.01, Vec3::UnitX()).toRotationMatrix())}, {table}, kind);
        for (int i = 0; i < 200; ++i) run.step(1.0e-3);
        EXPECT_EQ(run.pierced(), 0) << int(kind);
        EXPECT_LT(run.fastest(), 10.0) << int(kind);
    }
}

TEST(FabricAtSolids, LayersHangOverARodAndLieOnAThinFloor)
{
    for (const FabricSolver kind : kSolvers) {
        const ObstacleSettings rod = solidOf(Shape::capsule({-5.0, 0.0, 0.0}, {5.0, 0.0, 0.0}, 0.02)),
                               floor = solidOf(Shape::box({0.0, -1.01, 0.0}, {9.0, 0.01, 9.0}));
        SolidRun run({sheet(9, 2.0, {0.0, 0.3, 0.0}), sheet(8, 2.0, {0.2, 0.4, 0.3}), sheet(7, 1.0, {0.1, 0.5, 1.5})}, {rod, floor}, kind);
        for (FabricPiece& piece : run.pieces) piece.velocity = Vec3(0.0, -100.0, 0.0);
        run.state = initialState(run.fabric, run.pieces);
        for (int i = 0; i < 60; ++i) {
            run.step(2.0e-3);
            ASSERT_EQ(run.pierced(), 0) << "step " << i << " solver " << int(kind);
            ASSERT_GT(run.lowestAbove(floor, -1.0), 0.5 * kRadius);
        }
    }
}

/// Where pins lead they go; all else stays in front of the solid, and goes on moving.
TEST(FabricAtSolids, PinsThatAreLedThroughATableTakeNothingElseThrough)
{
    for (const FabricSolver kind : kSolvers) {
        const ObstacleSettings table = solidOf(Shape::box({0.0, -0.01, 0.0}, {3.0, 0.01, 3.0}));
        FabricPiece piece = sheet(9, 2.0, {0.0, 0.1, 0.0});
        PinGroup pins;
        pins.vertices = {0};
        pins.motion.addTranslation(0.0, 0.1, Vec3(0.0, -0.4, 0.0), 0.0, 0.0);
        piece.pins = {pins};
        SolidRun run({piece}, {table}, kind);
        for (int i = 0; i < 50;
             ++i) {  // later the cloth is pulled out of all proportion, and springs may not become stiffer than its motion pays for
            run.step(1.0e-3);
            for (std::size_t v = 1; v < run.state.x.size(); ++v)
                ASSERT_GT(run.state.x[v].y(), 0.5 * kRadius) << "step " << i << " solver " << int(kind);
            ASSERT_EQ(run.report.truncatedSubsteps, 0) << "step " << i << " solver " << int(kind);
        }
        EXPECT_LT(run.state.x[0].y(), -0.09);
        EXPECT_LT(run.state.x[80].y(), 0.05);  // the far corner has fallen
    }
}

/// What a plate gives is booked as work of obstacles, whether its penalty gave it or the guard.
TEST(FabricAtSolids, WorkOfAFastPlateIsBooked)
{
    for (const FabricSolver kind : kSolvers)
        for (const double h : {1.0e-3, 2.5e-4}) {
            ObstacleSettings plate = solidOf(Shape::box({0.0, -0.01, 0.0}, {3.0, 0.01, 3.0}));
            plate.motion.addTranslation(0.0, 0.1, Vec3(0.0, 50.0, 0.0), 0.0, 0.0);
            SolidRun run({sheet(9, 2.0, {0.0, 0.1, 0.0}, Eigen::AngleAxisd(0.03, Vec3::UnitX()).toRotationMatrix())}, {plate}, kind);
            const auto energies = [&] {
                return run.vertex ? run.vertex->energies(run.state, run.gravity) : run.grid->energies(run.state, run.gravity);
            };
            run.vertex ? run.vertex->bookEnergy() : run.grid->bookEnergy();
            const double start = energies().total();
            EnergyChanges all;
            for (int i = 0; i < 10; ++i) {
                run.step(h);
                all += *run.report.energyChanges;
            }
            const double gained = energies().total() - start, booked = std::accumulate(all.of.begin(), all.of.end(), 0.0);
            EXPECT_NEAR(booked, gained, 0.02 * gained) << "solver " << int(kind) << " h " << h;
            EXPECT_GT(all[EnergyChange::Obstacles], 0.9 * gained);
        }
}

}  // namespace
}  // namespace sim::testing
