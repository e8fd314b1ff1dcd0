// Contact of fabric on the grid.
#include "sim/time_step.h"
#include "tests/sim/fabric/grid/grid_runs.h"
#include "tests/sim/fixtures.h"

#include <gtest/gtest.h>
#include <Eigen/Geometry>
#include <numeric>

namespace sim::testing {
namespace {

constexpr double kStep = 2.0e-4;

/// Two sheets that are driven against each other, their contact in steps ten times as long as the explicit one allows.
TEST(GridFabric, ContactIsStableInLongSteps)
{
    FabricPiece lower = cloth(12), upper = cloth(12, Vec3(0.05, 0.2, 0.03));
    lower.velocity = Vec3(0.0, 8.0, 0.0);
    upper.velocity = Vec3(0.0, -8.0, 0.0);
    for (FabricPiece* piece : {&lower, &upper}) {
        piece->material.young = 6.6e6;
        piece->material.contactStiffness = 1.0;
    }
    GridRun run({lower, upper}, gridSettings(TransferMethod::PolyPic));
    const ContactModuli m(lower.material);
    const double soundSpeed = std::sqrt(lower.material.packing() * m.normal() / lower.material.envelopeDensity());
    const double h = 10.0 * kCell / soundSpeed;
    ASSERT_LT(8.0 * h, kCell / 3.0);
    const double start = run.energies().kinetic;
    bool touched = false;
    for (int n = 0; n < 100; ++n) {
        const FabricReport report = run.step(h);
        touched = touched || report.contacts > 0;
        const FabricEnergies e = run.energies();
        ASSERT_LT(e.kinetic + e.elastic(), 1.05 * start) << "step " << n;
    }
    EXPECT_TRUE(touched);
}

TEST(GridFabric, ContactStopsSheetsThatMeet)
{
    FabricPiece lower = cloth(12), upper = cloth(12, Vec3(0.05, 0.3, 0.03));
    upper.velocity = Vec3(0.0, -20.0, 0.0);
    GridRun run({lower, upper}, gridSettings(TransferMethod::PolyPic));
    const std::size_t half = run.state.x.size() / 2;
    double least = 1.0;
    for (int n = 0; n < 200; ++n) {
        run.step(kStep);
        double gap = 0.0;
        for (std::size_t v = 0; v < half; ++v) gap += (run.state.x[half + v][1] - run.state.x[v][1]) / static_cast<double>(half);
        least = std::min(least, gap);
    }
    EXPECT_GT(least, 0.0);
    EXPECT_GT(run.momentum()[1] / run.momentum().norm(), -1.0 - 1e-12);
    double lowerSpeed = 0.0;
    for (std::size_t v = 0; v < half; ++v) lowerSpeed += run.state.v[v][1] / static_cast<double>(half);
    EXPECT_LT(lowerSpeed, -5.0) << "the upper sheet takes the lower one along";
}

/// Elastic shear of a barely pressed sheet would take the other one along as if they were glued.
TEST(GridFabric, SheetsSlideWithoutFriction)
{
    const auto speedAfterStep = [](bool contact) {
        FabricPiece lower = cloth(12), upper = cloth(12, Vec3(0.05, 0.2, 0.03));
        upper.velocity = Vec3(20.0, 0.0, 0.0);
        for (FabricPiece* piece : {&lower, &upper}) {
            piece->material.contactStiffness = 1.0;
            piece->material.frictionAngle = 0.0;
        }
        Settings settings = gridSettings(TransferMethod::PolyPic);
        settings.fabric.contact = contact;
        GridRun run({lower, upper}, settings);
        run.state.gridSolver.across = ElementContact(run.fabric).unstrained(run.state);
        press(run.state, 1.0e-3, 1, 0.0);
        EXPECT_EQ(run.step(kStep).contacts > 0, contact);
        const std::size_t half = run.state.x.size() / 2;
        double speed = 0.0;
        for (std::size_t v = 0; v < half; ++v) speed += run.state.v[half + v][0] / static_cast<double>(half);
        return speed;
    };
    EXPECT_NEAR(speedAfterStep(true), speedAfterStep(false), 1.0e-3);
}

TEST(GridFabric, ClothStaysOnABall)
{
    std::vector<FabricPiece> pieces = {cloth(12)};
    ObstacleSettings ball;
    ball.shape = Shape::ball(Vec3(0.8, -0.6, 0.8), 0.5);
    Settings settings = gridSettings(TransferMethod::PolyPic);
    settings.gravity = Vec3(0.0, -981.0, 0.0);
    const Fabric fabric = assembleFabric(pieces);
    FabricState state = initialState(fabric, pieces);
    GridFabricSolver solver(fabric, settings, std::span(&ball, 1));
    StageTimes report;
    StageClock clock(report);
    for (int n = 0; n < 250; ++n) {
        solver.step(n * kStep, kStep, settings.gravity, state, clock);
        ASSERT_LT(solver.deepestInObstacles(state), 0.02) << "step " << n;
    }
    const std::size_t middle = 5 * 12 + 5;
    EXPECT_GT(state.x[middle][1], -0.2);
    EXPECT_LT(state.x[0][1], -0.15) << "the corners hang down";
}

}  // namespace
}  // namespace sim::testing
