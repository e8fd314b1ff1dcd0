// Whole steps of the fabric on the grid (fabric/grid/README.md, Linear system).
#include "sim/time_step.h"
#include "tests/sim/fabric/grid/grid_runs.h"
#include "tests/sim/fixtures.h"

#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include <numeric>

namespace sim::testing {
namespace {

constexpr double kStep = 2.0e-4;
constexpr TransferMethod kMethods[] = {TransferMethod::Pic, TransferMethod::Apic, TransferMethod::PolyPic};

void giveNoise(FabricState& state, double speed)
{
    Noise noise(7);
    for (Vec3& v : state.v) v += speed * noise.vector();
}

TEST(GridFabric, FallsFreely)
{
    for (TransferMethod method : kMethods) {
        Settings settings = gridSettings(method);
        settings.gravity = Vec3(0.0, -981.0, 0.0);
        GridRun run({weave(5), cloth(5, Vec3(0.0, 2.0, 0.0))}, settings);
        constexpr int kSteps = 50;
        for (int n = 0; n < kSteps; ++n) run.step(kStep);
        const double speed = -981.0 * kSteps * kStep, fallen = -981.0 * kStep * kStep * kSteps * (kSteps + 1) / 2;
        for (std::size_t v = 0; v < run.state.x.size(); ++v) {
            EXPECT_NEAR((run.state.v[v] - Vec3(0.0, speed, 0.0)).norm(), 0.0, 1e-7);
            EXPECT_NEAR((run.state.x[v] - run.fabric.rest[v] - Vec3(0.0, fallen, 0.0)).norm(), 0.0, 1e-9);
        }
    }
}

TEST(GridFabric, KeepsLinearMomentum)
{
    for (TransferMethod method : kMethods) {
        Settings settings = gridSettings(method);
        settings.fabric.tolerance = 1.0e-9;
        GridRun run({weave(6, 1.0e3), cloth(6, Vec3(0.0, 0.2, 0.0))}, settings);
        giveNoise(run.state, 30.0);
        const Vec3 before = run.momentum();
        double scale = 0.0;
        for (std::size_t v = 0; v < run.state.v.size(); ++v) scale += run.fabric.mass[v] * run.state.v[v].norm();
        for (int n = 0; n < 10; ++n) run.step(kStep);
        EXPECT_LT((run.momentum() - before).norm(), 1e-9 * scale);
    }
}

/// What the budget names is what the energy changes by (sim/README.md, Energy), up to the error of the solves.
TEST(GridFabric, EnergyGoesWhereTheBudgetSays)
{
    for (TransferMethod method : kMethods) {
        Settings settings = gridSettings(method);
        settings.fabric.tolerance = 1.0e-9;
        settings.gravity = Vec3(0.0, -981.0, 0.0);
        FabricPiece pinnedWeave = weave(6, 1.0e3);
        Motion lift;
        lift.addTranslation(0.0, 1.0, Vec3(0.0, 20.0, 0.0), 0.0, 0.0);
        PinGroup corner;
        corner.vertices = {0, 1};
        corner.twist = true;
        corner.motion = lift;
        pinnedWeave.pins = {corner};
        GridRun run({pinnedWeave, cloth(6, Vec3(0.0, 0.2, 0.0))}, settings);
        run.solver.bookEnergy();
        giveNoise(run.state, 30.0);
        const double start = run.energies().total(), kinetic = run.energies().kinetic;
        EnergyChanges all;
        for (int n = 0; n < 30; ++n) all += *run.step(kStep).energyChanges;
        const double unbooked = run.energies().total() - start - std::accumulate(all.of.begin(), all.of.end(), 0.0);
        EXPECT_LT(std::abs(unbooked), 1.0e-9 * kinetic);
        for (EnergyChange loss : {EnergyChange::Implicit, EnergyChange::FabricToVertices}) EXPECT_LT(all[loss], 0.0);
        EXPECT_LT(all[EnergyChange::Damping], -0.001 * kinetic);
        EXPECT_GT(all[EnergyChange::Pins], 0.0);
    }
}

/// Of the vertices and of their affine parts.
Vec3 angularMomentum(const GridRun& run)
{
    const std::size_t n = run.state.x.size(), rows = run.state.gridSolver.modes.size() / (3 * n);
    const auto slope = [&](int a, int b, std::size_t v) { return run.state.gridSolver.modes[(a * rows + 1 + b) * n + v]; };
    Vec3 sum = Vec3::Zero();
    for (std::size_t v = 0; v < n; ++v) {
        sum += run.fabric.mass[v] * run.state.x[v].cross(run.state.v[v]);
        for (int i = 0; i < 3; ++i) {
            const int j = (i + 1) % 3, k = (i + 2) % 3;
            sum[i] += run.fabric.mass[v] * 0.25 * kCell * (slope(k, j, v) - slope(j, k, v));
        }
    }
    return sum;
}

/// The linearised elastic forces have no torque about the rest shape; away from it they have one of the order of the
/// step.
TEST(GridFabric, KeepsAngularMomentumWithApic)
{
    Settings settings = gridSettings(TransferMethod::Apic);
    settings.fabric.tolerance = 1.0e-10;
    GridRun run({cloth(8)}, settings);
    giveNoise(run.state, 30.0);
    run.state.gridSolver.modes.assign(3 * 4 * run.state.x.size(), 0.0);
    for (std::size_t v = 0; v < run.state.x.size(); ++v)
        for (int a = 0; a < 3; ++a) run.state.gridSolver.modes[a * 4 * run.state.x.size() + v] = run.state.v[v][a];
    const Vec3 before = angularMomentum(run);
    run.step(kStep);
    EXPECT_LT((angularMomentum(run) - before).norm(), 1e-8 * before.norm());
}

TEST(GridFabric, TwistSpreadsWithPolyPic)
{
    GridRun run({pieceOf(strand(Vec3::Zero(), Vec3(2.88, 0.0, 0.0), 20), wool(), {0.048, 0.048})}, gridSettings(TransferMethod::PolyPic));
    run.state.theta[10] = 0.5;
    const double start = run.energies().twisting;
    ASSERT_GT(start, 0.0);
    for (int n = 0; n < 200; ++n) run.step(kStep);
    EXPECT_LT(run.energies().twisting, 0.05 * start);
    EXPECT_LT(run.state.theta[10], 0.2);
    EXPECT_GT(run.state.theta[10], 0.0) << "the mean angle stays";
}

TEST(GridFabric, PinsFollowTheirMotion)
{
    FabricPiece piece = cloth(6);
    PinGroup pins;
    pins.vertices = {0, 1, 2, 3, 4, 5};
    pins.motion.addTranslation(0.0, 0.05, Vec3(0.0, 0.5, 0.0), 0.01, 0.01);
    piece.pins.push_back(pins);
    Settings settings = gridSettings(TransferMethod::PolyPic);
    settings.gravity = Vec3(0.0, -981.0, 0.0);
    GridRun run({piece}, settings);
    for (int n = 0; n < 500; ++n) run.step(kStep);
    for (int v : pins.vertices) EXPECT_LT((run.state.x[v] - run.fabric.rest[v] - Vec3(0.0, 0.5, 0.0)).norm(), 0.2 * kCell);
}

TEST(GridFabric, DampingIsARate)
{
    const auto speedAfter = [](double h, int steps) {
        Settings settings = gridSettings(TransferMethod::PolyPic);
        settings.fabricTransfer.velocityDamping = 0.01;
        FabricPiece piece = cloth(5);
        piece.velocity = Vec3(3.0, 0.0, 0.0);
        GridRun run({piece}, settings);
        for (int n = 0; n < steps; ++n) run.step(h);
        return run.state.v[12][0];
    };
    EXPECT_NEAR(speedAfter(2.0e-4, 20), 3.0 * std::pow(0.99, 20), 1e-9);
    EXPECT_NEAR(speedAfter(1.0e-3, 4), speedAfter(2.0e-4, 20), 1e-9);
}

TEST(GridFabric, SameBitsForAnyThreadCount)
{
    const auto runOn = [](int threads) {
        return test::onThreads(threads, [&] {
            GridRun run({weave(12, 1.0e3), cloth(14, Vec3(0.1, 0.3, 0.1))}, gridSettings(TransferMethod::PolyPic));
            giveNoise(run.state, 50.0);
            for (int n = 0; n < 3; ++n) run.step(kStep);
            return run.state;
        });
    };
    const FabricState one = runOn(1);
    for (int threads : {2, 8}) {
        const FabricState other = runOn(threads);
        EXPECT_EQ(one.x, other.x);
        EXPECT_EQ(one.v, other.v);
        EXPECT_EQ(one.omega, other.omega);
        EXPECT_EQ(one.gridSolver.across, other.gridSolver.across);
        EXPECT_EQ(one.gridSolver.modes, other.gridSolver.modes);
    }
}

TEST(GridFabric, GoesOnFromItsStateAlone)
{
    const std::vector<FabricPiece> pieces = {weave(6, 1.0e3), cloth(8, Vec3(0.1, 0.3, 0.1))};
    GridRun run(pieces, gridSettings(TransferMethod::PolyPic));
    giveNoise(run.state, 50.0);
    for (int n = 0; n < 3; ++n) run.step(kStep);
    GridRun other(pieces, run.settings);
    other.state = run.state;
    other.time = run.time;
    for (int n = 0; n < 2; ++n) {
        run.step(kStep);
        other.step(kStep);
    }
    EXPECT_EQ(run.state.x, other.state.x);
    EXPECT_EQ(run.state.gridSolver.modes, other.state.gridSolver.modes);
    EXPECT_EQ(run.state.gridSolver.across, other.state.gridSolver.across);
}

/// What forces did in the last step is found again on the grid of this one, whose blocks may be others.
TEST(GridFabric, ForcesGoOnAsTheyWere)
{
    FabricPiece sheet = cloth(16, Vec3(0.1, 10.0 * kCell, 0.0));  // falls into the blocks below
    PinGroup corners;
    corners.vertices = {0, 15};
    sheet.pins.push_back(corners);
    Settings settings = gridSettings(TransferMethod::PolyPic);
    settings.gravity = Vec3(0.0, -981.0, 0.0);
    GridRun run({sheet}, settings);
    for (Vec3& v : run.state.v) v = Vec3(0.0, -40.0, 0.0);
    int blocksChanged = 0;
    for (int i = 0; i < 40; ++i) {
        const std::vector<Vec3i> before = run.state.gridSolver.faceBlocks.coords();
        GridRun forgetful({sheet}, settings);
        forgetful.state = run.state;
        forgetful.state.gridSolver.faceBlocks = BlockGrid();
        const int without = forgetful.step(kStep).iterations, with = run.step(kStep).iterations;
        if (i < 3) continue;  // the corners' jolt
        EXPECT_LT(with, without) << "step " << i;
        if (before != run.state.gridSolver.faceBlocks.coords()) ++blocksChanged;
    }
    EXPECT_GT(blocksChanged, 0);
}

/// time.maxCflFabric of a cell in a step.
TEST(GridFabric, FastestVertexBoundsTheStep)
{
    Settings settings = gridSettings(TransferMethod::PolyPic);
    settings.time.dt = 1.0e-3;
    State state;
    state.fabric.v = {Vec3(0.0, -300.0, 0.0), Vec3(10.0, 0.0, 0.0)};
    EXPECT_DOUBLE_EQ(chooseTimeStep(settings, state, 0.0), kCell / 3.0 / 300.0);
    settings.fabric.solver = FabricSolver::Vertex;
    EXPECT_EQ(chooseTimeStep(settings, state, 0.0), 1.0e-3);
}

}  // namespace
}  // namespace sim::testing
