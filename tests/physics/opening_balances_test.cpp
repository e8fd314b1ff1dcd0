#include "sim/fabric/pieces/generators.h"
#include "sim/scene/load_scene.h"
#include "sim/state_hash.h"
#include "tests/physics/fabric_runs.h"
#include "tests/physics/flume.h"
#include "tests/sim/fabric/pieces.h"

#include <gtest/gtest.h>
#include <oneapi/tbb/global_control.h>
#include <oneapi/tbb/task_arena.h>

#include <numeric>

namespace sim::test {
namespace {

/// All that changes momentum and energy is booked, whatever passes.
TEST(Openings, BalancesClose)
{
    for (Flume flume : flumes()) {
        if (flume.transfer.method == TransferMethod::Flip) continue;  // has no modal energy to book
        flume.roof = 12.0;
        flume.level = 5.0;
        flume.depth = 6.0;
        Simulation simulation(flume.scene());
        simulation.bookEnergy();
        double last = simulation.energies().total(), unbooked = 0.0, kinetic = 0.0;
        for (int n = 0; n < 30; ++n) {
            const ClosedStep closed(simulation);
            EXPECT_LT(closed.error, kExact * closed.exchanged) << flume.text() << ", step " << n;
            const EnergyChanges& changes = *closed.report.energyChanges;
            const double now = closed.report.energies.total();
            unbooked = std::max(unbooked, std::abs(now - last - std::accumulate(changes.of.begin(), changes.of.end(), 0.0)));
            kinetic = std::max(kinetic, closed.report.energies.kinetic);
            EXPECT_LE(changes[EnergyChange::Pressure], 1.0e-4 * kinetic) << flume.text() << ", step " << n;
            last = now;
        }
        EXPECT_LT(unbooked, 1.0e-6 * kinetic) << flume.text();
    }
}

/// A thick drop spreads into an outlet, against the liquid beyond it: it has no energy that is not from there or from its weight. What pushes the plane
/// acts before viscosity (Openings::keepMoved).
TEST(Openings, AThickDropGainsNothing)
{
    constexpr const char* kDrop = R"(
grid: {cell: 0.1489}
time: {dt: 2.205e-3, duration: 0.06, mode: adaptive, cfl: 0.417, integrator: plain}
obstacles: [{name: tank, inside: true, shape: {cylinder: {center: [0, 4.468, 0], radius: 1.413, half: 4.468}}}]
liquid:
  viscosity: 128
  solve_viscosity: true
  surface_order: 1
  wall_friction: 0.234
  surface_tension: 92.2
  surface_tension_force: true
  sources:
    - name: drop
      shape: {rounded_box: {center: [-0.1975, 0.3632, -0.1536], half: [0.04931, 0.07074, 0.08098], round: 0.04813}, rotate: {axis: [-0.6726, -0.6676, 0.3192], angle: 8.233}}
      velocity: [0.225, 0.2335, 0.02729]
      fill: {pattern: poisson, seed: 339}
  openings: [{name: outlet, face: x-, level: 0.6843}]
domain: {box: {min: [-0.7089, 0, -0.7089], max: [0.7089, 8.155, 0.7089]}}
)";
    for (const char* method : {"apic", "flip", "polypic"}) {
        SceneFile file = sceneFileFromText(kDrop, "drop.yaml", {.set = {std::string("transfer.method=") + method}});
        Simulation simulation(readScene(file));
        simulation.bookEnergy();
        const double start = simulation.energies().total();
        double paid = 0.0, surface = 0.0, pressure = 0.0, kinetic = 0.0, gained = 0.0;  // the energy of the surface is in no sum
        while (simulation.state().time < 0.06) {
            const StepReport report = simulation.step(0.06);
            const EnergyChanges& changes = *report.energyChanges;
            paid += changes[EnergyChange::Sources];
            surface += changes[EnergyChange::SurfaceTension];
            pressure += changes[EnergyChange::Pressure];
            kinetic = std::max(kinetic, report.energies.kinetic);
            gained = std::max(gained, report.energies.total() - start - paid - std::max(0.0, surface + std::max(0.0, pressure)));
        }
        EXPECT_GT(simulation.state().ledger.emittedMass, 0.0);
        EXPECT_LT(gained, 0.01 * kinetic) << method;
    }
}

/// Thick liquid is dragged in by its inlet: what viscosity gives to it the inlet has paid.
TEST(Openings, ThickLiquidGetsNothingFromViscosity)
{
    for (Flume flume : flumes())
        for (const double viscosity : {10.0, 300.0, 5000.0, 5.0e4}) {
            flume.integrator = TimeIntegrator::Plain;
            flume.roof = 12.0;
            Scene scene = flume.scene();
            scene.settings.liquid.viscosity = viscosity;
            scene.settings.liquid.solveViscosity = true;
            scene.sources[0].emissions[0].velocity.setZero();
            Simulation simulation(scene);
            simulation.bookEnergy();
            double given = 0.0, kinetic = 0.0, start = simulation.energies().total(), paid = 0.0, gained = 0.0;
            for (int n = 0; n < 30; ++n) {
                const StepReport report = simulation.step(1.0);
                const EnergyChanges& changes = *report.energyChanges;
                kinetic = std::max(kinetic, report.energies.kinetic);
                given += changes[EnergyChange::Viscosity];
                paid += changes[EnergyChange::Sources] + changes[EnergyChange::Solids];
                gained = std::max(gained, report.energies.total() - start - paid);
            }

            EXPECT_LT(given, 0.0) << flume.text() << ", " << viscosity << " poise";
            EXPECT_LT(gained, 1.0e-3 * kinetic) << flume.text() << ", " << viscosity << " poise";
        }
}

/// What flies out above the level of an outlet falls as everywhere.
TEST(Openings, LiquidThatFliesByAnOutletGainsNothing)
{
    for (Flume flume : flumes())
        for (const double up : {-30.0, 0.0, 80.0}) {
            flume.integrator = TimeIntegrator::Plain;  // of others every second state tells velocities of another time
            flume.hasInlet = false;
            flume.roof = 30.0;
            flume.level = 1.0;
            Scene scene = flume.scene();
            scene.obstacles.clear();
            scene.sources[0].shape = flume.box({flume.length - 7.0, 12.0, 0.0}, {flume.length - 3.0, 15.0, 3.0});
            scene.sources[0].emissions[0].velocity = 2.0 * flume.velocity() + Vec3(0.0, up, 0.0);
            EXPECT_LT(gainBeyondOpenings(scene, 40), 1.0e-3) << flume.text() << ", " << up << " cm/s up";
        }
}

/// What stands beyond an outlet gives no more than its head, however little liquid comes there: a few drops that fall past its plane, below its level,
/// get no faster than by their fall and √(2 g level).
TEST(Openings, SprayInTheirPlaneIsNotThrown)
{
    for (Flume flume : flumes())
        for (const double size : {0.3, 0.5, 0.8}) {
            flume.integrator = TimeIntegrator::Plain;
            flume.hasInlet = false;
            flume.roof = 30.0;
            flume.level = 6.0;
            Scene scene = flume.scene();
            scene.obstacles.clear();
            SourceSettings& spray = scene.sources[0];
            for (int n = 0; n < 3; ++n) {
                const double along = flume.length - 4.0 - n, height = 9.0 + 1.5 * n;
                spray.shape = n == 0 ? Shape::ball(flume.at(along, height, 1.0), size * flume.cell)
                                     : Shape::unite({spray.shape, Shape::ball(flume.at(along, height, 1.0), size * flume.cell)});
            }
            spray.emissions[0].velocity = flume.velocity();
            spray.fill.spacing = 0.3;
            const double head = flume.cell * (13.0 + 4.0 + flume.level), fall = scene.settings.gravity.norm() * head;
            Simulation simulation(scene);
            double fastest = 0.0;
            for (int n = 0; n < 50; ++n) {
                simulation.step(1.0);
                const LiquidParticles& liquid = simulation.state().liquid;
                for (std::size_t p = 0; p < liquid.count; ++p) fastest = std::max(fastest, liquid.velocity(p).norm());
            }
            // Drops that have a pressure of their own are pushed for as long as they are in the plane: up to 7 % more.
            EXPECT_LT(fastest, (size < 0.8 ? 1.0 : 1.1) * std::sqrt(flume.speed * flume.speed + 2.0 * fall))
                << flume.text() << ", " << size << " cells";
        }
}

/// Wet threads across the stream, in the planes of openings and beyond: these move liquid there, whatever fabric is in it.
TEST(Openings, FabricInThemGainsNothing)
{
    for (const FabricSolver solver : {FabricSolver::Vertex, FabricSolver::Grid})
        for (const DragLaw drag : {DragLaw::Off, CouplingSettings().drag})
            for (Flume flume : flumes()) {
                flume.cell = 0.2;
                flume.speed = 10.0;
                flume.roof = 12.0;
                flume.level = 2.0;
                Scene scene = flume.scene();
                scene.sources.clear();
                scene.settings.fabric.solver = solver;
                scene.settings.coupling.drag = drag;
                for (const double along : {1.0, 1.5, 2.0, 2.5, 3.0, 3.5})
                    for (const double across : {0.5, 1.5, 2.5}) {
                        const Vec3 low = flume.at(along, 0.5, across), high = flume.at(along, 6.0, across);
                        const double radius = 0.15 * flume.cell;
                        FabricPiece thread = testing::pieceOf(strand(low, high, 9), testing::wool(), {radius, radius});
                        thread.wetness = 0.8;
                        thread.pins.push_back(pinned({0, 9}));
                        scene.fabrics.push_back(thread);
                    }
                EXPECT_LT(gainBeyondOpenings(scene, 40), 1.0e-3)
                    << flume.text() << (solver == FabricSolver::Grid ? ", grid" : ", vertex") << (drag == DragLaw::Off ? ", no drag" : "");
            }
}

/// The floor bears the weight of what is between the planes, openings that of what is beyond, and what they push is not from solids: of what these
/// get all but a little is explained.
TEST(Openings, SolidsGetNothingOfOpenings)
{
    for (Flume flume : {flumes()[0], flumes()[3], flumes()[4]}) {
        flume.roof = 10.0;
        flume.depth = flume.level = 6.0;
        Simulation simulation(flume.scene());
        const double between = (flume.length - 4.0) / flume.length, weight = between * massOfLiquid(simulation) * kEarthGravity;
        Vec3 mean = Vec3::Zero();
        for (int n = 0; n < 40; ++n) {
            simulation.step(1.0e9);
            const Forces& forces = simulation.forces();
            EXPECT_LT(forces.balance.borne.norm(), 5.0e-3 * forces.dt * weight) << flume.text() << ", step " << n;
            if (n >= 20) mean += simulation.forces().obstacles[0].liquid.linear / (20.0 * simulation.forces().dt * weight);
        }
        EXPECT_NEAR(mean[1], -1.0, 0.03) << flume.text();
        EXPECT_NEAR(mean[flume.axis], 0.0, 0.01) << flume.text();
    }
}

TEST(Openings, GoOnTheSameFromAnyStateAndOnAnyNumberOfThreads)
{
    Flume flume;
    flume.roof = 12.0;
    flume.level = 5.0;
    flume.depth = 6.0;
    const Scene scene = flume.scene();
    std::vector<std::uint64_t> hashes;
    for (const int threads : {1, 2, 8}) {
        const oneapi::tbb::global_control limit(oneapi::tbb::global_control::max_allowed_parallelism, threads);
        oneapi::tbb::task_arena(threads).execute([&] {
            Simulation whole(scene);
            runFor(0.04, whole);
            Simulation resumed(scene, whole.state());
            runFor(0.04, whole);
            runFor(0.04, resumed);
            hashes.push_back(stateHash(whole.state()));
            hashes.push_back(stateHash(resumed.state()));
        });
    }
    for (const std::uint64_t hash : hashes) EXPECT_EQ(hash, hashes[0]);
}

/// A box without air that an inlet leads into is told, not crammed.
TEST(Openings, AnInletIntoAFullClosedBoxIsTold)
{
    Flume flume;
    flume.hasGravity = false;
    Scene scene = flume.scene();
    scene.obstacles[0] = obstacle("box", flume.box({-10.0, 0.0, 0.0}, {flume.length - 4.0, flume.roof, flume.width}).inverted());
    scene.sources[0].shape = flume.box({0.0, 0.0, 0.0}, {flume.length - 4.0, flume.depth, flume.width});
    scene.openings.pop_back();
    Simulation simulation(scene);
    EXPECT_THROW(runFor(0.1, simulation), RunError);
}

}  // namespace
}  // namespace sim::test
