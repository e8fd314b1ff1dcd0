#include "sim/coupling/capture.h"
#include "sim/fabric/pieces/generators.h"
#include "tests/sim/fabric/pieces.h"
#include "tests/sim/fixtures.h"

#include <gtest/gtest.h>

#include <numeric>
#include <optional>

namespace sim::test {
namespace {

constexpr double kCell = 0.288;       // cm
constexpr double kParticle = 1.5e-3;  // g

/// Cloth and a yarn amid random particles; dry.
struct Bath {
    Bath() : liquid(randomLiquid(20000, 8))
    {
        const Vec3 middle = liquid.grid.origin + kCell * Vec3(1.5, 3.5, 7.0);
        const std::vector<FabricPiece> pieces = {
            testing::pieceOf(clothGrid({{9, 9}, {0.144, 0.144}, middle}), testing::wool(), {0.017, 0.017}),
            testing::pieceOf(strand(middle - Vec3(0.5, 0.3, 0.2), middle + Vec3(0.6, 0.1, 0.4), 8), testing::wool(), {0.05, 0.03})};
        fabric = assembleFabric(pieces);
        around.emplace(fabric.vertexCount());
        state = restState(fabric);
        for (std::size_t v = 0; v < state.v.size(); ++v) state.v[v] = Vec3(3.0, -1.0, std::sin(static_cast<double>(v)));
        for (std::size_t p = 0; p < liquid.particles.count; ++p) liquid.particles.mass[p] *= kParticle;
        settings.cell = kCell;
    }
    double capture(double dt)
    {
        Capture capture(fabric, settings, kParticle);
        const Capture::Uptake uptake = capture.capture(dt, findAround(), liquid.particles, state);
        pinImpulse = std::accumulate(uptake.pinImpulse.begin(), uptake.pinImpulse.end(), Vec3::Zero().eval());
        return uptake.mass;
    }
    LiquidAround::Found findAround()
    {
        ObstacleField none;
        const std::vector<int> unknown(liquid.grid.count(), BlockGrid::kNone);
        none.update(liquid.grid, unknown, Obstacles(), false);
        return around->find({liquid.particles, liquid.order, liquid.grid}, none, sorter.sort(liquid.grid, state)).value();
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
    VertexSorter sorter;
    Fabric fabric;
    std::optional<LiquidAround> around;
    FabricState state;
    Settings settings;
    Vec3 pinImpulse = Vec3::Zero();  ///< of the last capture [g cm/s]
};

/// Uptake keeps mass and momentum to rounding, in short steps and in those that empty cells (coupling/README.md, Uptake).
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
    Capture::Uptake last;
    double captured = 0.0;
    for (int n = 0; n < 30; ++n) {
        last = capture.capture(10.0, bath.findAround(), bath.liquid.particles, bath.state);
        captured += last.mass;
    }
    const std::size_t before = bath.liquid.particles.count;
    EXPECT_NEAR(bath.liquidMass() + captured, mass, 1.0e-13 * mass);
    EXPECT_LT((bath.momentum() - momentum).norm(), 1.0e-12 * momentum.norm());
    bath.liquid.moveModesHome();
    Capture::removeEmptyParticles(last, bath.liquid.particles);
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
        for (const Vec3& x : bath.state.x) nearest = std::min(nearest, (x - bath.liquid.particles.position(p)).cwiseAbs().maxCoeff() / kCell);
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
    EXPECT_GT(bath.pinImpulse.norm(), 1.0e-6 * momentum.norm());
    EXPECT_LT((bath.momentum() + bath.pinImpulse - momentum).norm(), 1.0e-12 * momentum.norm());
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

/// Still liquid in a box of eight cells, and a vertex in it.
struct Pool {
    explicit Pool(double cell, const Vec3& place) : mass(std::pow(cell / kPerCell, 3))
    {
        settings.cell = liquid.grid.dx = cell;
        std::uint32_t id = 0;
        for (int i = 0; i < 8 * kPerCell; ++i)
            for (int j = 0; j < 8 * kPerCell; ++j)
                for (int k = 0; k < 8 * kPerCell; ++k)
                    liquid.particles.add(cell / kPerCell * Vec3(i + 0.3, j + 0.6, k + 0.1), mass, id++, Vec3::Zero());
        liquid.sort();
        const Vec3 at = cell * place;
        fabric = testing::fabricOf(testing::pieceOf(strand(at, at + Vec3(20.0 * cell, 0.0, 0.0), 1), testing::wool(), {0.03, 0.03}));
        around.emplace(fabric.vertexCount());
        state = restState(fabric);
        const std::vector<int> unknown(liquid.grid.count(), BlockGrid::kNone);
        none.update(liquid.grid, unknown, Obstacles(), false);
    }
    /// @return what is taken up in the next steps [g]
    double capture(Capture& capture, double dt, int steps)
    {
        double sum = 0.0;
        for (int n = 0; n < steps; ++n) sum += capture.capture(dt, findAround(), liquid.particles, state).mass;
        return sum;
    }

    LiquidAround::Found findAround()
    {
        return around->find({liquid.particles, liquid.order, liquid.grid}, none, sorter.sort(liquid.grid, state)).value();
    }

    static constexpr int kPerCell = 4;
    double mass;  ///< of a particle [g]
    Settings settings;
    SortedLiquid liquid;
    ObstacleField none;
    Fabric fabric;
    std::optional<LiquidAround> around;
    VertexSorter sorter;
    FabricState state;
};

/// By law `published` a dry vertex in still liquid takes up the share 3 κ dt of the liquid around it until it is full (coupling/README.md, Uptake).
TEST(Capture, PublishedLawTakesAShareOfTheLiquid)
{
    Pool pool(kCell, {3.9, 4.2, 3.4});
    pool.settings.coupling.capture.law = CaptureLaw::Published;
    Capture capture(pool.fabric, pool.settings, pool.mass);
    const double dt = 1.0e-4, rate = 3.0 * 13.655;  // 3 κ, PorousLaw.SuctionAndCaptureOfTheUsualFabric [1/s]
    const double gained = pool.capture(capture, dt, 1);
    EXPECT_NEAR(gained, rate * dt * std::pow(kCell, 3), 1.0e-4 * gained);
    EXPECT_EQ(pool.state.absorbed[1], 0.0);
    const double capacity = poreVolume(pool.fabric, 0);
    pool.capture(capture, dt, static_cast<int>(1.1 * capacity / gained));
    EXPECT_NEAR(pool.state.absorbed[0], capacity, 1.0e-12 * capacity);
}

/// By the fabric's law it fills `rate` of its pores per time, whatever the cell and its place in it.
TEST(Capture, FabricInLiquidFillsAtItsRate)
{
    for (const double cell : {0.5, 0.288, 0.1})
        for (const Vec3& place : {Vec3(3.9, 4.2, 3.4), Vec3(4.5, 3.0, 4.0), Vec3(3.1, 3.6, 4.9)}) {
            Pool pool(cell, place);
            const double dt = 1.0e-3, part = pool.settings.coupling.capture.rate * dt, room = poreVolume(pool.fabric, 0);
            const double capacity = std::min(room, 0.3 * std::pow(cell, 3));  // all that the test's small pool can give
            for (double& volume : pool.fabric.volume) volume *= capacity / room;
            Capture ofShare(pool.fabric, pool.settings, pool.mass);
            EXPECT_NEAR(pool.capture(ofShare, dt, 1), part * capacity, 1.0e-12 * capacity);
            EXPECT_NEAR(pool.capture(ofShare, dt, 1), part * capacity, 1.0e-12 * capacity);
            pool.capture(ofShare, dt, static_cast<int>(1.0 / part));
            EXPECT_NEAR(pool.state.absorbed[0], capacity, 1.0e-12 * capacity);
        }
}

TEST(Capture, WhatDoesNotWetStaysOutside)
{
    for (const CaptureLaw law : {CaptureLaw::Fabric, CaptureLaw::Published}) {
        Pool pool(kCell, {3.9, 4.2, 3.4});
        pool.settings.coupling.capture.law = law;
        pool.settings.liquid.contactAngle = 0.55 * kPi;
        Capture capture(pool.fabric, pool.settings, pool.mass);
        EXPECT_EQ(pool.capture(capture, 0.01, 3), 0.0);
    }
}

/// Distances by which fabric is in touch with liquid or not: on a flat surface, beside it, amid liquid, and where walls bound it.
TEST(LiquidAround, TellsHowFarLiquidIs)
{
    const auto distanceAt = [](const Vec3& place, bool isWalled) {
        Pool pool(kCell, place);
        if (isWalled) {
            Obstacles walls;
            const Shape floor = Shape::box(Vec3(0.0, -9.0, 0.0), Vec3::Constant(9.0)), side = Shape::box(Vec3(-9.0, 0.0, 0.0), Vec3::Constant(9.0));
            walls.add(Shape::unite({floor, side}), {});
            walls.moveTo(0.0, 0.0);
            const std::vector<int> unknown(pool.liquid.grid.count(), BlockGrid::kNone);
            pool.none.update(pool.liquid.grid, unknown, walls, false);
        }
        return pool.findAround().distanceAt(0);
    };
    for (double shift : {0.0, 0.2, 0.4, 0.6, 0.8}) {
        const auto at = [&](double height) { return distanceAt(Vec3(4.0 + shift, height, 4.4), false); };
        EXPECT_NEAR(at(4.0 + shift), 0.0, 0.02);
        EXPECT_NEAR(at(8.0), 0.56, 0.04);
        EXPECT_NEAR(at(8.25), 0.73, 0.06);  // particles stand up to 0.025 off the middles of their room
        EXPECT_NEAR(at(-0.225), 0.73, 0.06);
        EXPECT_LT(distanceAt(Vec3(4.0, 0.0 + 0.5 * shift, 4.0), true), 0.15);         // on the bottom …
        EXPECT_LT(distanceAt(Vec3(0.5 * shift, 0.0 + 0.5 * shift, 4.0), true), 0.2);  // … and in its corner
    }
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
