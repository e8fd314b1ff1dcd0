// Steps in which fabric moves about as far as its edges are long.
#include "tests/sim/fabric/grid/grid_runs.h"

#include <gtest/gtest.h>
#include <Eigen/Geometry>

namespace sim::testing {
namespace {

/// Backward Euler makes no energy: fabric that is struck across, so that a step moves it up to twenty edges and by then other forces act than
/// where it began, has no more than it was given.
TEST(GridFabric, StruckFabricGainsNothing)
{
    constexpr double kEdge = 0.144, kStruckStep = 2.0e-3;  // cm, s
    Noise noise(3);
    for (int n = 0; n < 48; ++n) {
        FabricPiece piece = n % 2 == 0 ? cloth(7) : weave(4);
        PinGroup ends;
        ends.vertices = {0, static_cast<int>(piece.points.size()) - 1};
        if (n % 3 > 0) piece.pins = {ends};
        const double edges = 20.0 * std::abs(noise());
        Settings settings = gridSettings(n % 4 < 2 ? TransferMethod::Apic : TransferMethod::PolyPic);
        settings.fabric.membrane = n % 5 < 2 ? MembraneModel::StVk : MembraneModel::NeoHookean;
        const Eigen::Quaterniond turn(Eigen::Vector4d(noise(), noise(), noise(), noise()).normalized());
        for (Vec3& x : piece.points) x = turn * x;
        GridRun run({piece}, settings);
        const Vec3 at = run.state.x[n % run.state.x.size()], along = turn * Vec3(0.3 * noise(), 1.0, 0.3 * noise());
        for (std::size_t v = 0; v < run.state.v.size(); ++v) {
            const double far = (run.state.x[v] - at).norm() / (2.0 * kEdge);
            run.state.v[v] = edges * kEdge / kStruckStep * std::exp(-far * far) * along;
        }
        const double start = run.energies().total();
        for (int step = 0; step < 3; ++step) {
            run.step(kStruckStep);
            EXPECT_LT(run.energies().total(), (1.0 + 1.0e-3) * start) << "state " << n << ", step " << step << ", struck by " << edges << " edges";
        }
    }
}

/// Nor where threads are so stiff that what an error of the linear solve gives is felt, or that no iteration comes to a solution.
TEST(GridFabric, ThreadsTooStiffToSolveForGainNothing)
{
    constexpr double kStep = 3.0e-3;  // s
    Noise noise(11);
    for (int n = 0; n < 12; ++n) {
        FabricPiece piece = weave(3);
        piece.material.young = 1.0e17 * std::pow(10.0, noise());
        piece.material.density = 0.1;
        GridRun run({piece}, gridSettings(n % 4 < 2 ? TransferMethod::Apic : TransferMethod::PolyPic));
        for (Vec3& v : run.state.v) v = 20.0 * noise.vector();
        const double start = run.energies().total();
        run.step(kStep);
        EXPECT_LT(run.energies().total(), (1.0 + 1.0e-3) * start) << "state " << n;
    }
}

/// Nor when liquid that is heavier than the fabric draws it together, by suction that differs from face to face: what it has then is the work of the
/// liquid.
TEST(GridFabric, FabricThatLiquidDrawsGainsNothingElse)
{
    constexpr double kEdge = 0.144, kStep = 2.0e-3;  // cm, s
    Noise noise(5);
    for (int n = 0; n < 48; ++n) {
        FabricPiece piece = n % 2 == 0 ? cloth(7) : weave(4);
        PinGroup ends;
        ends.vertices = {0, static_cast<int>(piece.points.size()) - 1};
        if (n % 5 > 0) piece.pins = {ends};
        piece.material.young = 6.0e8;
        piece.material.density = 0.2;
        GridRun run({piece}, gridSettings(n % 4 < 2 ? TransferMethod::Apic : TransferMethod::PolyPic));
        run.solver.bookEnergy();
        StageTimes report;
        StageClock clock(report);
        const double start = run.energies().total(), heavier = std::pow(10.0, 1.0 + noise()), edges = 5.0 * std::abs(noise());
        run.solver.prepare(run.state, clock);
        const BlockGrid grid = run.solver.faces()->grid;
        BlockArray<double, 3> drag, impulse;
        for (BlockArray<double, 3>* of : {&drag, &impulse}) of->resize(grid.count());
        for (int b = 0; b < grid.count(); ++b)
            for (int a = 0; a < kAxes; ++a)
                for (int c = 0; c < kBlockCells; ++c) {
                    drag.block(b, a)[c] = n % 3 == 0 ? 0.0 : heavier * run.fabric.mass[1];
                    impulse.block(b, a)[c] = heavier * run.fabric.mass[1] * (edges * noise()) * kEdge / kStep;
                }
        const FaceLoads loads{grid, drag, impulse};
        const FabricReport done = run.solver.advance(0.0, kStep, Vec3::Zero(), run.state, clock, {.onFaces = &loads});
        const double work = (*done.energyChanges)[EnergyChange::Drag], pins = (*done.energyChanges)[EnergyChange::Pins];
        const double gained = run.energies().total() - start - work - pins;
        EXPECT_LT(gained, 1.0e-3 * work) << "state " << n << ", drawn by " << edges << " edges";
    }
}

}  // namespace
}  // namespace sim::testing
