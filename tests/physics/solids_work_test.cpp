// Solids that move do work on the liquid, and only what they do makes its energy grow.
#include "tests/physics/energy_history.h"

#include "sim/energy_changes.h"

#include <gtest/gtest.h>

#include <random>

namespace sim::test {
namespace {

constexpr double kCell = 0.5;  // [cm]

/// How energy and work went.
struct Worked {
    double start = 0.0, end = 0.0;  ///< energy [erg]
    double work = 0.0;              ///< of solids on the liquid, as booked [erg]
    double rise = 0.0;  ///< the largest one of energy, with stretching, less work above the least before it and what stretching got since [erg]
    double most = 0.0;  ///< kinetic energy that ever was [erg]
};

Worked follow(const Scene& scene, double duration)
{
    Simulation simulation(scene);
    simulation.bookEnergy();
    Worked worked;
    worked.start = worked.end = simulation.energies().total();
    double least = worked.start + simulation.energies().strain, strainThen = simulation.energies().strain;
    while (simulation.state().time < duration) {
        const StepReport report = simulation.step(duration);
        worked.work += (*report.energyChanges).of[static_cast<int>(EnergyChange::Solids)];
        if (report.isReflected) continue;
        worked.end = report.energies.total();
        const double strain = report.energies.strain, own = worked.end + strain - worked.work;
        if (own < least) least = own, strainThen = strain;
        worked.rise = std::max(worked.rise, own - least - std::max(0.0, strain - strainThen));
        worked.most = std::max(worked.most, report.energies.kinetic + report.energies.modal);
    }
    return worked;
}

/// A shaft with a piston for a floor, on which liquid stands 8 cells high.
Scene shaft(const Transfer& transfer, const Motion& motion)
{
    Scene scene = tankScene(transfer, kCell, {5.0, 40.0, 4.0}, {0.0, 4.0, 0.0}, {5.0, 12.0, 4.0});
    scene.settings.time.dt = 2.0e-3;
    scene.obstacles.push_back(obstacle("piston", Shape::box(kCell * Vec3(2.5, -6.0, 2.0), kCell * Vec3(9.0, 10.0, 9.0)), motion));
    return scene;
}

TEST(SolidsWork, OfAPistonLiftsAColumn)
{
    for (const Transfer& transfer : {kPic, kApic, kPoly8, kPoly27}) {
        constexpr double kHeight = 3.3 * kCell;
        Motion motion;
        motion.addTranslation(0.0, 0.3, {0.0, kHeight, 0.0}, 0.1, 0.1);
        const Scene scene = shaft(transfer, motion);
        ASSERT_TRUE(scene.settings.time.reflects());
        const Worked worked = follow(scene, 0.35);
        const double mass = Simulation(scene).state().ledger.emittedMass, needed = mass * kEarthGravity * kHeight;
        std::printf("%s: work %.4f, energy %.4f of m g h\n", transfer.name.c_str(), worked.work / needed, (worked.end - worked.start) / needed);
        EXPECT_NEAR(worked.work, needed, 0.05 * needed);
        EXPECT_LT(worked.end - worked.start, 1.01 * worked.work);
    }
}

TEST(SolidsWork, OfAPistonThrowsAColumn)
{
    for (const Transfer& transfer : {kPic, kApic, kPoly8, kPoly27}) {
        constexpr double kSpeed = 40.0;  // [cm/s]
        Motion motion;
        motion.addTranslation(0.0, 0.2, {0.0, kSpeed * 0.15, 0.0}, 0.1, 0.0);
        Scene scene = shaft(transfer, motion);
        scene.settings.gravity = Vec3::Zero();
        const Worked worked = follow(scene, 0.15);
        const double mass = Simulation(scene).state().ledger.emittedMass, needed = 0.5 * mass * kSpeed * kSpeed;
        std::printf("%s: work %.4f, energy %.4f of m v²/2\n", transfer.name.c_str(), worked.work / needed, (worked.end - worked.start) / needed);
        EXPECT_NEAR(worked.work, needed, 0.05 * needed);
    }
}

/// Liquid in a tank with a solid that pushes it about, or stands in it.
struct Stirred {
    const char* name;
    Shape shape;
    Motion motion;
};

std::vector<Stirred> stirrers()
{
    std::vector<Stirred> all;
    Motion push, swing, turn;
    push.addTranslation(0.0, 0.3, {2.0, 0.0, 0.0}, 0.1, 0.1);
    all.push_back({"piston", Shape::box({-2.0, 3.0, 1.0}, {2.0, 6.0, 4.0}), push});
    swing.addOscillation(0.0, 1.0, Vec3::UnitX(), 0.8, 3.0);
    all.push_back({"paddle", Shape::box({2.4, 2.0, 0.75}, {0.15, 1.5, 0.5}), swing});
    turn.addRotation(0.0, 1.0, {Vec3::UnitZ(), Vec3(2.9, 1.5, 0.75)}, 12.0, 0.1, 0.1);
    all.push_back({"turning plate", Shape::box({2.9, 1.5, 0.75}, {1.1, 0.13, 0.5}), turn});
    all.push_back({"slanted plate at rest",
                   Shape::box(Vec3::Zero(), {1.1, 0.13, 0.5}).moved(Eigen::Translation3d(2.4, 1.2, 0.75) * Eigen::AngleAxisd(0.6, Vec3::UnitZ())),
                   {}});
    return all;
}

TEST(SolidsWork, IsAllThatMakesEnergyGrow)
{
    for (const Stirred& stirred : stirrers())
        for (const TimeIntegrator integrator : {TimeIntegrator::Plain, TimeIntegrator::Reflected})
            for (double friction : {0.0, 0.4, 1.0})
                for (const Transfer& transfer : {kPic, kApic, kPoly8, kPoly27}) {
                    Scene scene = tankScene(transfer, kCell, {10.0, 14.0, 3.0}, {0.0, 0.0, 0.0}, {7.0, 6.0, 3.0});
                    scene.settings.time.cfl = 0.5;
                    scene.settings.time.integrator = integrator;
                    scene.settings.liquid.wallFriction = friction;
                    scene.settings.liquid.volume.rate = 0.0;  // it lifts
                    scene.settings.liquid.relax.rate = 0.0;
                    scene.obstacles.push_back(obstacle(stirred.name, stirred.shape, stirred.motion));
                    const Worked worked = follow(scene, 0.15);
                    std::printf("%-22s %s friction %.1f %-11s work %8.1f rise %.2e of %8.1f erg\n", stirred.name,
                                integrator == TimeIntegrator::Plain ? "plain    " : "reflected", friction, transfer.name.c_str(), worked.work,
                                worked.rise / worked.most, worked.most);
                    // The weight of the surface layer acts where its liquid would be if it were even (levelWeight). Where that is lower than the
                    // liquid, potential energy is stored that counts as kinetic meanwhile: 1e-4 would hold without.
                    EXPECT_LT(worked.rise, 4.0e-3 * worked.most) << stirred.name << ' ' << transfer.name << ' ' << friction;
                }
}

/// A plate, thinner than a cell and turned anyhow, that moves through a few particles.
Scene plateThroughDrop(unsigned seed, const Transfer& transfer)
{
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> unit(-1.0, 1.0);
    const auto vec = [&] { return Vec3(unit(random), unit(random), unit(random)); };
    Scene scene;
    scene.settings.cell = kCell;
    scene.settings.gravity = seed % 3 == 0 ? Vec3(100.0, -981.0, 50.0) : Vec3(Vec3::Zero());
    scene.settings.transfer.method = transfer.method;
    scene.settings.transfer.modes = transfer.modes;
    scene.settings.transfer.xi = seed % 2 == 0 ? XiMap::Translation : XiMap::AffineConservative;
    scene.settings.time.mode = TimeMode::Fixed;
    scene.settings.time.dt = 2.0e-3;
    scene.settings.time.integrator = seed % 4 < 2 ? TimeIntegrator::Plain : TimeIntegrator::Reflected;
    scene.settings.liquid.wallFriction = std::array{0.0, 0.2, 0.5, 0.92, 1.0}[seed % 5];
    scene.settings.liquid.volume.rate = scene.settings.liquid.relax.rate = 0.0;
    scene.settings.liquid.solveViscosity = seed % 6 == 5;
    scene.settings.liquid.viscosity = 30.0;
    SourceSettings drop;
    drop.shape = Shape::box(Vec3::Zero(), kCell * Vec3(1.5, 1.0, 1.2));
    Emission emission;
    emission.velocity = 20.0 * vec();
    drop.emissions.push_back(emission);
    scene.sources.push_back(drop);
    Motion motion;
    motion.addTranslation(0.0, 0.2, 8.0 * vec(), 0.0, 0.0);
    if (seed % 7 < 3) motion.addRotation(0.0, 0.2, {vec().normalized(), Vec3::Zero()}, 6.0, 0.0, 0.0);
    const auto place = Eigen::Translation3d(0.0, -1.4 * kCell, 0.0) * Eigen::AngleAxisd(3.0 * unit(random), vec().normalized());
    scene.obstacles.push_back(obstacle("plate", Shape::box(Vec3::Zero(), kCell * Vec3(3.0, 0.2, 3.0)).moved(place), motion));
    return scene;
}

TEST(SolidsWork, IsAllThatMakesTheEnergyOfAFewParticlesGrow)
{
    // 1.2e-3 are reached with FLIP, whose particles keep velocities that its faces do not have.
    constexpr double kAllowed = 2.0e-3;
    for (const Transfer& transfer : {kPic, kFlip, kApic, kPoly27}) {
        double largest = 0.0;
        for (unsigned seed = 0; seed < 40; ++seed) {
            const Worked worked = follow(plateThroughDrop(seed, transfer), 0.04);
            EXPECT_LT(worked.rise, kAllowed * worked.most) << transfer.name << ' ' << seed;
            largest = std::max(largest, worked.rise / worked.most);
        }
        std::printf("%-11s largest rise %.2e of the kinetic energy\n", transfer.name.c_str(), largest);
    }
}

}  // namespace
}  // namespace sim::test
