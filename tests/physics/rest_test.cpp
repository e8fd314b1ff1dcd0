#include "tests/physics/runs.h"

#include <gtest/gtest.h>

namespace sim::test {
namespace {

/// A pool of so many cells' depth in a tank 8 cells wide.
Scene pool(const Transfer& transfer, double cell, double depth, double spacing, TimeIntegrator integrator)
{
    Scene scene = tankScene(transfer, cell, {8.0, 16.0, 8.0}, Vec3::Zero(), {8.0, depth, 8.0});
    scene.settings.time.mode = TimeMode::Fixed;
    scene.settings.time.dt = 4.0e-3;
    scene.settings.time.integrator = integrator;
    scene.sources[0].fill.spacing = spacing;
    return scene;
}

/// A pool at rest stays at rest and keeps its level and its energy, wherever the level is between the faces of the grid, whatever the transfer, the
/// cell and the pitch of the particles.
TEST(Rest, OfAPoolLasts)
{
    struct Case {
        Transfer transfer;
        double cell, depth, spacing;
        TimeIntegrator integrator;
    };
    constexpr auto kReflected = TimeIntegrator::Reflected, kPlain = TimeIntegrator::Plain;
    for (const Case& c : {Case{kPoly8, 0.5, 6.0, 0.4, kReflected},
                          {kPoly8, 0.5, 6.2, 0.4, kReflected},
                          {kPoly8, 0.5, 6.8, 0.4, kPlain},
                          {kPoly27, 0.4, 7.37, 0.4, kReflected},
                          {kApic, 0.25, 6.51, 0.5, kReflected},
                          {kPic, 0.5, 5.13, 0.4, kPlain},
                          {kFlip, 1.0, 6.0, 0.4, kPlain},
                          {kPoly11, 0.5, 2.6, 0.4, kReflected},
                          {kPoly8, 0.5, 7.2, 0.3, kReflected}}) {
        const Scene scene = pool(c.transfer, c.cell, c.depth, c.spacing, c.integrator);
        Simulation simulation(scene);
        const Energies start = simulation.energies();
        const double mass = std::pow(8.0, 2) * c.depth * std::pow(c.cell, 3), level = c.depth * c.cell;
        double fastest = 0.0;
        Energies now;
        while (simulation.state().time < 4.0) {
            now = simulation.step(4.0).energies;
            fastest = std::max(fastest, std::sqrt(2.0 * now.kinetic / mass));
        }
        const double sunk = (start.potential - now.potential) / (0.5 * mass * 981.0 * level);
        std::printf("%-11s cell %.2f cm, %.2f cells deep, pitch %.1f: at most %.2e cm/s, sunk by %.1e\n", c.transfer.name.c_str(), c.cell, c.depth,
                    c.spacing, fastest, sunk);
        EXPECT_LT(fastest, 0.1) << c.transfer.name << ' ' << c.depth;
        EXPECT_NEAR(sunk, 0.0, 2.0e-3) << c.transfer.name << ' ' << c.depth;
        EXPECT_LT(now.total() - start.total(), 5.0e-4 * 0.5 * mass * 981.0 * level) << c.transfer.name << ' ' << c.depth;
    }
}

/// So does a pool in a tank that is no multiple of the cell wide, whose walls leave any part of the last cells.
TEST(Rest, OfAPoolBetweenWallsWithinCellsLasts)
{
    struct Case {
        Transfer transfer;
        double cell;
    };
    for (const Case& c : {Case{kPoly8, 0.7}, {kPoly8, 0.6}, {kPoly8, 0.55}, {kApic, 0.45}, {kPoly27, 0.6}, {kFlip, 0.7}}) {
        const double width = 4.0 / c.cell, depth = 3.0 / c.cell;
        Scene scene = tankScene(c.transfer, c.cell, {width, 2.0 * width, width}, Vec3::Zero(), {width, depth, width});
        scene.settings.time.mode = TimeMode::Fixed;
        scene.settings.time.dt = 4.0e-3;
        scene.settings.time.integrator = c.transfer.name == kFlip.name ? TimeIntegrator::Plain : TimeIntegrator::Reflected;
        Simulation simulation(scene);
        const Energies start = simulation.energies();
        double fastest = 0.0;
        Energies now;
        while (simulation.state().time < 5.0) {
            now = simulation.step(5.0).energies;
            fastest = std::max(fastest, std::sqrt(2.0 * now.kinetic / 48.0));
        }
        const double risen = now.total() / start.total() - 1.0;
        std::printf("%-11s cell %.2f cm: at most %.2e cm/s, risen by %.1e\n", c.transfer.name.c_str(), c.cell, fastest, risen);
        EXPECT_LT(fastest, 0.05) << c.transfer.name << ' ' << c.cell;  // in the first steps, as the lattice settles
        EXPECT_NEAR(risen, 0.0, 5.0e-4) << c.transfer.name << ' ' << c.cell;
    }
}

/// Cells above a level in a plane of faces are on the verge of being liquid: that some are and others not moves nothing, and takes no energy.
TEST(Rest, OfALevelInAPlaneOfFacesLasts)
{
    struct Case {
        Transfer transfer;
        int order;
        double dt;
    };
    for (const Case& c : {Case{kPoly8, 2, 4.0e-3}, {kPoly8, 2, 2.0e-3}, {kPoly8, 1, 4.0e-3}, {kApic, 2, 4.0e-3}}) {
        Scene scene = pool(c.transfer, 0.5, 6.0, 0.4, TimeIntegrator::Reflected);
        scene.settings.liquid.surfaceOrder = c.order;
        scene.settings.time.dt = c.dt;
        Simulation simulation(scene);
        const double start = simulation.energies().total();
        while (simulation.state().time < 4.0) simulation.step(4.0);
        // The particles settle by 1.7e-4 of it in the first tenths of a second.
        EXPECT_NEAR(simulation.energies().total() / start, 1.0, 2.5e-4) << c.transfer.name << ", order " << c.order << ", steps of " << c.dt << " s";
    }
}

/// A pool whose level is across gravity rests, whatever the direction of that to the grid.
TEST(Rest, OfAPoolInTiltedGravityLasts)
{
    struct Case {
        Transfer transfer;
        Vec3 down;
        double cell, fastest;
    };
    for (const Case& c : {Case{kPoly8, {0.2, -1.0, 0.0}, 0.5, 0.12},
                          {kPoly8, {0.0, -1.0, -0.1}, 0.5, 0.12},
                          {kPoly8, {-0.2, -1.0, 0.1}, 0.5, 0.15},
                          {kPoly8, {-1.0, 0.1, 0.2}, 0.5, 0.15},
                          {kPoly8, {0.1, 0.15, 1.0}, 0.45, 0.2},
                          {kApic, {0.2, -1.0, 0.0}, 0.5, 0.12},
                          {kPoly27, {0.2, -1.0, 0.0}, 0.5, 0.15},
                          {kPoly8, {-1.0, -1.0, 0.0}, 0.5, 0.45}}) {  // no axis is nearest
        const double cells = 4.0 / c.cell;
        Scene scene = tankScene(c.transfer, c.cell, Vec3::Constant(cells), Vec3::Zero(), Vec3::Constant(cells));
        scene.settings.time.mode = TimeMode::Fixed;
        scene.settings.time.dt = 4.0e-3;
        const Vec3 down = c.down.normalized(), level(2.0, 2.0, 2.0);
        scene.settings.gravity = 981.0 * down;
        Eigen::Isometry3d turned = Eigen::Isometry3d::Identity();
        turned.linear() = Eigen::Quaterniond::FromTwoVectors(Vec3::UnitY(), -down).toRotationMatrix();
        turned.translation() = level + 10.0 * down;
        scene.sources[0].shape = Shape::intersect({scene.sources[0].shape, Shape::box(Vec3::Zero(), {20.0, 10.0, 20.0}).moved(turned)});
        Simulation simulation(scene);
        const double start = simulation.energies().total(), mass = simulation.state().ledger.emittedMass;
        double fastest = 0.0, most = 0.0;
        while (simulation.state().time < 2.0) {
            const Energies now = simulation.step(2.0).energies;
            fastest = std::max(fastest, std::sqrt(2.0 * now.kinetic / mass));
            most = std::max(most, now.total() - start);
        }
        std::printf("%-11s down (%g, %g, %g), cell %.2f cm: at most %.2e cm/s, %.1e of its weight times a cell gained\n", c.transfer.name.c_str(),
                    c.down.x(), c.down.y(), c.down.z(), c.cell, fastest, most / (mass * 981.0 * c.cell));
        // As the lattice, which the level cuts, settles; 1.3 to 2.1 cm/s where only columns along gravity's parts are even.
        EXPECT_LT(fastest, c.fastest) << c.transfer.name << ' ' << c.down.transpose();
        EXPECT_LT(most, 1.0e-4 * mass * 981.0 * c.cell) << c.transfer.name << ' ' << c.down.transpose();
    }
}

/// A block of liquid, four cells deep, slides down a frictionless slope as a stone does, whatever the order of the surface.
TEST(FreeSlip, OnSlantedWallsIsFree)
{
    for (const double angle : {20.0, 30.0, 45.0})
        for (const int order : {1, 2}) {
            Eigen::Isometry3d tilt = Eigen::Isometry3d::Identity();
            tilt.linear() = Eigen::AngleAxisd(-angle * kPi / 180.0, Vec3::UnitZ()).toRotationMatrix();
            Scene scene = tankScene(kPoly8, 0.25, {8.0, 4.0, 8.0}, Vec3::Zero(), {8.0, 4.0, 8.0});
            scene.settings.time.mode = TimeMode::Fixed;
            scene.settings.time.dt = 2.0e-3;
            scene.settings.liquid.surfaceOrder = order;
            scene.sources[0].shape = Shape::box({0.0, 0.5, 0.0}, {2.0, 0.5, 1.0}).moved(tilt);
            scene.obstacles.resize(2);
            scene.obstacles[0].name = "slope";
            scene.obstacles[0].shape = Shape::box({0.0, -1.0, 0.0}, {80.0, 1.0, 1.0}).moved(tilt);
            scene.obstacles[1].name = "walls";
            scene.obstacles[1].shape = Shape::box(Vec3::Zero(), {90.0, 90.0, 1.0}).inverted();
            Simulation simulation(scene);
            while (simulation.state().time < 0.2 - 1.0e-9) simulation.step(0.2);
            const LiquidParticles& liquid = simulation.state().liquid;
            double mass = 0.0, along = 0.0;
            for (std::size_t p = 0; p < liquid.count; ++p) {
                mass += liquid.mass[p];
                along += liquid.mass[p] * liquid.velocity(p).dot(tilt.linear() * Vec3::UnitX());
            }
            // Velocities are those of half a step ago.
            EXPECT_NEAR(along / mass / (981.0 * std::sin(angle * kPi / 180.0) * 0.199), 1.0, 0.02) << angle << " degrees, order " << order;
        }
}

/// A vessel whose walls go any way through the grid, filled to a level.
struct Vessel {
    std::string name;
    Shape inside;
    double depth;  ///< from its lowest place to the level [cm]
    double level;  ///< [cm]
};

std::vector<Vessel> vessels()
{
    const auto turned = [](const Shape& shape, double degrees, const Vec3& axis) {
        return shape.moved(Eigen::Isometry3d(Eigen::AngleAxisd(degrees * kPi / 180.0, axis.normalized())));
    };
    const Shape tank = Shape::box({2.0, 4.0, 2.0}, {2.0, 4.0, 2.0});
    return {{"tank", tank, 2.15, 2.15},
            {"tank turned about the vertical", turned(tank, 20.0, Vec3::UnitY()), 2.15, 2.15},
            {"tilted tank", turned(tank, 20.0, Vec3::UnitZ()), 2.15, 2.15},
            {"tilted and turned tank", turned(tank, 35.0, Vec3(1.0, 0.7, 0.2)), 2.4, 1.5},
            {"round tank", Shape::cylinder({0.1, 0.0, 0.2}, Vec3::UnitY(), 2.3, 4.0, 0.0), 2.6, -1.4},
            {"bowl", Shape::ball(Vec3::Zero(), 3.0), 2.5, -0.5}};
}

/// So does a pool between walls of any direction, whatever its particles' pattern.
TEST(Rest, OfAPoolInVesselsOfAnyShapeLasts)
{
    using Pattern = FillSettings::Pattern;
    for (const Vessel& vessel : vessels())
        for (const double friction : {0.0, 1.0})
            for (const auto& [pattern, spacing] : {std::pair(Pattern::Lattice, 0.5),
                                                   {Pattern::Lattice, 0.4},
                                                   {Pattern::Jittered, 0.4},
                                                   {Pattern::Poisson, 0.4},
                                                   {Pattern::Reference, 0.35355}}) {
                Scene scene = pool(kPoly8, 0.5, 1.0, spacing, TimeIntegrator::Reflected);
                scene.settings.liquid.wallFriction = friction;
                scene.sources[0].fill.pattern = pattern;
                scene.obstacles[0].shape = vessel.inside.inverted();
                scene.sources[0].shape = Shape::intersect({vessel.inside, Shape::box({0.0, vessel.level - 5.0, 0.0}, {9.0, 5.0, 9.0})});
                Simulation simulation(scene);
                const double start = simulation.energies().potential, mass = simulation.state().ledger.emittedMass;
                double fastest = 0.0;
                Energies now;
                for (int step = 0; step < 60; ++step) {
                    now = simulation.step(1.0e9).energies;
                    fastest = std::max(fastest, std::sqrt(2.0 * now.kinetic / mass));
                }
                const std::string what = vessel.name + ", friction " + std::to_string(friction) + ", pattern " + std::to_string(int(pattern));
                // Where the level meets slanted walls within a cell it settles, alike for all patterns; the published one has fewer and heavier
                // particles there.
                const bool isReference = pattern == Pattern::Reference;
                // Weight stands where splines leave it, which at slanted walls, whose rooms are those of one height, is not quite even: .535 cm/s (of
                // random places) and 2.2e-3 in the tank that is tilted and turned.
                EXPECT_LT(fastest, 0.55) << what;
                EXPECT_NEAR((start - now.potential) / (0.5 * mass * 981.0 * vessel.depth), 0.0, isReference ? 3.0e-3 : 2.4e-3) << what;
            }
}

void makeViscous(Scene& scene, double viscosity, double wallFriction)
{
    scene.settings.liquid.viscosity = viscosity;
    scene.settings.liquid.solveViscosity = true;
    scene.settings.liquid.wallFriction = wallFriction;
}

/// So it does between walls that hold the liquid by friction, or fast.
TEST(Rest, OfAPoolBetweenWallsWithFrictionLasts)
{
    for (const double friction : {0.1, 0.5, 1.0})
        for (const double spacing : {0.4, 0.5})
            for (const double depth : {4.3, 5.0})
                for (const Transfer& transfer : {kPoly8, kPic}) {
                    Scene scene = pool(transfer, 0.5, depth, spacing, transfer.name == kPic.name ? TimeIntegrator::Plain : TimeIntegrator::Reflected);
                    scene.settings.liquid.wallFriction = friction;
                    Simulation simulation(scene);
                    const double start = simulation.energies().potential, mass = std::pow(8.0, 2) * depth * std::pow(0.5, 3);
                    double fastest = 0.0;
                    Energies now;
                    for (int step = 0; step < 100; ++step) {
                        now = simulation.step(1.0e9).energies;
                        fastest = std::max(fastest, std::sqrt(2.0 * now.kinetic / mass));
                    }
                    EXPECT_LT(fastest, 0.15) << transfer.name << ", friction " << friction << ", pitch " << spacing;  // .1 but for a first step
                    EXPECT_NEAR((start - now.potential) / (0.5 * mass * 981.0 * depth * 0.5), 0.0, 2.0e-3)
                        << transfer.name << ", friction " << friction << ", pitch " << spacing;
                }
}

/// So does that of viscous liquid between walls that stick: they hold it against weight only where it shears.
TEST(Rest, OfViscousLiquidLasts)
{
    for (const double viscosity : {0.3, 10.0, 1.0e3, 1.0e5})
        for (const double wallFriction : {0.0, 0.4, 1.0})
            for (const Transfer& transfer : {kPoly8, kFlip}) {
                const auto integrator = transfer.name == kFlip.name ? TimeIntegrator::Plain : TimeIntegrator::Reflected;
                Scene scene = pool(transfer, 0.5, 4.3, 0.5, integrator);
                makeViscous(scene, viscosity, wallFriction);
                Simulation simulation(scene);
                const Energies start = simulation.energies();
                const double mass = std::pow(8.0, 2) * 4.3 * std::pow(0.5, 3);
                double fastest = 0.0;
                Energies now;
                for (int step = 0; step < 60; ++step) {
                    now = simulation.step(1.0e9).energies;
                    fastest = std::max(fastest, std::sqrt(2.0 * now.kinetic / mass));
                }
                const double sunk = (start.potential - now.potential) / (0.5 * mass * 981.0 * 4.3 * 0.5);
                EXPECT_LT(fastest, 0.1) << transfer.name << ", " << viscosity << " P, friction " << wallFriction;
                EXPECT_NEAR(sunk, 0.0, 2.0e-3) << transfer.name << ", " << viscosity << " P, friction " << wallFriction;
            }
}

/// Liquid so viscous that it hardly moves sinks, however thin its layer and wherever its floor: it never lifts itself.
TEST(Rest, IsWhereViscousLiquidSinksTo)
{
    for (const double viscosity : {100.0, 3.0e3})
        for (const double thickness : {1.0, 1.4, 3.0})
            for (const double above : {0.0, 0.5})
                for (const double wallFriction : {0.0, 1.0}) {
                    Scene scene = tankScene(kPoly8, 0.2, {16.0, 16.0, 16.0}, {5.0, above, 5.0}, {11.0, above + thickness, 11.0});
                    scene.settings.time.mode = TimeMode::Fixed;
                    scene.settings.time.dt = 4.0e-3;
                    scene.settings.liquid.volume.rate = 0.0;
                    makeViscous(scene, viscosity, wallFriction);
                    Simulation simulation(scene);
                    const double start = simulation.energies().total(), weight = std::abs(simulation.energies().potential);
                    double most = 0.0;
                    for (int step = 0; step < 40; ++step) most = std::max(most, simulation.step(1.0e9).energies.total() - start);
                    EXPECT_LT(most, 1.0e-3 * weight)
                        << viscosity << " P, " << thickness << " cells, " << above << " above, friction " << wallFriction;
                }
}

}  // namespace
}  // namespace sim::test
