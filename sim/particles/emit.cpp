#include "sim/particles/emit.h"

#include "sim/core/check.h"
#include "sim/core/parallel.h"
#include "sim/particles/seed.h"

#include <fmt/format.h>

#include <cmath>
#include <limits>

namespace sim {

namespace {

bool isInstant(const Emission& e)
{
    return e.to <= e.from;
}

bool isActive(const Emission& e, double timeFrom, double timeTo)
{
    const bool runs = e.from <= timeFrom && timeFrom <= e.to && !isInstant(e);
    if (timeFrom == timeTo) return runs || (isInstant(e) && e.from <= timeFrom);
    const bool isShort = timeFrom < e.from && e.to <= timeTo;  // no step begins in it
    return runs || isShort;
}

std::vector<Shape> solidsAt(const Scene& scene, double time)
{
    std::vector<Shape> solids;
    for (const ObstacleSettings& o : scene.obstacles)
        solids.push_back(o.motion.isStatic() ? o.shape : o.shape.moved(o.motion.transform(time)));
    return solids;
}

LiquidNearby liquidNear(const LiquidParticles& liquid, const SeedPlan& plan, double density)
{
    LiquidNearby nearby;
    Eigen::AlignedBox3d box = plan.source.bounds();
    if (box.isEmpty()) return nearby;
    const Vec3 reach = Vec3::Constant(particleSpacing(plan.fill, plan.dx));
    box = {box.min() - reach, box.max() + reach};
    for (std::size_t p = 0; p < liquid.count; ++p) {
        const Vec3 x = liquid.position(p);
        if (!box.contains(x)) continue;
        nearby.positions.push_back(x);
        if (plan.source.distance(x) < 0.0) nearby.volumeInside += liquid.mass[p] / density;
    }
    return nearby;
}

void addParticles(std::span<const Vec3> positions, double mass, const Vec3& velocity, State& state)
{
    LiquidParticles& liquid = state.liquid;
    if (positions.size() > std::numeric_limits<std::uint32_t>::max() - state.nextId)
        throw RunError("the sources have given more particles than can be numbered (2^32)");
    const std::size_t before = liquid.count;
    const std::uint32_t firstId = state.nextId;
    liquid.resize(before + positions.size());
    parallelFor(positions.size(), 4096, [&](std::size_t n) {
        const std::size_t p = before + n;
        liquid.mass[p] = mass;
        liquid.id[p] = firstId + static_cast<std::uint32_t>(n);
        for (int axis = 0; axis < kAxes; ++axis) {
            liquid.x[axis][p] = positions[n][axis];
            liquid.mode(axis, 0)[p] = velocity[axis];
        }
    });
    state.nextId += static_cast<std::uint32_t>(positions.size());
}

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

/// The first of the seeds, until a volume is reached: the last one may pass it.
std::span<const Vec3> upTo(const Seeds& seeds, double volume)
{
    const std::span<const Vec3> all(seeds.positions);
    const double most = std::ceil(volume / seeds.volume);
    return most < static_cast<double>(all.size()) ? all.first(static_cast<std::size_t>(most)) : all;
}

std::string nameOf(const Scene& scene, std::size_t source)
{
    return scene.file + ": source " + std::to_string(source + 1) + " \"" + scene.sources[source].name + "\" ";
}

void emitFrom(const Scene& scene, std::size_t source, const Emission& emission, double time, State& state)
{
    const SourceSettings& settings = scene.sources[source];
    const double density = scene.settings.liquid.density;
    SeedPlan plan;
    plan.source = settings.shape;
    plan.solids = solidsAt(scene, time);
    plan.fill = settings.fill;
    plan.dx = scene.settings.cell;
    plan.gridOrigin = state.grid.origin;
    plan.stream = source;
    if (!isInstant(emission)) {
        plan.velocity = emission.velocity;
        plan.age = std::max(0.0, time - emission.from);
    }
    Seeds seeds;
    try {
        seeds = seedParticles(plan, liquidNear(state.liquid, plan, density));
    } catch (const InputError& e) {
        throw InputError(nameOf(scene, source) + e.what());
    }
    if (seeds.positions.empty()) {
        if (!isInstant(emission)) return;
        throw InputError(nameOf(scene, source) + "has no room for a particle: it is empty, smaller than " +
                         std::to_string(particleSpacing(plan.fill, plan.dx)) +
                         " cm, inside an obstacle, or full already");
    }
    const auto positions = upTo(seeds, emission.maxVolume - state.emittedVolume[source]);
    const std::size_t before = state.liquid.count;
    addParticles(positions, density * seeds.volume, emission.velocity, state);
    try {
        if (settings.velocityField) addField(*settings.velocityField, before, state);
    } catch (const VelocityField::Mistake& mistake) {
        throw InputError(fmt::format("{}velocity_field: \"{}\": {}", nameOf(scene, source), settings.velocityField->formula(mistake.component), mistake.what));
    }
    const double volume = static_cast<double>(positions.size()) * seeds.volume;
    state.emittedVolume[source] += volume;
    state.ledger.emittedMass += density * volume;
}

}  // namespace

namespace {

bool gives(const Emission& emission, double emittedVolume, double timeFrom, double timeTo)
{
    return isActive(emission, timeFrom, timeTo) && emittedVolume < emission.maxVolume;
}

}  // namespace

bool emits(const Scene& scene, const State& state, double timeFrom, double timeTo)
{
    for (std::size_t source = 0; source < scene.sources.size(); ++source)
        for (const Emission& emission : scene.sources[source].emissions)
            if (gives(emission, state.emittedVolume[source], timeFrom, timeTo)) return true;
    return false;
}

void emitLiquid(const Scene& scene, State& state, double timeFrom, double timeTo)
{
    state.emittedVolume.resize(scene.sources.size(), 0.0);
    for (std::size_t source = 0; source < scene.sources.size(); ++source)
        for (const Emission& emission : scene.sources[source].emissions)
            if (gives(emission, state.emittedVolume[source], timeFrom, timeTo))
                emitFrom(scene, source, emission, timeFrom, state);
}

}  // namespace sim
