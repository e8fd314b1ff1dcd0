#include "sim/coupling/capture.h"
#include "sim/fabric/generators.h"
#include "tests/sim/fabric/pieces.h"
#include "tests/sim/fixtures.h"

#include <gtest/gtest.h>

#include <numeric>

namespace sim::test {
namespace {

constexpr double kCell = 0.288;         // cm
constexpr double kParticle = 1.5e-3;    // g

/// Cloth and a yarn amid random particles; dry.
struct Bath {
    Bath() : liquid(randomLiquid(20000, 8))
    {
        const Vec3 middle = liquid.grid.origin + kCell * Vec3(1.5, 3.5, 7.0);
        const std::vector<FabricPiece> pieces = {
            testing::pieceOf(clothGrid({{9, 9}, {0.144, 0.144}, middle}), testing::wool(), {0.017, 0.017}),
            testing::pieceOf(strand(middle - Vec3(0.5, 0.3, 0.2), middle + Vec3(0.6, 0.1, 0.4), 8), testing::wool(), {0.05, 0.03})};
        fabric = assembleFabric(pieces);
        state = restState(fabric);
        for (std::size_t v = 0; v < state.v.size(); ++v) state.v[v] = Vec3(3.0, -1.0, std::sin(static_cast<double>(v)));
        for (std::size_t p = 0; p < liquid.particles.count; ++p) liquid.particles.mass[p] *= kParticle;
        settings.cell = kCell;
        vertices.sort(liquid.grid, state);
    }
    double capture(double dt)
    {
        Capture capture(fabric, settings, kParticle);
        const double mass = capture.capture(dt, liquid.grid, liquid.order, vertices, liquid.particles, state);
        toPins = capture.toPins();
        return mass;
    }
    double liquidMass() const { return std::accumulate(liquid.particles.mass.data(), liquid.particles.mass.data() + liquid.particles.count, 0.0); }
    double absorbed() const { return std::accumulate(state.absorbed.begin(), state.absorbed.end(), 0.0); }
    Vec3 momentum() const
    {
        Vec3 sum = Vec3::Zero();
        for (std::size_t s = 0; s < liquid.particles.count; ++s) sum += liquid.particles.mass[s] * liquid.particles.velocity(liquid.order.source[s]);
        for (std::size_t v = 0; v < state.v.size(); ++v) sum += (fabric.mass[v] + state.absorbed[v]) * state.v[v];
        return sum;
    }

    SortedLiquid liquid;
    SortedVertices vertices;
    Fabric fabric;
    FabricState state;
    Settings settings;
    Vec3 toPins = Vec3::Zero();  ///< of the last capture [g cm/s]
};

/// Model-fluid E1, of short steps and of those that empty cells.
TEST(Capture, KeepsMassAndMomentum)
{
    for (const double dt : {1.0e-3, 0.02, 10.0}) {
        Bath bath;
        const double mass = bath.liquidMass();
        const Vec3 momentum = bath.momentum();
        const double captured = bath.capture(dt);
        EXPECT_GT(captured, 1.0e-5 * mass) << dt;
        EXPECT_NEAR(bath.absorbed(), captured, 1.0e-13 * mass);
        EXPECT_NEAR(bath.liquidMass() + bath.absorbed(), mass, 1.0e-13 * mass);
        EXPECT_LT((bath.momentum() - momentum).norm(), 1.0e-12 * momentum.norm());
        for (std::size_t p = 0; p < bath.liquid.particles.count; ++p) ASSERT_GE(bath.liquid.particles.mass[p], 0.0);
        // A particle that is all but taken is taken whole.
        for (std::size_t v = 0; v < bath.state.v.size(); ++v) ASSERT_LE(bath.state.absorbed[v], poreVolume(bath.fabric, v) + 1.0e-3 * kParticle);
    }
}

/// Fabric that could hold more than there is takes all that it reaches, and particles without mass are removed.
TEST(Capture, TakesWholeParticles)
{
    Bath bath;
    for (double& volume : bath.fabric.volume) volume *= 1.0e6;
    const double mass = bath.liquidMass();
    const Vec3 momentum = bath.momentum();
    Capture capture(bath.fabric, bath.settings, kParticle);
    double captured = 0.0;
    for (int n = 0; n < 30; ++n)
        captured += capture.capture(10.0, bath.liquid.grid, bath.liquid.order, bath.vertices, bath.liquid.particles, bath.state);
    const std::size_t before = bath.liquid.particles.count;
    EXPECT_NEAR(bath.liquidMass() + captured, mass, 1.0e-13 * mass);
    EXPECT_LT((bath.momentum() - momentum).norm(), 1.0e-12 * momentum.norm());
    bath.liquid.moveModesHome();
    capture.dropEmptied(bath.liquid.particles);
    EXPECT_LT(bath.liquid.particles.count, before);
    for (std::size_t p = 0; p < bath.liquid.particles.count; ++p) EXPECT_GT(bath.liquid.particles.mass[p], 0.0);
    EXPECT_NEAR(bath.liquidMass() + captured, mass, 1.0e-13 * mass);
}

TEST(Capture, FarLiquidStays)
{
    Bath bath;
    const std::vector<double> before(bath.liquid.particles.mass.data(), bath.liquid.particles.mass.data() + bath.liquid.particles.count);
    bath.capture(10.0);
    int far = 0;
    for (std::size_t p = 0; p < before.size(); ++p) {
        double nearest = 1.0e9;  // in cells, along the axis in which it is farthest
        for (const Vec3& x : bath.state.x)
            nearest = std::min(nearest, (x - bath.liquid.particles.position(p)).cwiseAbs().maxCoeff() / kCell);
        if (nearest < 3.0) continue;  // two stencils
        EXPECT_EQ(bath.liquid.particles.mass[p], before[p]);
        ++far;
    }
    EXPECT_GT(far, 1000);
}

TEST(Capture, PinnedVerticesKeepTheirVelocityAndBookTheRest)
{
    Bath bath;
    bath.fabric.pinned.assign(bath.fabric.vertexCount(), 1);
    const std::vector<Vec3> before = bath.state.v;
    const Vec3 momentum = bath.momentum();
    EXPECT_GT(bath.capture(1.0e-2), 0.0);
    EXPECT_EQ(bath.state.v, before);
    EXPECT_GT(bath.toPins.norm(), 1.0e-6 * momentum.norm());
    EXPECT_LT((bath.momentum() + bath.toPins - momentum).norm(), 1.0e-12 * momentum.norm());
}

TEST(Capture, FullOrCompactFabricTakesNothing)
{
    Bath bath;
    for (std::size_t v = 0; v < bath.state.v.size(); ++v) bath.state.absorbed[v] = poreVolume(bath.fabric, v);
    EXPECT_EQ(bath.capture(1.0), 0.0);
    bath.state.absorbed.assign(bath.fabric.vertexCount(), 0.0);
    for (FabricMaterial& m : bath.fabric.materials) m.volumeFraction = 1.0;
    EXPECT_EQ(bath.capture(1.0), 0.0);
}

/// Model-fluid E2: a dry vertex in still liquid takes up 3 κ times the liquid around it per time, until it is full.
TEST(Capture, OneVertexFillsAtTheRateOfTheModel)
{
    constexpr int kPerCell = 4;
    SortedLiquid liquid;
    liquid.grid.dx = kCell;
    const double mass = std::pow(kCell / kPerCell, 3);
    std::uint32_t id = 0;
    for (int i = 0; i < 8 * kPerCell; ++i)
        for (int j = 0; j < 8 * kPerCell; ++j)
            for (int k = 0; k < 8 * kPerCell; ++k)
                liquid.particles.add(kCell / kPerCell * Vec3(i + 0.3, j + 0.6, k + 0.1), mass, id++, Vec3::Zero());
    liquid.sort();
    const Vec3 at = kCell * Vec3(3.9, 4.2, 3.4);
    const Fabric fabric = testing::fabricOf(testing::pieceOf(strand(at, at + Vec3(2.0, 0.0, 0.0), 1), testing::wool(), {0.03, 0.03}));
    Settings settings;
    settings.cell = kCell;
    FabricState state = restState(fabric);
    SortedVertices vertices;
    vertices.sort(liquid.grid, state);
    Capture capture(fabric, settings, mass);
    const double dt = 1.0e-4, rate = 3.0 * 13.655;  // K2
    const double gained = capture.capture(dt, liquid.grid, liquid.order, vertices, liquid.particles, state);
    EXPECT_NEAR(gained, rate * dt * std::pow(kCell, 3), 1.0e-4 * gained);
    EXPECT_EQ(state.absorbed[1], 0.0);
    const double capacity = poreVolume(fabric, 0);
    const int steps = static_cast<int>(1.1 * capacity / gained);
    for (int n = 0; n < steps; ++n) capture.capture(dt, liquid.grid, liquid.order, vertices, liquid.particles, state);
    EXPECT_NEAR(state.absorbed[0], capacity, 1.0e-12 * capacity);
}

TEST(Capture, SameBitsForAnyThreadCount)
{
    const auto run = [](int threads) {
        return onThreads(threads, [] {
            Bath bath;
            bath.capture(0.02);
            std::vector<double> all = bath.state.absorbed;
            all.insert(all.end(), bath.liquid.particles.mass.data(), bath.liquid.particles.mass.data() + bath.liquid.particles.count);
            for (const Vec3& v : bath.state.v) all.insert(all.end(), v.data(), v.data() + 3);
            return all;
        });
    };
    const std::vector<double> one = run(1);
    for (int threads : {2, 8}) EXPECT_EQ(run(threads), one) << threads;
}

}  // namespace
}  // namespace sim::test
