#include "sim/fabric/grid/grid_solver.h"
#include "sim/fabric/vertex/vertex_solver.h"
#include "tests/sim/fabric/contact/encounter.h"

#include <gtest/gtest.h>

#include <functional>

namespace sim::testing {
namespace {

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
        StageTimes report;
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
        EXPECT_EQ(crossingsOf(scene, fabric, state, h, 15, true,
                              [&](double t) {
                                  StageTimes report;
                                  StageClock clock(report);
                                  solver.step(t, h, kGravity, state, clock);
                              }),
                  0)
            << "seed " << seed;
    }
}

}  // namespace
}  // namespace sim::testing
