#pragma once

#include "sim/core/units.h"
#include "sim/particles/velocity_modes.h"
#include "sim/simulation.h"

#include <cmath>
#include <string>

// Whole runs of the liquid for the tests of physics.

namespace sim::test {

struct Transfer {
    std::string name;
    TransferMethod method;
    int modes;
};
inline const Transfer kPic{"PIC", TransferMethod::Pic, 1}, kFlip{"FLIP", TransferMethod::Flip, 1}, kApic{"APIC", TransferMethod::Apic, 4},
    kPoly8{"PolyPIC-8", TransferMethod::PolyPic, 8}, kPoly11{"PolyPIC-11", TransferMethod::PolyPic, 11},
    kPoly27{"PolyPIC-27", TransferMethod::PolyPic, 27};
inline const std::array<Transfer, 6> kTransfers = {kPic, kFlip, kApic, kPoly8, kPoly11, kPoly27};

inline ObstacleSettings obstacle(const std::string& name, const Shape& shape, const Motion& motion = {})
{
    ObstacleSettings settings;
    settings.name = name;
    settings.shape = shape;
    settings.motion = motion;
    return settings;
}

/// A tank of `size` cells from the origin on, with free-slip walls in planes of faces, and a box of liquid from `low`
/// to `high` (cells).
inline Scene tankScene(const Transfer& transfer, double cell, const Vec3& size, const Vec3& low, const Vec3& high)
{
    Scene scene;
    scene.name = "tank";
    scene.settings.cell = cell;
    scene.settings.transfer.method = transfer.method;
    scene.settings.transfer.modes = transfer.modes;
    scene.settings.time.mode = TimeMode::Cfl;
    scene.settings.time.dt = 1.0;
    scene.obstacles.push_back(obstacle("tank", Shape::box(0.5 * cell * size, 0.5 * cell * size).inverted()));
    SourceSettings source;
    source.name = "liquid";
    source.shape = Shape::box(0.5 * cell * (low + high), 0.5 * cell * (high - low));
    source.emissions.push_back({});
    scene.sources.push_back(source);
    return scene;
}

/// A ball that falls into a pool with a post in it.
inline Scene ballIntoPool(const Transfer& transfer)
{
    Scene scene = tankScene(transfer, 0.5, {20.0, 24.0, 18.0}, {0.0, 0.0, 0.0}, {20.0, 5.0, 18.0});
    scene.settings.time.cfl = 1.0;
    scene.obstacles.push_back(obstacle("post", Shape::capsule({3.0, -1.0, 4.0}, {3.5, 4.0, 4.5}, 0.8)));
    SourceSettings drop;
    drop.shape = Shape::ball({6.0, 5.0, 4.5}, 1.6);
    Emission emission;
    emission.velocity = {-30.0, -150.0, 10.0};
    drop.emissions.push_back(emission);
    scene.sources.push_back(drop);
    return scene;
}

/// A column at one end of a short tank, 10 × 12 × 4 cells of 1 cm in 24, so high that nothing reaches its lid.
inline Scene coarseDamBreak(const Transfer& transfer)
{
    Scene scene = tankScene(transfer, 1.0, {24.0, 80.0, 4.0}, {0.0, 0.0, 0.0}, {10.0, 12.0, 4.0});
    scene.name = "coarse dam break";
    scene.sources[0].fill.spacing = 0.5;
    return scene;
}

/// A full box with free-slip walls, 16 cells across, for one Taylor-Green vortex: vortex(x) cm/s.
inline Scene vortexScene(const Transfer& transfer, double cfl)
{
    constexpr double kCells = 16.0, kDepth = 4.0, kCell = kPi / kCells;
    Scene scene = tankScene(transfer, kCell, {kCells, kCells, kDepth}, {0.0, 0.0, 0.0}, {kCells, kCells, kDepth});
    scene.settings.gravity = Vec3::Zero();
    scene.settings.liquid.full = true;
    scene.settings.liquid.volume.rate = 0.0;
    scene.settings.time.mode = TimeMode::Fixed;
    scene.settings.time.dt = cfl * kCell;
    return scene;
}
inline Vec3 vortex(const Vec3& x) { return {std::sin(x.x()) * std::cos(x.y()), -std::cos(x.x()) * std::sin(x.y()), 0.0}; }

/// A linear standing wave of half a wavelength in a tank 1 cm × `length`, as deep as that: the velocities it starts
/// with.
struct StandingWave {
    double length;  ///< [cm]
    double number = kPi / length, frequency = std::sqrt(kEarthGravity * number * std::tanh(number * length));
    double period = 2.0 * kPi / frequency;

    Scene scene(const Transfer& transfer, double cfl) const
    {
        Scene scene = tankScene(transfer, 1.0, {length, 2.0 * length, 4.0}, {0.0, 0.0, 0.0}, {length, length, 4.0});
        scene.settings.time.cfl = cfl;
        return scene;
    }
    /// With an amplitude of 4 % of the length [cm/s].
    Vec3 velocity(const Vec3& x) const
    {
        const double speed = 0.04 * length * frequency / std::sinh(number * length), k = number;
        return {-speed * std::sin(k * x.x()) * std::cosh(k * x.y()), speed * std::cos(k * x.x()) * std::sinh(k * x.y()), 0.0};
    }
};

/// Give every particle the velocity u(x) and its gradient.
template <class U>
void setVelocities(State& state, U&& u)
{
    LiquidParticles& liquid = state.liquid;
    const double dx = state.grid.dx, h = 1.0e-4 * dx;
    for (std::size_t p = 0; p < liquid.count; ++p) {
        const Vec3 x = liquid.position(p), v = u(x);
        for (int a = 0; a < kAxes; ++a) {
            for (int r = 0; r < liquid.modeCount; ++r) liquid.mode(a, r)[p] = 0.0;
            liquid.mode(a, 0)[p] = v[a];
        }
        if (liquid.modeCount < 4) continue;
        for (int b = 0; b < kAxes; ++b) {
            const Vec3 gradient = (u(x + h * Vec3::Unit(b)) - u(x - h * Vec3::Unit(b))) * (dx / (2.0 * h));
            for (int a = 0; a < kAxes; ++a) liquid.mode(a, 1 + b)[p] = gradient[a];
        }
    }
}

/// The scene's initial state with velocities u(x).
template <class U>
Simulation moving(const Scene& scene, U&& u)
{
    State state = Simulation(scene).state();
    setVelocities(state, u);
    return Simulation(scene, std::move(state));
}

inline bool isLiquid(const Simulation& simulation, const Vec3i& c)
{
    const int b = simulation.state().grid.find({c.x() >> 3, c.y() >> 3, c.z() >> 3});
    return b != BlockGrid::kNone && simulation.workspace().grid.inside.test(b, cellInBlock(c.x() & 7, c.y() & 7, c.z() & 7));
}

}  // namespace sim::test
