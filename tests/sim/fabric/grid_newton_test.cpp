// Steps in which fabric moves about as far as its edges are long.
#include "sim/step.h"
#include "tests/sim/fabric/grid_runs.h"

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

}  // namespace
}  // namespace sim::testing
