#include "sim/sources/lay.h"

#include "sim/core/check.h"
#include "sim/core/parallel.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace sim {

namespace {

/// Gives the particles from `first` on the velocities of the field, and what modes they have its gradient.
void addField(const VelocityField& field, std::size_t first, State& state)
{
    LiquidParticles& liquid = state.liquid;
    const double dx = state.grid.dx;
    for (std::size_t p = first; p < liquid.count; ++p) {
        const Vec3 x = liquid.position(p), velocity = field.at(x);
        for (int a = 0; a < kAxes; ++a) liquid.mode(a, 0)[p] += velocity[a];
        if (liquid.modeCount < 4) continue;
        const Mat3 gradient = field.gradient(x, 1.0e-4 * dx);
        for (int a = 0; a < kAxes; ++a)
            for (int b = 0; b < kAxes; ++b) liquid.mode(a, 1 + b)[p] += dx * gradient(a, b);
    }
}

}  // namespace

std::vector<Shape> solidsAt(const Scene& scene, double time)
{
    std::vector<Shape> solids;
    for (const ObstacleSettings& o : scene.obstacles) solids.push_back(o.motion.isStatic() ? o.shape : o.shape.moved(o.motion.transform(time)));
    return solids;
}

void addParticles(const NewParticles& particles, double density, const Vec3& velocity, State& state)
{
    LiquidParticles& liquid = state.liquid;
    const std::span<const Vec3> positions = particles.positions;
    if (positions.size() > std::numeric_limits<std::uint32_t>::max() - state.nextId)
        throw RunError("the sources have given more particles than can be numbered (2^32)");
    const std::size_t before = liquid.count;
    const std::uint32_t firstId = state.nextId;
    liquid.resize(before + positions.size());
    parallelFor(positions.size(), 4096, [&](std::size_t n) {
        const std::size_t p = before + n;
        liquid.mass[p] = density * particles.volumeOf(n);
        liquid.id[p] = firstId + static_cast<std::uint32_t>(n);
        for (int axis = 0; axis < kAxes; ++axis) {
            liquid.x[axis][p] = positions[n][axis];
            liquid.mode(axis, 0)[p] = velocity[axis];
        }
    });
    state.nextId += static_cast<std::uint32_t>(positions.size());
}

std::size_t countUpTo(double volume, double perParticle)
{
    const double most = std::ceil(volume / perParticle);
    constexpr double kAny = 1.0e15;
    return most < kAny ? static_cast<std::size_t>(std::max(0.0, most)) : static_cast<std::size_t>(kAny);
}

std::string nameOf(const Scene& scene, std::size_t source)
{
    return scene.file + ": source " + std::to_string(source + 1) + " \"" + scene.sources[source].name + "\" ";
}

SeedPlan planFor(const Scene& scene, std::size_t source, double time, const State& state)
{
    SeedPlan plan;
    plan.source = scene.sources[source].shape;
    plan.solids = solidsAt(scene, time);
    plan.fill = scene.sources[source].fill;
    plan.dx = scene.settings.cell;
    plan.gridOrigin = state.grid.origin;
    plan.stream = source;
    return plan;
}

LiquidNearby liquidNear(const LiquidParticles& liquid, const SeedPlan& plan, double density)
{
    LiquidNearby nearby;
    Eigen::AlignedBox3d box = plan.source.bounds();
    if (box.isEmpty()) return nearby;
    const Vec3 reach = Vec3::Constant(particleSpacing(plan.fill, plan.dx));
    box.extend(Eigen::AlignedBox3d(box.min() + plan.moved, box.max() + plan.moved));
    box = {box.min() - reach, box.max() + reach};
    for (std::size_t p = 0; p < liquid.count; ++p) {
        const Vec3 x = liquid.position(p);
        if (!box.contains(x)) continue;
        nearby.positions.push_back(x);
        if (plan.source.distance(x) < 0.0) nearby.volumeInside += liquid.mass[p] / density;
    }
    return nearby;
}

Seeds seedsFor(const Scene& scene, std::size_t source, const SeedPlan& plan, const LiquidNearby& nearby)
try {
    return seedParticles(plan, nearby);
} catch (const InputError& e) {
    throw InputError(nameOf(scene, source) + e.what());
}

NewParticles firstOf(const Seeds& seeds, std::size_t most)
{
    const std::size_t count = std::min(most, seeds.positions.size());
    const std::span<const double> volumes = seeds.volumes;
    return {std::span(seeds.positions).first(count), seeds.volume, volumes.first(std::min(count, volumes.size()))};
}

void lay(const Scene& scene, std::size_t source, const Emission& emission, const NewParticles& particles, State& state)
{
    const SourceSettings& settings = scene.sources[source];
    const double density = scene.settings.liquid.density;
    const std::size_t before = state.liquid.count;
    addParticles(particles, density, emission.velocity, state);
    try {
        if (settings.velocityField) addField(*settings.velocityField, before, state);
    } catch (const VelocityField::Mistake& mistake) {
        throw InputError(
            fmt::format("{}velocity_field: \"{}\": {}", nameOf(scene, source), settings.velocityField->formula(mistake.component), mistake.what));
    }
    state.emittedVolume[source] += particles.sum();
    state.ledger.emittedMass += density * particles.sum();
}

}  // namespace sim
