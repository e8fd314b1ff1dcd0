#include "sim/fabric/vertex/vertex_system.h"
#include "tests/sim/fabric/pieces.h"

#include <gtest/gtest.h>

namespace sim {
namespace {

using testing::Noise;

/// A small weave with borders, whose yarns share vertices and touch each other; a sheet; and a sheet with a yarn sewn onto it.
FabricPiece pieceNamed(const std::string& name)
{
    if (name == "weave") {
        WovenYarns weave{.yarns = {9, 8}, .spacing = 0.144, .amplitude = 0.072};
        return testing::pieceOf(wovenYarns(weave), testing::wool(), {0.048, 0.048});
    }
    FabricPiece piece = testing::pieceOf(clothGrid({.nodes = {12, 9}, .spacing = {0.144, 0.144}}), testing::wool(), {0.02, 0.02});
    if (name == "sewn sheet") {
        std::vector<int> strand;
        for (int i = 0; i < 12; ++i) strand.push_back(4 * 12 + i);
        piece.strands.push_back(strand);
    }
    return piece;
}

double gradientNorm(const VertexSystem& system)
{
    double sum = 0.0;
    for (double g : system.gradient()) sum += g * g;
    return std::sqrt(sum);
}

std::vector<Vec3> inertiaOf(const Fabric& fabric)
{
    std::vector<Vec3> inertia;
    for (double mass : fabric.mass) inertia.push_back(Vec3::Constant(mass));
    return inertia;
}

/// The matrix belongs to the gradient, and what is solved for is its inverse: one Newton move from nearby takes the forces away.
TEST(VertexSystem, NewtonMoveTakesTheForcesAway)
{
    for (const std::string name : {"weave", "sheet", "sewn sheet"}) {
        FabricPiece piece = pieceNamed(name);
        PinGroup pins;
        pins.vertices = {0, 1};
        piece.pins.push_back(pins);
        const Fabric fabric = testing::fabricOf(piece);
        FabricSettings settings;
        VertexSystem system(fabric, settings);
        FabricContact contact(fabric);
        FabricState state = restState(fabric);
        Noise noise(3);
        constexpr double kNear = 1.0e-5;  // cm: the forces are linear to a share of 1e-4 of the edges' strain of 1e-4
        for (std::size_t v = 0; v < state.x.size(); ++v)
            if (!fabric.pinned[v]) state.x[v] += kNear * noise.vector();
        system.rods().transportFrames(state);
        const std::vector<double> freeAngles(fabric.edges.size(), 0.0);
        const std::vector<Vec3> inertia = inertiaOf(fabric);
        constexpr double kStep = 1.0e-3;
        contact.beginStep(fabric.rest, fabric.mass, kStep, kStep);
        StageTimes report;
        StageClock clock(report);
        const NewtonPoint point{state, fabric.rest, freeAngles, inertia, kStep};

        system.assemble(point, {}, &contact.activeAt(state.x, clock));
        const double before = gradientNorm(system);
        const LinearReport linear = system.solve({1.0e-10, 0.0, 1.0e30}, 0.0, 500);
        EXPECT_LT(linear.iterations, 300) << name;
        for (std::size_t v = 0; v < state.x.size(); ++v) state.x[v] += system.move(static_cast<int>(v));
        for (std::size_t e = 0; e < state.theta.size(); ++e) state.theta[e] += system.turn(static_cast<int>(e));
        system.rods().transportFrames(state);
        system.assemble(point, {}, &contact.activeAt(state.x, clock));
        EXPECT_LT(gradientNorm(system), 1.0e-2 * before) << name;
        for (int v : fabric.pins.vertex) EXPECT_EQ(system.move(v), Vec3::Zero()) << name;
    }
}

/// The preconditioner is exact for strands that touch nothing: one iteration solves.
TEST(VertexSystem, FreeStrandsAreSolvedAtOnce)
{
    const Fabric fabric = testing::fabricOf(testing::pieceOf(strand(Vec3::Zero(), Vec3(5.0, 0.0, 0.0), 50), testing::wool(), {0.05, 0.03}));
    VertexSystem system(fabric, FabricSettings{});
    FabricState state = restState(fabric);
    Noise noise(8);
    for (Vec3& x : state.x) x += 0.01 * noise.vector();
    system.rods().transportFrames(state);
    const std::vector<double> freeAngles(fabric.edges.size(), 0.1);
    const std::vector<Vec3> inertia = inertiaOf(fabric);
    system.assemble({state, fabric.rest, freeAngles, inertia, 1.0e-3}, {}, nullptr);
    EXPECT_EQ(system.solve({1.0e-6, 0.0, 1.0e30}, 0.0, 500).iterations, 1);
}

}  // namespace
}  // namespace sim
