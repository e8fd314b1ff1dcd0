// What fabric gains from nothing is measured by its own motion: neither how fast all of it flies nor what is held beside it lets it gain more.
#include "sim/fabric/owed_energy.h"
#include "sim/scene/load_scene.h"
#include "sim/simulation.h"
#include "tests/physics/fabric_runs.h"
#include "tests/sim/fabric/grid/grid_runs.h"

#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include <numeric>

namespace sim::test {
namespace {

using testing::Noise;

constexpr double kFelt = 2.0e-3;                        // twice what counts as none in a step
constexpr double kRounding = 1.0e-9;                    // erg, of those of 1e4 cm/s
constexpr double kStruckStep = 2.5e-3, kSpacing = 0.1;  // s, cm

FabricPiece weaveOf(const Vec2i& yarns, bool hasBorders, const Vec3& origin)
{
    WovenYarns weave{.yarns = yarns, .spacing = kSpacing, .amplitude = 0.03};
    weave.borders = hasBorders;
    weave.origin = origin;
    FabricPiece piece = testing::pieceOf(wovenYarns(weave), testing::wool(), {0.025, 0.025});
    piece.material.young = 2.0e8;
    piece.material.density = 0.4;
    return piece;
}

/// Loose yarns that fly and a weave whose corner is held.
std::vector<FabricPiece> looseBesideHeld()
{
    std::vector<FabricPiece> pieces = {weaveOf(Vec2i(4, 10), true, Vec3(-3.0, 0.0, 0.0)), weaveOf(Vec2i(6, 10), false, Vec3(3.0, 0.0, 0.0))};
    pieces[0].pins = {pinned({0, 1})};
    return pieces;
}

/// Energy of pieces after the first but for that of their flight as a whole, piece by piece, and of all of the first [erg].
double ownEnergy(const Fabric& fabric, const FabricState& state, const FabricEnergies& energies)
{
    FabricGroups groups(fabric);
    return energies.total() - energies.kinetic + ownKinetic(fabric, groups, fabric.mass, state);
}

/// Sets the loose yarns in wild motion that has no momentum, and then all of them on their way together.
void strike(const Fabric& fabric, double flight, Noise& noise, FabricState& state)
{
    const double edges = 3.0 + 2.0 * noise();
    for (Vec3& v : state.v) v = edges * kSpacing / kStruckStep * noise.vector();
    const FabricGroups groups(fabric);
    const std::vector<Vec3> drift = groups.drifts(fabric.mass, state.v);
    const Vec3 together = flight * noise.vector().normalized();
    for (std::size_t v = 0; v < state.v.size(); ++v) {
        const int piece = groups.pieceOf(static_cast<int>(v));
        if (fabric.pinned[v]) state.v[v].setZero();
        else if (groups.freeGroupOf(piece) >= 0) state.v[v] += together - drift[piece];
        else state.v[v] *= 0.1;
    }
}

/// No step of a run, by either solver, leaves more energy of its own than it began with; by the scheme of second order than the run began with.
template <class Run>
void expectNoGain(Run& run, int steps, bool isSecondOrder = false)
{
    double before = ownEnergy(run.fabric, run.state, run.energies());
    for (int step = 0; step < steps; ++step) {
        run.step(kStruckStep);
        const double now = ownEnergy(run.fabric, run.state, run.energies());
        EXPECT_LT(now, (1.0 + kFelt) * before + kRounding) << "step " << step;
        before = isSecondOrder ? std::max(before, now) : now;
    }
}

TEST(DriftingFabric, GainsNothingOfItsOwnInItsVertices)
{
    for (const double flight : {0.0, 1.0e2, 1.0e4}) {
        Noise noise(5);
        for (int n = 0; n < 12; ++n) {
            FabricSettings settings;
            settings.contact = false;
            settings.newton = n % 3 == 0 ? 8 : 2;
            settings.maxHalvings = n % 4 == 3 ? 0 : 4;
            settings.integrator = n % 2 == 0 ? FabricTimeIntegrator::SecondOrder : FabricTimeIntegrator::BackwardEuler;
            FabricRun run(looseBesideHeld(), settings);
            run.gravity = Vec3::Zero();
            strike(run.fabric, flight, noise, run.state);
            SCOPED_TRACE("flight " + std::to_string(flight) + ", state " + std::to_string(n));
            expectNoGain(run, 8, n % 2 == 0);
        }
    }
}

TEST(DriftingFabric, GainsNothingOfItsOwnOnTheGrid)
{
    for (const double flight : {0.0, 1.0e2, 1.0e4}) {
        Noise noise(6);
        for (int n = 0; n < 12; ++n) {
            testing::GridRun run(looseBesideHeld(), testing::gridSettings(n % 4 < 2 ? TransferMethod::Apic : TransferMethod::PolyPic));
            strike(run.fabric, flight, noise, run.state);
            SCOPED_TRACE("flight " + std::to_string(flight) + ", state " + std::to_string(n));
            expectNoGain(run, 3);
        }
    }
}

/// Centre of mass [cm], or of `values` in place of positions.
Vec3 meanOf(const Fabric& fabric, std::span<const Vec3> values)
{
    Vec3 sum = Vec3::Zero();
    double mass = 0.0;
    for (std::size_t v = 0; v < values.size(); ++v) sum += fabric.mass[v] * values[v], mass += fabric.mass[v];
    return sum / mass;
}

/// Loads of liquid that goes by, uneven as cells make them: of steps of h, in which it takes `rate` of the difference of the velocities [1/s].
LiquidLoads unevenLoads(const Fabric& fabric, const Vec3& velocity, double rate, double h, Noise& noise)
{
    LiquidLoads loads;
    for (const double mass : fabric.mass) {
        loads.drag.push_back(mass * rate * h * (Vec3::Ones() + 0.2 * noise.vector()));
        loads.impulse.push_back(loads.drag.back().cwiseProduct(velocity + 0.02 * velocity.norm() * noise.vector()));
    }
    return loads;
}

/// What liquid carries along gains next to nothing of its own, here and there, and loses it again: none of its way is taken back for that.
TEST(DriftingFabric, GoesAsFarInLiquidAsItsSpeedSays)
{
    Noise noise(14);
    for (int n = 0; n < 24; ++n) {
        FabricSettings settings;
        settings.integrator = n % 2 == 0 ? FabricTimeIntegrator::SecondOrder : FabricTimeIntegrator::BackwardEuler;
        const Vec3 along = noise.vector().normalized();
        FabricPiece yarn = testing::pieceOf(strand(Vec3::Zero(), Vec3(2.0 * along), 12), testing::wool(), {0.06, 0.06});
        FabricRun run(n % 4 < 2 ? yarn : testing::cloth(6, noise.vector()), settings);
        const Vec3 flow = 30.0 * noise.vector();
        const double h = std::pow(10.0, -3.3 + 0.5 * noise()), rate = std::pow(10.0, 1.5 + noise());
        const Vec3 start = meanOf(run.fabric, run.state.x);
        Vec3 way = Vec3::Zero();
        for (int step = 0; step < 100; ++step) {
            const LiquidLoads loads = unevenLoads(run.fabric, flow, rate, h, noise);
            const Vec3 before = meanOf(run.fabric, run.state.v);
            StageTimes stages;
            StageClock clock(stages);
            run.solver.advance(step * h, h, run.gravity, run.state, clock, {.onVertices = &loads});
            const Vec3 after = meanOf(run.fabric, run.state.v);
            way += h * (settings.integrator == FabricTimeIntegrator::SecondOrder ? Vec3(0.5 * (before + after)) : after);
        }
        EXPECT_LT((meanOf(run.fabric, run.state.x) - start - way).norm(), 5.0e-3 * way.norm()) << n;
    }
}

/// The same in water that it sinks in, in steps of two lengths: a yarn whose gains were taken for energy from nothing made half of its way.
TEST(DriftingFabric, SinksAsFarAsItsSpeedSays)
{
    constexpr const char* kTank = R"(
grid: {cell: 0.2}
time: {duration: 0.08}
fabric: {integrator: second_order}
coupling: {capillary: false, drip: false, capture: {rate: 0}}
porous: {fibre_diameter: 0.01, volume_fraction: 0.4}
materials: {wool: {young: 6.6e+7, poisson: 0.35, density: 1.64}}
liquid: {preset: water, sources: [{shape: {box: {min: [0, 0, 0], max: [2, 2, 2]}}}]}
obstacles: [{name: tank, inside: true, shape: {box: {min: [0, 0, 0], max: [2, 4, 2]}}}]
fabrics: [{name: yarn, strand: {material: wool, from: [1, 1.4, 0.2], to: [1, 1.4, 1.8], segments: 16, radius: 0.06}, velocity: [0, -5, 0]}]
)";
    for (const char* step : {"time.dt=1.0e-3", "time.dt=5.0e-4"}) {
        const Scene scene = readScene(sceneFileFromText(kTank, "scene.yaml", {"", {step}}));
        Simulation run(scene);
        const Fabric& fabric = run.fabric();
        const Vec3 start = meanOf(fabric, run.state().fabric.x);
        Vec3 way = Vec3::Zero();
        while (run.state().time < scene.settings.time.duration) {
            const Vec3 before = meanOf(fabric, run.state().fabric.v);
            const StepReport report = run.step(scene.settings.time.duration);
            way += 0.5 * report.dt * (before + meanOf(fabric, run.state().fabric.v));
        }
        EXPECT_LT((meanOf(fabric, run.state().fabric.x) - start - way).norm(), 5.0e-3 * way.norm()) << step;
    }
}

/// A rod across a direction, thinner than meshes are wide.
ObstacleSettings rodAcross(const Vec3& direction, const Vec3& at)
{
    ObstacleSettings rod;
    rod.name = "rod";
    Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
    pose.linear() = Eigen::Quaterniond::FromTwoVectors(Vec3::UnitY(), direction).toRotationMatrix();
    pose.translation() = at;
    rod.shape = Shape::box(Vec3::Zero(), Vec3(3.0, 0.02, 0.02)).moved(pose);
    return rod;
}

/// Momentum of the vertices from `first` to before `last` [g cm/s].
Vec3 momentumOf(const Fabric& fabric, const FabricState& state, std::size_t first, std::size_t last)
{
    Vec3 sum = Vec3::Zero();
    for (std::size_t v = first; v < last; ++v) sum += fabric.mass[v] * state.v[v];
    return sum;
}

/// What a solid stops tells nothing of a weave that flies beside it, whose yarns press on each other: that has its momentum to rounding.
TEST(DriftingFabric, KeepsItsMomentumBesideWhatSolidsStop)
{
    Noise noise(9);
    for (int n = 0; n < 12; ++n) {
        const FabricPiece sheet = testing::pieceOf(clothGrid({{6, 7}, {0.2, 0.2}, Vec3::Zero()}), testing::wool(), {0.02, 0.02});
        FabricPiece weave = testing::weave(5);
        for (Vec3& x : weave.points) x += Vec3(12.0, 0.0, 0.0);
        const Vec3 direction = (Vec3::UnitY() + 0.3 * noise.vector()).normalized();
        FabricSettings settings;
        settings.maxHalvings = 0;  // so that the limiter has its work
        settings.integrator = n % 2 == 0 ? FabricTimeIntegrator::BackwardEuler : FabricTimeIntegrator::SecondOrder;
        FabricRun run({sheet, weave}, settings, {rodAcross(direction, Vec3(0.5, 0.0, 0.6) + 0.3 * direction)});
        const std::size_t first = sheet.points.size(), last = run.state.v.size();
        const double speed = 2.0e3 + 1.5e3 * noise(), h = 1.0e-3 * (1.5 + noise());
        for (std::size_t v = 0; v < last; ++v) run.state.v[v] = v < first ? Vec3(speed * direction) : Vec3(100.0 * noise.vector());
        const Vec3 before = momentumOf(run.fabric, run.state, first, last), stopped = momentumOf(run.fabric, run.state, 0, first);
        const double mass = std::accumulate(run.fabric.mass.begin() + static_cast<long>(first), run.fabric.mass.end(), 0.0);
        for (int step = 0; step < 8; ++step) run.step(h);
        EXPECT_LT((momentumOf(run.fabric, run.state, first, last) - before - run.time * mass * run.gravity).norm(), 1.0e-10 * 100.0 * mass) << n;
        EXPECT_LT(momentumOf(run.fabric, run.state, 0, first).dot(direction), 0.5 * stopped.dot(direction)) << n << ": nothing stopped it";
    }
}

/// Weaves that meet in flight have the momentum of both when they have met, and less energy, on the grid as in their vertices.
TEST(DriftingFabric, WhatMeetsOnTheGridKeepsItsMomentumAndGainsNothing)
{
    Noise noise(10);
    for (int n = 0; n < 8; ++n) {
        std::vector<FabricPiece> pieces = {testing::weave(5), testing::cloth(6, Vec3(0.1, 0.4, 0.05))};
        testing::GridRun run(pieces, testing::gridSettings(n % 2 == 0 ? TransferMethod::Apic : TransferMethod::PolyPic));
        run.settings.gravity = 300.0 * noise.vector();
        const double speed = 60.0 + 40.0 * noise(), h = std::pow(10.0, -3.2 + 0.4 * noise());
        const Vec3 flight = 100.0 * noise.vector();
        for (std::size_t v = 0; v < run.state.v.size(); ++v) run.state.v[v] = flight + Vec3(0.0, run.state.x[v].y() > 0.3 ? -speed : speed, 0.0);
        const double mass = std::accumulate(run.fabric.mass.begin(), run.fabric.mass.end(), 0.0), met = 0.5 * mass * speed * speed;
        const Vec3 first = run.momentum();
        const double energy = run.energies().total();
        double most = 0.0;
        for (int step = 0; step * h < 0.02; ++step) {
            run.step(h);
            most = std::max(most, run.energies().total() - energy);
        }
        EXPECT_LT((run.momentum() - first - run.time * mass * run.settings.gravity).norm(), 1.0e-10 * mass * speed) << n;
        EXPECT_LT(most, 1.0e-3 * met) << n;
        EXPECT_LT(run.energies().total() - energy, -0.1 * met) << n << " they did not meet";
    }
}

}  // namespace
}  // namespace sim::test
