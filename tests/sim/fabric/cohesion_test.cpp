// Liquid bridges between wet fabric and what it touches: the force they have, and that nothing else comes of it.
#include "sim/fabric/cohesion.h"
#include "sim/fabric/pieces/generators.h"
#include "sim/fabric/vertex/vertex_solver.h"
#include "tests/physics/fabric_runs.h"
#include "tests/sim/fabric/pieces.h"
#include "tests/sim/fixtures.h"

#include <gtest/gtest.h>

#include <numeric>

namespace sim::test {
namespace {

using testing::pieceOf;
using testing::wool;

constexpr double kThickness = 0.04;  // of cloth [cm]

FabricPiece sheet(const Vec3& corner, int nodes = 9, double spacing = 0.15)
{
    return pieceOf(clothGrid({{nodes, nodes}, {spacing, spacing}, corner}), wool(), {0.5 * kThickness, 0.5 * kThickness});
}

/// What the published formula gives, from its own words: γ π (π − 2ϑ) / cos ϑ with cos ϑ = φ cos ϑ0 + (1 − φ)(2s − 1).
double publishedForce(const LiquidSettings& liquid, double fraction, double saturation)
{
    const double angle = std::acos(fraction * std::cos(liquid.contactAngle) + (1.0 - fraction) * (2.0 * saturation - 1.0));
    return liquid.surfaceTension * kPi * (kPi - 2.0 * angle) / std::cos(angle);
}

TEST(BridgeForce, IsThePublishedOneTimesTheSaturation)
{
    const LiquidSettings water;
    for (const double s : {0.5, 0.7, 1.0}) EXPECT_NEAR(bridgeForce(water, 0.4, s), s * publishedForce(water, 0.4, s), 1.0e-9);
    EXPECT_EQ(bridgeForce(water, 0.4, 0.0), 0.0);
    EXPECT_NEAR(bridgeForce(water, 0.4, 0.01), 0.01 * 72.0 * kPi * (kPi - 2.7) / std::cos(1.35), 1.0e-9) << "of the largest angle";
    LiquidSettings wetting = water;
    wetting.contactAngle = 0.0;
    EXPECT_NEAR(bridgeForce(wetting, 0.4, 1.0), 72.0 * kPi * kPi, 1.0e-9);
}

TEST(Cohesion, OfClothGoesByItsAreaAndOfYarnsByTheirLength)
{
    const LiquidSettings water;
    const CohesionSettings settings{0.01, true, true};
    const auto total = [&](const FabricPiece& piece) {
        const Fabric fabric = testing::fabricOf(piece);
        Cohesion cohesion(fabric, water, settings);
        std::vector<double> absorbed = poreCapacity(fabric, water.density);
        cohesion.setAbsorbed(absorbed);
        double sum = 0.0;
        for (int v = 0; v < static_cast<int>(fabric.vertexCount()); ++v) sum += cohesion.onObstacle(v);
        return sum;
    };
    const double perLength = 0.01 * bridgeForce(water, 0.4, 1.0), area = 1.2 * 1.2;
    EXPECT_NEAR(total(sheet(Vec3::Zero())), perLength * area / kThickness, 1.0e-9);
    EXPECT_NEAR(total(sheet(Vec3::Zero(), 25, 0.05)), perLength * area / kThickness, 1.0e-9) << "whatever the mesh";
    EXPECT_NEAR(total(pieceOf(strand(Vec3::Zero(), Vec3(0.0, 3.0, 4.0), 7), wool(), {0.05, 0.03})), perLength * 5.0, 1.0e-9);
}

TEST(Cohesion, DryFabricHasNone)
{
    const Fabric fabric = testing::fabricOf(sheet(Vec3::Zero()));
    Cohesion cohesion(fabric, LiquidSettings(), {1.0, true, true});
    const std::vector<double> dry(fabric.vertexCount(), 0.0);
    cohesion.setAbsorbed(dry);
    EXPECT_FALSE(cohesion.isOnFabric());
    EXPECT_FALSE(cohesion.isOnObstacles());
}

/// Fabric that holds water, with bridges.
struct WetRun {
    WetRun(const std::vector<FabricPiece>& pieces, double saturation, double strength, const std::vector<ObstacleSettings>& obstacles,
           const FabricSettings& settings = {})
        : fabric(assembleFabric(pieces)),
          state(initialState(fabric, pieces)),
          solver(fabric, settings, obstacles, Cohesion(fabric, LiquidSettings(), {strength, true, true}))
    {
        state.absorbed = poreCapacity(fabric, 1.0);
        for (double& absorbed : state.absorbed) absorbed *= saturation;
    }
    FabricReport step(double h)
    {
        StageTimes stages;
        StageClock clock(stages);
        const FabricReport report = solver.step(time, h, gravity, state, clock);
        time += h;
        return report;
    }
    void steps(int n, double h)
    {
        for (int i = 0; i < n; ++i) step(h);
    }
    double mass() const
    {
        return std::accumulate(fabric.mass.begin(), fabric.mass.end(), std::accumulate(state.absorbed.begin(), state.absorbed.end(), 0.0));
    }
    double weight() const { return kEarthGravity * mass(); }
    Vec3 momentum() const
    {
        Vec3 sum = Vec3::Zero();
        for (std::size_t v = 0; v < state.v.size(); ++v) sum += (fabric.mass[v] + state.absorbed[v]) * state.v[v];
        return sum;
    }
    double middle() const
    {
        double sum = 0.0;
        for (std::size_t v = 0; v < state.x.size(); ++v) sum += (fabric.mass[v] + state.absorbed[v]) * state.x[v].y();
        return sum / mass();
    }

    Fabric fabric;
    FabricState state;
    VertexSolver solver;
    Vec3 gravity = Vec3(0.0, -kEarthGravity, 0.0);
    double time = 0.0;
};

ObstacleSettings solid(const Shape& shape)
{
    ObstacleSettings obstacle;
    obstacle.name = "wall";
    obstacle.shape = shape;
    return obstacle;
}
/// Everything above y = 0.
ObstacleSettings ceiling() { return solid(Shape::box(Vec3(0.0, 5.0, 0.0), Vec3(20.0, 5.0, 20.0))); }

/// Under a ceiling, as near as it touches.
FabricPiece sheetUnderCeiling() { return sheet(Vec3(-0.6, -1.2 * 0.5 * kThickness, -0.6)); }

/// All of the bridges' force on a sheet at full strength [dyn].
double fullForce(double saturation) { return bridgeForce(LiquidSettings(), 0.4, saturation) * 1.44 / kThickness; }

/// The wall holds until the weight is more than all bridges hold, by the model's own force.
TEST(WetSheet, HangsFromACeilingUntilItIsTooHeavy)
{
    for (const double saturation : {0.3, 1.0}) {
        const double weight = WetRun({sheetUnderCeiling()}, saturation, 1.0, {}).weight();
        WetRun holds({sheetUnderCeiling()}, saturation, 1.05 * weight / fullForce(saturation), {ceiling()});
        holds.steps(150, 2.0e-3);
        EXPECT_NEAR(holds.middle(), -0.03, 0.02) << saturation;
        EXPECT_LT(holds.momentum().norm(), 1.0e-3 * holds.mass() * kEarthGravity * holds.time);
        WetRun falls({sheetUnderCeiling()}, saturation, 0.95 * weight / fullForce(saturation), {ceiling()});
        falls.steps(150, 2.0e-3);
        EXPECT_LT(falls.middle(), -1.0) << saturation;
    }
}

TEST(WetSheet, AdhesionVanishesWhenDry)
{
    WetRun run({sheetUnderCeiling()}, 1.0, 5.0e-3, {ceiling()});
    ASSERT_GT(5.0e-3 * fullForce(1.0), 1.2 * run.weight());
    run.steps(50, 2.0e-3);
    EXPECT_GT(run.middle(), -0.05);
    std::ranges::fill(run.state.absorbed, 0.0);
    run.steps(100, 2.0e-3);
    EXPECT_LT(run.middle(), -10.0 * kThickness);
}

/// On a wall friction of what the bridges press holds the weight: μ F.
TEST(WetSheet, SlidesDownAWallWhenFrictionOfItsBridgesHoldsNoMore)
{
    constexpr double kFriction = 0.5;
    FabricPiece hanging = sheet(Vec3::Zero());
    for (Vec3& x : hanging.points) x = Vec3(1.2 * 0.5 * kThickness, x.x(), x.z());
    hanging.material.frictionAngle = std::atan(kFriction);
    const ObstacleSettings wall = solid(Shape::box(Vec3(-5.0, 0.0, 0.0), Vec3(5.0, 20.0, 20.0)));
    const double weight = WetRun({hanging}, 1.0, 1.0, {}).weight(), needed = weight / (kFriction * fullForce(1.0));
    const auto speedAt = [&](double strength) {
        WetRun run({hanging}, 1.0, strength, {wall});
        const double start = run.middle();
        run.steps(100, 2.0e-3);
        return (run.middle() - start) / run.time;
    };
    EXPECT_NEAR(speedAt(1.25 * needed), 0.0, 0.2);
    EXPECT_LT(speedAt(0.6 * needed), -0.3 * 0.5 * kEarthGravity * 0.2);
}

/// What parts two sheets pulls with the force of the bridges: the lower hangs on the upper, which is pinned.
TEST(WetSheets, HangOnEachOtherUntilOneIsTooHeavy)
{
    const auto fallOf = [](double factor) {
        FabricPiece upper = sheet(Vec3(-0.6, 0.0, -0.6)), lower = sheet(Vec3(-0.6, -1.05 * kThickness, -0.6));
        PinGroup all;
        all.vertices.resize(upper.points.size());
        std::iota(all.vertices.begin(), all.vertices.end(), 0);
        upper.pins = {all};
        const double weight = WetRun({lower}, 1.0, 1.0, {}).weight();
        WetRun run({upper, lower}, 1.0, factor * weight / fullForce(1.0), {});
        run.steps(150, 2.0e-3);
        double lowest = 0.0;
        for (const Vec3& x : run.state.x) lowest = std::min(lowest, x.y());
        return lowest;
    };
    EXPECT_GT(fallOf(1.1), -2.0 * kThickness);
    EXPECT_LT(fallOf(0.9), -1.0);
}

/// Two free sheets and two yarns that cross, on their way to each other.
std::vector<FabricPiece> freePieces()
{
    FabricPiece one = sheet(Vec3(-0.6, 0.0, -0.6)), other = sheet(Vec3(-0.55, -1.3 * kThickness, -0.55));
    other.velocity = {1.0, 4.0, 2.0};
    FabricPiece yarn = pieceOf(strand(Vec3(-0.6, 1.5 * kThickness, 0.0), Vec3(0.6, 1.5 * kThickness, 0.3), 12), wool(), {0.03, 0.03});
    FabricPiece across =
        pieceOf(strand(Vec3(0.0, 1.5 * kThickness + 0.065, -0.6), Vec3(0.1, 1.5 * kThickness + 0.065, 0.6), 12), wool(), {0.03, 0.03});
    yarn.velocity = {0.0, -3.0, 1.0};
    return {one, other, yarn, across};
}

/// They pull on each other, weakly or hard, and their momentum stays; what bridges give their motion comes from them.
TEST(WetSheets, KeepTheirMomentum)
{
    for (const double strength : {2.0e-3, 0.1, 1.0}) {
        WetRun run(freePieces(), 0.8, strength, {});
        run.gravity.setZero();
        const Vec3 start = run.momentum();
        const double energy = run.solver.energies(run.state, run.gravity).total();
        double joined = 0.0, most = energy;
        for (int n = 0; n < 60; ++n) {
            run.step(1.0e-3);
            ASSERT_LT((run.momentum() - start).norm(), 1.0e-10 * start.norm()) << strength;
            joined = std::min(joined, run.state.stored.bridges);
            most = std::max(most, run.solver.energies(run.state, run.gravity).total());
        }
        EXPECT_LT(joined, 0.0) << "bridges came about";
        EXPECT_LT(most, energy + 0.01 * (energy - joined)) << strength;
    }
}

TEST(WetSheets, AreTheSameOnAnyNumberOfThreads)
{
    const auto endOn = [](int threads) {
        return onThreads(threads, [] {
            WetRun run(freePieces(), 0.8, 0.05, {solid(Shape::box(Vec3(0.0, -5.08, 0.0), Vec3(20.0, 5.0, 20.0)))});  // below the sheets
            run.steps(40, 1.0e-3);
            EXPECT_LT(run.state.stored.bridges, 0.0);
            return std::pair(run.state.x, run.state.v);
        });
    };
    const auto one = endOn(1);
    for (const int threads : {2, 8}) EXPECT_EQ(one, endOn(threads)) << threads;
}

/// The budget of energy holds bridges: what they give on the way together is what they take apart.
void expectBudgetClosesOverBridges(FabricTimeIntegrator integrator)
{
    FabricSettings settings;
    settings.integrator = integrator;
    WetRun run({sheetUnderCeiling()}, 1.0, 4.0e-3, {ceiling()}, settings);
    run.solver.bookEnergy();
    double energy = run.solver.energies(run.state, run.gravity).total(), scale = 0.0;
    for (int n = 0; n < 60; ++n) {
        if (n == 30) run.gravity *= 3.0, energy = run.solver.energies(run.state, run.gravity).total();  // and it is pulled off
        const FabricReport report = run.step(1.0e-3);
        double booked = 0.0;
        for (double change : report.energyChanges->of) booked += change;
        const double now = run.solver.energies(run.state, run.gravity).total();
        scale = std::max(scale, std::abs(run.state.stored.bridges));
        EXPECT_NEAR(now - energy, booked, 0.02 * scale + 1.0e-6) << n;
        energy = now;
    }
    EXPECT_EQ(run.state.stored.bridges, 0.0) << "all are broken";
    EXPECT_GT(scale, 0.1);
}

TEST(WetSheet, BudgetOfEnergyClosesOverBridges)
{
    for (const FabricTimeIntegrator integrator : {FabricTimeIntegrator::BackwardEuler, FabricTimeIntegrator::SecondOrder})
        expectBudgetClosesOverBridges(integrator);
}

/// Cloth of a mesh that is finer than it is thick is near itself everywhere, and not drawn together.
TEST(Cohesion, LeavesWhatIsNearItselfAtRestAlone)
{
    const FabricPiece fine = pieceOf(clothGrid({{9, 9}, {0.05, 0.05}, Vec3::Zero()}), wool(), {0.04, 0.04});
    WetRun wet({fine}, 1.0, 1.0, {});
    wet.gravity.setZero();
    const std::vector<Vec3> start = wet.state.x;
    wet.steps(5, 1.0e-3);
    double moved = 0.0;
    for (std::size_t v = 0; v < start.size(); ++v) moved = std::max(moved, (wet.state.x[v] - start[v]).norm());
    EXPECT_LT(moved, 1.0e-6);
    EXPECT_EQ(wet.state.stored.bridges, 0.0);
}

}  // namespace
}  // namespace sim::test
