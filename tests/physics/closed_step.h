#pragma once

#include "sim/fabric/pieces/generators.h"
#include "sim/simulation.h"
#include "tests/physics/fabric_runs.h"
#include "tests/physics/runs.h"
#include "tests/sim/fixtures.h"

#include <gtest/gtest.h>
#include <numeric>
#include <random>

// A step in which all momentum is accounted for.

namespace sim::test {

inline constexpr double kExact = 1.0e-10;  ///< of what is exchanged: action and reaction

inline Vec3 momentumOfLiquid(const Simulation& simulation)
{
    Vec3 sum = Vec3::Zero();
    const LiquidParticles& particles = simulation.state().liquid;
    for (std::size_t p = 0; p < particles.count; ++p) sum += particles.mass[p] * particles.velocity(p);
    return sum;
}

inline Vec3 momentumOfFabric(const Simulation& simulation)
{
    Vec3 sum = Vec3::Zero();
    const FabricState& fabric = simulation.state().fabric;
    for (std::size_t v = 0; v < fabric.v.size(); ++v) sum += (simulation.fabric().mass[v] + fabric.absorbed[v]) * fabric.v[v];
    return sum;
}

inline double massOfLiquid(const Simulation& simulation)
{
    double sum = 0.0;
    const LiquidParticles& particles = simulation.state().liquid;
    for (std::size_t p = 0; p < particles.count; ++p) sum += particles.mass[p];
    return sum;
}

/// Takes a step and looks whether its forces are all that changed the momentum. What is exchanged is at least the weight.
struct ClosedStep {
    StepReport report;
    double error, exchanged;  ///< [g cm/s]

    explicit ClosedStep(Simulation& simulation)
    {
        const Vec3 before = momentumOfLiquid(simulation) + momentumOfFabric(simulation);
        report = simulation.step(1.0e9);
        const Forces& forces = simulation.forces();
        const MomentumBalance& balance = forces.balance;
        Vec3 rest = momentumOfLiquid(simulation) + momentumOfFabric(simulation) - before;
        EXPECT_LT((rest - balance.change).norm(), kExact * (before.norm() + balance.weight.norm()));
        exchanged = balance.weight.norm() + balance.entered.norm() + balance.left.norm();
        rest -= balance.weight + balance.entered - balance.left + balance.unresolved;
        for (const Load& load : forces.obstacles) rest += load.sum().linear, exchanged += load.sum().linear.norm();
        for (const Impulse& pins : forces.pins) rest += pins.linear, exchanged += pins.linear.norm();
        error = rest.norm();
    }
};

}  // namespace sim::test
