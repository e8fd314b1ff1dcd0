#include "runs.h"
#include "sim/core/random.h"
#include "sim/sources/seed.h"
#include "sim/state_hash.h"

#include <gtest/gtest.h>

#include <oneapi/tbb/global_control.h>
#include <oneapi/tbb/task_arena.h>

#include <array>
#include <numeric>

namespace sim::test {
namespace {

constexpr double kCell = 0.5;  // [cm]

/// Random numbers of one case.
class Draw {
 public:
    explicit Draw(std::uint64_t number) : random_(number, 29) {}
    double between(double low, double high) { return low + (high - low) * random_.uniform(next_++); }
    bool isTrue() { return random_.uniform(next_++) < 0.5; }
    int below(int n) { return static_cast<int>(random_.uniform(next_++) * n); }
    Vec3 inBox(double half) { return {between(-half, half), between(-half, half), between(-half, half)}; }

 private:
    CounterRandom random_;
    std::uint64_t next_ = 0;
};

/// A tank of 12 × 16 × 12 cells, filled up to `level` cells.
Scene pool(double level, double spacing = 0.5)
{
    Scene scene = tankScene(kPoly8, kCell, {12.0, 16.0, 12.0}, Vec3::Zero(), {12.0, std::max(level, 1.0), 12.0});
    if (level == 0.0) scene.sources.clear();
    for (SourceSettings& source : scene.sources) source.fill.spacing = spacing;
    scene.settings.time.mode = TimeMode::Fixed;
    scene.settings.time.dt = 2.5e-3;
    return scene;
}

/// A source that flows, and what it is to give [cm³].
struct Jet {
    SourceSettings source;
    double volume = 0.0, layer = 0.0;
};

/// @param half  of a box, turned by an angle about an axis [cm]
Jet jetOf(const Vec3& center, const Vec3& half, const Eigen::AngleAxisd& turn, const Vec3& velocity, double from, double to, const FillSettings& fill)
{
    Jet jet;
    jet.source.name = "jet";
    const Shape box = Shape::box(Vec3::Zero(), half);
    jet.source.shape = box.moved(Eigen::Isometry3d(Eigen::Translation3d(center) * turn));
    jet.source.fill = fill;
    Emission emission;
    emission.from = from;
    emission.to = to;
    emission.velocity = velocity;
    jet.source.emissions.push_back(emission);
    const Vec3 own = turn.inverse() * velocity;
    const double flow = packingOf(fill.pattern) * 4.0 *
                        (std::abs(own[0]) * half[1] * half[2] + std::abs(own[1]) * half[2] * half[0] + std::abs(own[2]) * half[0] * half[1]);
    jet.volume = flow * (to - from);
    jet.layer = flow / velocity.norm() * particleSpacing(fill, kCell);
    return jet;
}

void runUntil(double end, Simulation& simulation)
{
    while (simulation.state().time < end - 1.0e-9) simulation.step(end);
}

double massOf(const State& state) { return std::accumulate(state.liquid.mass.data(), state.liquid.mass.data() + state.liquid.count, 0.0); }

void expectLedgerAddsUp(const State& state)
{
    EXPECT_NEAR(state.ledger.emittedMass, massOf(state) + state.ledger.leftMass, 1.0e-11 * state.ledger.emittedMass);
}

/// Any place amid liquid, turned any way: what it gives beside what it may fill at once is what it is asked for.
TEST(Source, UnderLiquidGivesAreaTimesSpeedTimesTime)
{
    for (std::uint64_t number = 0; number < 12; ++number) {
        Draw draw(number);
        Scene scene = pool(9.0);
        scene.settings.time.dt = draw.between(1.0e-3, 5.0e-3);
        if (draw.isTrue()) scene.settings.time.integrator = TimeIntegrator::Reflected;
        if (draw.below(3) == 0) {
            scene.settings.time.mode = TimeMode::Adaptive;
            scene.settings.time.dt = 2.0e-2;
        }
        const Vec3 half(draw.between(0.3, 0.8), draw.between(0.02, 0.6), draw.between(0.3, 0.8));
        const Vec3 velocity = draw.between(3.0, 40.0) * Vec3(draw.inBox(1.0) + Vec3(0.0, 0.3, 0.0)).normalized();
        const Eigen::AngleAxisd turn(draw.isTrue() ? draw.between(0.0, 3.0) : 0.0, Vec3(draw.inBox(1.0) + Vec3(0.1, 0.0, 0.0)).normalized());
        const double from = draw.isTrue() ? draw.between(0.0, 0.05) : 0.0;
        FillSettings fill;
        fill.spacing = 0.5;
        const Jet jet = jetOf(Vec3(3.0, 2.2, 3.0) + draw.inBox(0.5), half, turn, velocity, from, from + 0.15, fill);
        scene.sources.push_back(jet.source);
        Simulation simulation(scene);
        runUntil(from + 0.16, simulation);
        const State& state = simulation.state();
        EXPECT_NEAR(state.emittedVolume[1], jet.volume, 0.01 * jet.volume + 1.1 * std::pow(0.25, 3)) << "case " << number;
        expectLedgerAddsUp(state);
    }
}

/// Liquid makes room at the rate that is asked for, in steps of any length: also in one that is short for a particle to come in.
TEST(Source, UnderLiquidPushesNoFasterInShortSteps)
{
    for (std::uint64_t number = 0; number < 12; ++number) {
        Draw draw(300 + number);
        Scene scene = pool(9.0);
        scene.settings.gravity = Vec3::Zero();
        scene.settings.liquid.viscosity = draw.isTrue() ? 100.0 : 0.01;
        scene.settings.liquid.solveViscosity = scene.settings.liquid.viscosity > 1.0;
        if (draw.isTrue()) scene.settings.time.integrator = TimeIntegrator::Reflected;
        const Vec3 half(draw.between(0.3, 0.8), draw.between(0.1, 0.6), draw.between(0.3, 0.8));
        const double speed = draw.between(3.0, 30.0);
        const Vec3 velocity = speed * Vec3(draw.inBox(1.0) + Vec3(0.0, 0.3, 0.0)).normalized();
        FillSettings fill;
        fill.spacing = 0.5;
        const Jet jet = jetOf(Vec3(3.0, 2.2, 3.0) + draw.inBox(0.5), half, Eigen::AngleAxisd::Identity(), velocity, 0.0, 1.0, fill);
        scene.sources.push_back(jet.source);
        Simulation simulation(scene);
        double given = 0.0, fastest = 0.0;
        for (int step = 0; step < 60; ++step) {
            const double dt = 2.5e-3 * std::pow(10.0, -draw.between(0.0, 2.0));
            const double before = simulation.state().emittedVolume[1];
            simulation.step(simulation.state().time + dt);
            given += simulation.state().emittedVolume[1] - before;
            fastest = std::max(fastest, simulation.state().memory.maxSpeed);
        }
        EXPECT_GT(given, 0.0) << "case " << number;
        EXPECT_LT(fastest, 2.0 * speed) << "case " << number;  // its own, and half as much again of the room's
    }
}

/// Mouths in the open air, with and without weight, on walls, and partly under water: to within a layer.
TEST(Source, InAirAtWallsAndAtTheSurfaceGivesAreaTimesSpeedTimesTime)
{
    const FillSettings::Pattern patterns[] = {FillSettings::Pattern::Lattice, FillSettings::Pattern::Jittered, FillSettings::Pattern::Poisson,
                                              FillSettings::Pattern::Reference};
    for (std::uint64_t number = 0; number < 12; ++number) {
        Draw draw(100 + number);
        Scene scene = pool(draw.isTrue() ? 4.0 : 0.0);
        if (draw.below(3) == 0) scene.settings.gravity = Vec3::Zero();
        FillSettings fill;
        fill.spacing = 0.5;
        fill.pattern = scene.sources.empty() ? patterns[draw.below(4)] : FillSettings::Pattern::Lattice;
        const Vec3 half(draw.between(0.4, 0.8), draw.between(0.03, 0.5), draw.between(0.4, 0.8));
        const std::array<Vec3, 4> places = {Vec3(3.0, half[1], 3.0), Vec3(3.0, 4.0, 3.0), Vec3(half[0], 2.0, 3.0), Vec3(3.0, 6.0, 3.0)};
        const int place = draw.below(4);
        const Vec3 inward = place == 0   ? Vec3(Vec3::UnitY())
                            : place == 2 ? Vec3(Vec3::UnitX())
                                         : Vec3(draw.inBox(1.0) - Vec3(0.0, 0.5, 0.0)).normalized();
        const Jet jet = jetOf(places[place], half, Eigen::AngleAxisd::Identity(), draw.between(10.0, 60.0) * inward, 0.0, 0.15, fill);
        scene.sources.push_back(jet.source);
        Simulation simulation(scene);
        const double atOnce = simulation.state().emittedVolume.back();
        runUntil(0.16, simulation);
        EXPECT_NEAR(simulation.state().emittedVolume.back() - atOnce, jet.volume, 0.02 * jet.volume + 1.1 * jet.layer)
            << "case " << number << " at place " << place;
        expectLedgerAddsUp(simulation.state());
    }
}

/// The projection takes from the kinetic energy, but for the work of pressing in, which is booked with the sources.
TEST(Source, WhatThePressureDoesForItIsBooked)
{
    for (std::uint64_t number = 0; number < 4; ++number) {
        Draw draw(200 + number);
        Scene scene = pool(8.0);
        FillSettings fill;
        fill.spacing = 0.5;
        const Jet jet = jetOf(Vec3(3.0, 2.0, 3.0) + draw.inBox(0.3), Vec3(0.6, 0.4, 0.6), Eigen::AngleAxisd::Identity(),
                              draw.between(10.0, 40.0) * draw.inBox(1.0).normalized(), 0.0, 1.0, fill);
        scene.sources.push_back(jet.source);
        Simulation simulation(scene);
        simulation.bookEnergy();
        double last = simulation.energies().total(), pressed = 0.0, unbooked = 0.0, kinetic = 0.0;
        while (simulation.state().time < 0.1) {
            const StepReport report = simulation.step(0.1);
            ASSERT_TRUE(report.energyChanges);
            EnergyChanges changes = *report.energyChanges;
            pressed += report.inflowWork;
            kinetic = std::max(kinetic, report.energies.kinetic);
            EXPECT_LE(changes[EnergyChange::Pressure], 1.0e-3 * std::abs(report.inflowWork) + 1.0e-6 * kinetic)
                << "case " << number << " at " << simulation.state().time;
            const double booked = std::accumulate(changes.of.begin(), changes.of.end(), 0.0), now = report.energies.total();
            unbooked = std::max(unbooked, std::abs(now - last - booked));
            last = now;
        }
        EXPECT_GT(pressed, 0.0);
        EXPECT_LT(unbooked, 1.0e-6 * kinetic);
    }
}

/// A closed box that is nearly full takes what it has room for; then the source stops, and the liquid comes to rest.
TEST(Source, StopsWhereThereIsNoRoomLeft)
{
    for (std::uint64_t number = 0; number < 3; ++number) {
        Draw draw(300 + number);
        Scene scene = tankScene(kPoly8, kCell, {8.0, 8.0, 8.0}, Vec3::Zero(), {8.0, 7.0, 8.0});
        scene.sources[0].fill.spacing = 0.5;
        scene.settings.time.mode = TimeMode::Fixed;
        scene.settings.time.dt = 2.5e-3;
        FillSettings fill;
        fill.spacing = 0.5;
        const Vec3 velocity = draw.between(20.0, 40.0) * draw.inBox(1.0).normalized();
        scene.sources.push_back(
            jetOf(Vec3(2.0, 1.5, 2.0) + draw.inBox(0.3), Vec3(0.6, 0.6, 0.6), Eigen::AngleAxisd::Identity(), velocity, 0.0, 10.0, fill).source);
        Simulation simulation(scene);
        double fastest = 0.0;
        while (simulation.state().time < 0.5) fastest = std::max(fastest, simulation.step(0.5).maxSpeed);
        EXPECT_TRUE(simulation.state().memory.sources[1].isShut);
        const double full = std::pow(8.0 * kCell, 3), mass = massOf(simulation.state());
        EXPECT_GT(mass, 0.95 * full) << "case " << number;
        EXPECT_LT(mass, 1.03 * full) << "case " << number;
        EXPECT_LT(fastest, 10.0 * velocity.norm()) << "case " << number;
        expectLedgerAddsUp(simulation.state());
        runUntil(0.6, simulation);
        EXPECT_NEAR(massOf(simulation.state()), mass, 2.0e-3 * mass);
    }
}

TEST(Source, GoesOnTheSameFromAnyStateAndOnAnyNumberOfThreads)
{
    Scene scene = pool(6.0);
    FillSettings fill;
    fill.spacing = 0.5;
    scene.sources.push_back(jetOf({3.0, 2.8, 3.0}, {0.6, 0.4, 0.6}, Eigen::AngleAxisd(0.4, Vec3::UnitZ()), {10.0, 20.0, 5.0}, 0.0, 1.0, fill).source);
    const auto run = [&] {
        Simulation simulation(scene);
        runUntil(0.02, simulation);
        return Simulation(scene, simulation.state());
    };
    std::vector<std::uint64_t> hashes;
    for (const int threads : {1, 2, 8}) {
        const oneapi::tbb::global_control limit(oneapi::tbb::global_control::max_allowed_parallelism, threads);
        oneapi::tbb::task_arena(threads).execute([&] {
            Simulation resumed = run(), whole(scene);
            runUntil(0.05, resumed);
            runUntil(0.02, whole);
            runUntil(0.05, whole);
            hashes.push_back(stateHash(resumed.state()));
            hashes.push_back(stateHash(whole.state()));
        });
    }
    for (const std::uint64_t hash : hashes) EXPECT_EQ(hash, hashes[0]);
}

}  // namespace
}  // namespace sim::test
