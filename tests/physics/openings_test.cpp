#include "tests/physics/flume.h"

#include <gtest/gtest.h>

namespace sim::test {
namespace {

/// A stream passes a full duct for a second as if it had no ends: as fast everywhere, at the pressure beyond its outlet, as dense.
TEST(Openings, AStreamPassesADuctUnchanged)
{
    for (Flume flume : flumes())
        for (const bool hasGravity : {false, true}) {
            flume.hasGravity = hasGravity;
            flume.level = 7.0;
            const std::string what = flume.text() + (hasGravity ? ", with" : ", without") + " gravity";
            Simulation simulation(flume.scene());
            const double start = massOfLiquid(simulation), time = hasGravity ? 0.5 : 1.0;
            runFor(time, simulation);
            const double layer = flume.area() * 0.5 * flume.cell;
            EXPECT_LT(largestDeviation(simulation, flume.velocity()), 0.01) << what;
            EXPECT_NEAR(simulation.state().ledger.emittedMass - start, flume.area() * flume.speed * time, layer) << what;
            EXPECT_NEAR(massOfLiquid(simulation), start, layer) << what;
            for (const double along : {5.5, 10.5, 15.5}) {
                EXPECT_NEAR(flume.depthAt(simulation, along, 2.0), flume.depth, 0.01 * flume.depth) << what;
                const double height = 2.5, beyond = hasGravity ? kEarthGravity * flume.cell * (flume.level - height) : 0.0;
                EXPECT_NEAR(flume.pressureAt(simulation, along, height), beyond, 0.1 * 0.5 * flume.speed * flume.speed) << what;
            }
            expectBooksClose(simulation, what);
        }
}

/// Nor does it matter where in cells the walls of a duct and the ends of the domain lie, or that it is round.
TEST(Openings, DuctsMayLieAnywhereInTheGrid)
{
    for (const bool isRound : {false, true})
        for (Flume flume : {flumes()[0], flumes()[2], flumes()[3]}) {
            flume.hasGravity = false;
            flume.shift = Vec3(0.3, 0.35, 0.3);
            flume.depth = flume.roof = isRound ? 4.0 : 4.6;
            flume.width = isRound ? 4.0 : 3.3;
            Scene scene = flume.scene();
            double area = flume.area();
            if (isRound) {
                const double radius = 2.0 * flume.cell;
                area = kPi * radius * radius;
                const Vec3 middle = flume.at(0.5 * flume.length, 2.0, 2.0);
                scene.obstacles[0].shape = Shape::cylinder(middle, Vec3::Unit(flume.axis), radius, 2.0 * flume.length * flume.cell, 0.0).inverted();
            }
            Simulation simulation(scene);
            const double start = massOfLiquid(simulation), time = 0.5;
            runFor(time, simulation);
            const double layer = 0.5 * flume.cell * area, asked = area * flume.speed * time;
            EXPECT_LT(largestDeviation(simulation, flume.velocity()), 0.01) << flume.text() << (isRound ? ", round" : "");
            EXPECT_NEAR(simulation.state().ledger.emittedMass - start, asked, 0.01 * asked + layer) << flume.text() << (isRound ? ", round" : "");
            EXPECT_NEAR(massOfLiquid(simulation), start, 0.01 * start + layer) << flume.text() << (isRound ? ", round" : "");
        }
}

/// What comes in is what is asked for, through a face of which a part is in the open or wholly under liquid at rest.
TEST(Openings, InletsGiveWhatTheyAreAskedFor)
{
    for (Flume flume : flumes()) {
        flume.roof = 10.0;
        flume.isInletUnderLiquid = true;
        flume.length = 24.0;
        Simulation simulation(flume.scene());
        const double start = massOfLiquid(simulation), time = 1.0;
        double inMouth = 0.0;
        int count = 0;
        while (simulation.state().time < time) {
            simulation.step(time);
            const LiquidParticles& liquid = simulation.state().liquid;
            for (std::size_t p = 0; p < liquid.count; ++p) {
                if (flume.alongOf(liquid.position(p)) > 2.0) continue;
                inMouth += liquid.velocity(p).dot(flume.velocity()) / flume.speed;
                ++count;
            }
        }
        EXPECT_NEAR(inMouth / count, flume.speed, 0.01 * flume.speed) << flume.text();
        EXPECT_NEAR(simulation.state().ledger.emittedMass - start, flume.area() * flume.speed * time, flume.area() * 0.5 * flume.cell)
            << flume.text();
        expectBooksClose(simulation, flume.text());
    }
}

/// Liquid that comes into the empty is a stream of that velocity.
TEST(Openings, AJetComesOutOfAFaceInTheOpen)
{
    for (Flume flume : flumes()) {
        flume.hasGravity = false;
        Scene scene = flume.scene();
        scene.sources.clear();
        scene.openings.pop_back();
        Simulation simulation(scene);
        const double time = 0.5 * flume.length * flume.cell / flume.speed;
        runFor(time, simulation);
        EXPECT_NEAR(massOfLiquid(simulation), flume.area() * flume.speed * time, flume.area() * 0.5 * flume.cell) << flume.text();
        EXPECT_LT(largestDeviation(simulation, flume.velocity()), 0.01) << flume.text();
    }
}

/// Liquid that falls from a high inlet has no more energy than it came with: what holds it before it comes in is the opening, not its weight.
TEST(Openings, LiquidThatFallsFromAnInletGainsNothing)
{
    for (Flume flume : flumes()) {
        flume.depth = 12.0;
        flume.roof = 16.0;
        flume.level = 2.0;
        Scene scene = flume.scene();
        scene.sources.clear();
        EXPECT_LT(gainBeyondOpenings(scene, 40), 1.0e-3) << flume.text();
    }
}

/// A stream with a free surface keeps its depth where the liquid beyond the outlet stands as high.
TEST(Openings, AShallowStreamKeepsItsDepth)
{
    for (Flume flume : flumes()) {
        flume.roof = 12.0;
        flume.depth = flume.level = 6.0;
        flume.width = 2.0;
        Simulation simulation(flume.scene());
        double mean = 0.0;
        int count = 0;
        runFor(0.5, simulation);
        for (int n = 0; n < 20; ++n, ++count) {
            runFor(0.025, simulation);
            mean += flume.depthAt(simulation, 10.0, 6.0);
        }
        EXPECT_NEAR(mean / count, flume.depth, 0.02 * flume.depth) << flume.text();
        EXPECT_LT(largestDeviation(simulation, flume.velocity()), 0.3) << flume.text();
        expectBooksClose(simulation, flume.text());
    }
}

/// A pool whose level is that beyond its outlet stays where it is, wherever in a cell the level lies.
TEST(Openings, RestStaysRest)
{
    for (Flume flume : flumes())
        for (const double level : {4.0, 4.3, 4.7}) {
            flume.hasInlet = false;
            flume.roof = 10.0;
            flume.depth = flume.level = level;
            const std::string what = flume.text() + ", level " + std::to_string(level);
            Simulation simulation(flume.scene());
            const double start = massOfLiquid(simulation);
            runFor(0.5, simulation);
            EXPECT_NEAR(massOfLiquid(simulation), start, 1.0e-3 * start) << what;
            EXPECT_LT(simulation.state().memory.maxSpeed, 0.02 * std::sqrt(kEarthGravity * flume.cell)) << what;
        }
}

/// A pool finds the level beyond its outlet, from above and from below.
TEST(Openings, APoolFindsTheLevelBeyondItsOutlet)
{
    for (Flume flume : {flumes()[0], flumes()[3]})
        for (const double level : {5.0, 7.0}) {
            flume.hasInlet = false;
            flume.roof = 14.0;
            flume.depth = 6.0;
            flume.level = level;
            flume.length = 16.0;
            Simulation simulation(flume.scene());
            runFor(2.0, simulation);
            double mean = 0.0;
            for (int n = 0; n < 20; ++n) {
                runFor(0.02, simulation);
                mean += 0.05 * flume.depthAt(simulation, 6.0, 5.0);
            }
            EXPECT_NEAR(mean, level, 0.25) << flume.text();
            expectBooksClose(simulation, flume.text());
        }
}

/// Puts a hump on liquid that rests, which moves towards the outlet as a long wave does.
Simulation withHump(const Flume& flume, double height, double width, double along)
{
    const Scene scene = flume.scene();
    State state = Simulation(scene).state();
    LiquidParticles& liquid = state.liquid;
    const double speed = std::sqrt(kEarthGravity * flume.cell * flume.depth), floor = flume.cell * flume.shift[1];
    state.ledger.emittedMass = 0.0;
    for (std::size_t p = 0; p < liquid.count; ++p) {
        const double part = 1.0 + height / std::pow(std::cosh((flume.alongOf(liquid.position(p)) - along) / width), 2);
        liquid.x[1][p] = floor + part * (liquid.x[1][p] - floor);
        liquid.mass[p] *= part;
        liquid.mode(flume.axis, 0)[p] = (flume.isReversed ? -2.0 : 2.0) * speed * (std::sqrt(part) - 1.0);
        state.ledger.emittedMass += liquid.mass[p];
    }
    return Simulation(scene, state);
}

/// A pulse that leaves is hardly reflected.
TEST(Openings, APulseLeaves)
{
    constexpr double kHeight = 0.05;  // of the depth
    for (Flume flume : {flumes()[0], flumes()[2], flumes()[3], flumes()[5]}) {
        flume.hasInlet = false;
        flume.roof = 20.0;
        flume.width = 2.0;
        flume.depth = flume.level = 8.0;
        flume.length = 96.0;
        Simulation simulation = withHump(flume, kHeight, 12.0, 48.0);
        const double time = flume.length * flume.cell / std::sqrt(kEarthGravity * flume.cell * flume.depth);
        runFor(1.25 * time, simulation);  // back in the middle, if it came back
        double largest = 0.0;
        for (int n = 0; n < 20; ++n) {
            runFor(0.01 * time, simulation);
            for (double along = 24.0; along <= 80.0; along += 4.0)
                largest = std::max(largest, std::abs(flume.depthAt(simulation, along, 6.0) / flume.depth - 1.0));
        }
        EXPECT_LT(largest, 0.1 * kHeight) << flume.text();
        expectBooksClose(simulation, flume.text());
    }
}

}  // namespace
}  // namespace sim::test
