#pragma once

#include "tests/physics/closed_step.h"
#include "tests/physics/runs.h"

#include <gtest/gtest.h>

// Ducts and channels through which liquid runs, for the tests of openings.

namespace sim::test {

/// A duct or a channel with an inlet at one end of the domain and an outlet at the other. Lengths are in cells; y is up.
struct Flume {
    Transfer transfer = kPoly8;
    int axis = 0;             ///< along which it lies, 0 or 2
    bool isReversed = false;  ///< the inlet is at its upper end
    Vec3 shift = Vec3::Zero();
    TimeIntegrator integrator = TimeIntegrator::Reflected;
    double cell = 0.5, speed = 20.0;                 ///< [cm], [cm/s]
    double length = 20.0, width = 3.0, depth = 4.0;  ///< of the liquid
    double roof = 4.0, level = 4.0;                  ///< of the duct, of the liquid beyond the outlet; above the floor
    bool hasInlet = true, hasGravity = true;
    bool isInletUnderLiquid = false;  ///< a wall with a slot of half the depth stands in front of it

    std::string text() const
    {
        return transfer.name + " along " + "xyz"[axis] + (isReversed ? ", reversed" : "") + ", shifted by " + std::to_string(shift[axis]) +
               " cells, " + (integrator == TimeIntegrator::Plain ? "plain" : "reflected");
    }
    /// From distance from the inlet's face, height and place across, in cells, to a place.
    Vec3 at(double along, double height, double across) const
    {
        Vec3 x(0.0, height, 0.0);
        x[axis] = isReversed ? length - along : along;
        x[2 - axis] = across;
        return cell * (x + shift);
    }
    Shape box(const Vec3& low, const Vec3& high) const
    {
        const Vec3 a = at(low[0], low[1], low[2]), b = at(high[0], high[1], high[2]);
        return Shape::box(0.5 * (a + b), 0.5 * (b - a).cwiseAbs());
    }
    Vec3 velocity() const { return (isReversed ? -speed : speed) * Vec3::Unit(axis); }
    double area() const { return cell * cell * width * (isInletUnderLiquid ? 0.5 * depth : depth); }
    OpeningSettings opening(bool isInlet) const
    {
        OpeningSettings opening;
        opening.name = isInlet ? "inlet" : "outlet";
        opening.axis = axis;
        opening.isUpper = isInlet == isReversed;
        if (isInlet) opening.velocity = speed;
        if (hasGravity && (!isInlet || roof > depth)) opening.level = cell * ((isInlet ? depth : level) + shift[1]);
        return opening;
    }
    Scene scene() const
    {
        Scene scene;
        scene.name = "flume";
        scene.settings.cell = cell;
        scene.settings.time.dt = 4.0e-3 * cell / 0.5;
        scene.settings.time.integrator = integrator;
        scene.settings.transfer.method = transfer.method;
        scene.settings.transfer.modes = transfer.modes;
        if (!hasGravity) scene.settings.gravity.setZero();
        const double begin = hasInlet ? -10.0 : 0.0;
        scene.obstacles.push_back(obstacle("flume", box({begin, 0.0, 0.0}, {length + 10.0, roof, width}).inverted()));
        if (isInletUnderLiquid) scene.obstacles.push_back(obstacle("wall", box({-2.0, 0.5 * depth, -2.0}, {3.0, roof + 2.0, width + 2.0})));
        SourceSettings liquid;
        liquid.name = "liquid";
        liquid.shape = box({0.0, 0.0, 0.0}, {length, depth, width});
        liquid.fill.spacing = 0.5;
        liquid.emissions.push_back({});
        if (hasInlet && !isInletUnderLiquid) liquid.emissions[0].velocity = velocity();
        scene.sources = {liquid};
        scene.domain = box({0.0, -2.0, -2.0}, {length, roof + 2.0, width + 2.0});
        if (hasInlet) scene.openings.push_back(opening(true));
        scene.openings.push_back(opening(false));
        return scene;
    }
    double pressureAt(const Simulation& simulation, double along, double height) const
    {
        const BlockGrid& grid = simulation.state().grid;
        const Vec3i c = (at(along, height, 0.5 * width) / cell).array().floor().cast<int>();
        const int block = grid.find(Vec3i(c[0] >> 3, c[1] >> 3, c[2] >> 3));
        return block == BlockGrid::kNone ? 0.0 : simulation.state().pressure.block(block)[cellInBlock(c[0] & 7, c[1] & 7, c[2] & 7)];
    }
    double alongOf(const Vec3& x) const
    {
        const double s = x[axis] / cell - shift[axis];
        return isReversed ? length - s : s;
    }
    /// Depth of the liquid about a place, over a few cells [cells].
    double depthAt(const Simulation& simulation, double along, double reach) const
    {
        const LiquidParticles& liquid = simulation.state().liquid;
        double sum = 0.0;
        for (std::size_t p = 0; p < liquid.count; ++p)
            sum += liquid.mass[p] * std::max(0.0, 1.0 - std::abs(alongOf(liquid.position(p)) - along) / reach);
        return sum / (reach * width * cell * cell * cell);
    }
};

inline std::vector<Flume> flumes()
{
    std::vector<Flume> all(7);
    all[1].axis = 2;
    all[2].isReversed = true;
    all[2].transfer = kApic;
    all[3].axis = 2;
    all[3].isReversed = true;
    all[3].integrator = TimeIntegrator::Plain;
    all[4].transfer = kFlip;
    all[4].shift = Vec3(3.0, -5.0, 9.0);
    all[5].transfer = kPoly27;
    all[5].integrator = TimeIntegrator::Plain;
    all[6].transfer = kPic;
    all[6].cell = 0.2;
    all[6].speed = 10.0;
    return all;
}

inline void runFor(double time, Simulation& simulation)
{
    const double end = simulation.state().time + time;
    while (simulation.state().time < end) simulation.step(end);
}

/// Energy that liquid and fabric have beyond what they began with and what came from sources and openings, relative to the largest of motion.
inline double gainBeyondOpenings(const Scene& scene, int steps)
{
    Simulation simulation(scene);
    simulation.bookEnergy();
    const double start = simulation.energies().total();
    double given = 0.0, most = 0.0, kinetic = 0.0;
    for (int n = 0; n < steps; ++n) {
        const StepReport report = simulation.step(1.0e9);
        given += (*report.energyChanges)[EnergyChange::Sources];
        most = std::max(most, report.energies.total() - start - given);
        kinetic = std::max(kinetic, report.energies.kinetic);
    }
    return most / kinetic;
}

/// Mass of all particles, of what came in and of what left.
inline void expectBooksClose(const Simulation& simulation, const std::string& what)
{
    const Ledger& ledger = simulation.state().ledger;
    EXPECT_NEAR(massOfLiquid(simulation) + ledger.leftMass, ledger.emittedMass, 1.0e-12 * ledger.emittedMass) << what;
}

/// How far velocities of particles are from that of the stream, at most, relative to it.
inline double largestDeviation(const Simulation& simulation, const Vec3& velocity)
{
    const LiquidParticles& liquid = simulation.state().liquid;
    double largest = 0.0;
    for (std::size_t p = 0; p < liquid.count; ++p) largest = std::max(largest, (liquid.velocity(p) - velocity).norm());
    return largest / velocity.norm();
}

}  // namespace sim::test
