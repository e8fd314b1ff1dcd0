#include "sim/fabric/vertex/vertex_system.h"
#include "tests/sim/fabric/pieces.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <span>

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
        const ElasticStep step = system.startStep(state);
        const NewtonPoint point{step, state, fabric.rest, freeAngles, inertia, kStep};

        system.assemble(point, {}, &contact.activeAt(state.x, clock).pairs());
        const double before = gradientNorm(system);
        const LinearReport linear = system.solve({1.0e-10, 0.0, 1.0e30}, true, 500);
        EXPECT_LT(linear.iterations, 300) << name;
        for (std::size_t v = 0; v < state.x.size(); ++v) state.x[v] += system.move(static_cast<int>(v));
        for (std::size_t e = 0; e < state.theta.size(); ++e) state.theta[e] += system.turn(static_cast<int>(e));
        system.rods().transportFrames(state);
        system.assemble(point, {}, &contact.activeAt(state.x, clock).pairs());
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
    const ElasticStep step = system.startStep(state);
    system.assemble({step, state, fabric.rest, freeAngles, inertia, 1.0e-3}, {}, nullptr);
    EXPECT_EQ(system.solve({1.0e-6, 0.0, 1.0e30}, true, 500).iterations, 1);
}

/// What a Newton iteration from noisy places does to the vertices of some pieces.
std::vector<Vec3> movesOf(std::span<const FabricPiece> pieces, std::span<const Vec3> noise, double share)
{
    const Fabric fabric = assembleFabric(pieces);
    VertexSystem system(fabric, FabricSettings{});
    FabricState state = restState(fabric);
    for (std::size_t v = 0; v < state.x.size(); ++v)
        if (!fabric.pinned[v]) state.x[v] += noise[v];
    system.rods().transportFrames(state);
    const std::vector<double> freeAngles(fabric.edges.size(), 0.0);
    const std::vector<Vec3> inertia = inertiaOf(fabric);
    const ElasticStep step = system.startStep(state);
    system.assemble({step, state, fabric.rest, freeAngles, inertia, 1.0e-3}, {}, nullptr);
    system.solve({share, 0.0, 1.0e30}, true, 500);
    std::vector<Vec3> moves;
    for (std::size_t v = 0; v < state.x.size(); ++v) moves.push_back(system.move(static_cast<int>(v)));
    return moves;
}

/// What nothing ties is solved for by itself: no piece's move has an error that is small only beside what another piece does.
TEST(VertexSystem, PiecesThatDoNotTouchAreSolvedAsIfAlone)
{
    constexpr double kShare = 1.0e-4, kError = 0.05;  // of rms speeds; of the largest move, which soft bending lets err more
    PinGroup held;
    held.vertices = {0, 1};
    for (unsigned seed = 1; seed <= 8; ++seed) {
        std::vector<FabricPiece> pieces;
        for (const std::string name : {"weave", "sheet", "sewn sheet"}) pieces.push_back(pieceNamed(name));
        pieces[0].pins.push_back(held);
        for (int n = 0; n < 11; ++n)
            pieces.push_back(testing::pieceOf(strand(Vec3(0.0, 2.0, 0.3 * n), Vec3(1.5, 2.0, 0.3 * n), 6 + n % 3), testing::wool(), {0.05, 0.03}));
        Noise random(seed);
        std::vector<Vec3> noise;  // cm: some pieces are much wilder than others
        for (std::size_t n = 0; n < pieces.size(); ++n) {
            pieces[n].name += std::to_string(n);
            for (std::size_t v = 0; v < pieces[n].points.size(); ++v) noise.push_back((n % 3 == seed % 3 ? 1.0e-2 : 1.0e-7) * random.vector());
        }
        const std::vector<Vec3> together = movesOf(pieces, noise, kShare);
        std::size_t first = 0;
        for (std::size_t n = 0; n < pieces.size(); ++n) {
            const std::vector<Vec3> alone = movesOf({&pieces[n], 1}, std::span(noise).subspan(first), kShare);
            double largest = 0.0, error = 0.0;
            for (std::size_t v = 0; v < alone.size(); ++v) {
                largest = std::max(largest, alone[v].norm());
                error = std::max(error, (together[first + v] - alone[v]).norm());
            }
            EXPECT_LT(error, kError * largest) << "seed " << seed << ", piece " << n;
            first += alone.size();
        }
    }
}

/// Strands are factored one by one, without what they share: where together they are indefinite the solve says so, and what may be negative of the
/// twist's part is left out then.
TEST(VertexSystem, IndefiniteWeavesAreMadeDefinite)
{
    constexpr double kStep = 2.5e-3;
    WovenYarns shape{.yarns = {5, 6}, .spacing = 0.1, .amplitude = 0.03};
    const Fabric fabric = testing::fabricOf(testing::pieceOf(wovenYarns(shape), testing::wool(), {0.025, 0.025}));
    VertexSystem system(fabric, FabricSettings{});
    int indefinite = 0;
    for (unsigned seed = 1; seed <= 60; ++seed) {
        Noise noise(seed);
        FabricState state = restState(fabric);
        for (Vec3& x : state.x) x += 0.04 * noise.vector();
        for (double& angle : state.theta) angle = 6.0 * noise();
        system.rods().transportFrames(state);
        const std::vector<double> freeAngles(fabric.edges.size(), 0.0);
        const std::vector<Vec3> inertia = inertiaOf(fabric);
        const ElasticStep step = system.startStep(state);
        const NewtonPoint point{step, state, fabric.rest, freeAngles, inertia, kStep};
        const LinearTolerance tolerance{1.0e-6, 0.0, 1.0e30};
        system.assemble(point, {}, nullptr);
        if (!system.solve(tolerance, true, 2000).isIndefinite) continue;
        ++indefinite;
        system.assembleDefinite(point, {}, nullptr);
        const LinearReport solved = system.solve(tolerance, true, 2000);
        EXPECT_FALSE(solved.isIndefinite) << "seed " << seed;
        EXPECT_LT(solved.iterations, 2000) << "seed " << seed;
    }
    EXPECT_GT(indefinite, 5);
}

}  // namespace
}  // namespace sim
