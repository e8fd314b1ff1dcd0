#include "sim/sources/enter_openings.h"

#include "sim/sources/lay.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace sim {

namespace {

constexpr double kNothing = std::numeric_limits<double>::infinity();

/// The part of the domain within a distance of a face, and below its level.
Eigen::AlignedBox3d slabAt(const Eigen::AlignedBox3d& domain, const OpeningSettings& opening, double thickness, const Vec3& gravity)
{
    Eigen::AlignedBox3d slab = domain;
    const int a = opening.axis;
    if (opening.isUpper) slab.min()[a] = slab.max()[a] - thickness;
    else slab.max()[a] = slab.min()[a] + thickness;
    if (gravity.isZero(0.0) || !std::isfinite(opening.level)) return slab;
    int up = 0;
    gravity.cwiseAbs().maxCoeff(&up);
    if (gravity[up] < 0.0) slab.max()[up] = std::min(slab.max()[up], opening.level);
    else slab.min()[up] = std::max(slab.min()[up], -opening.level);
    return slab;
}

/// Number of the column that a place is in; outside of all of them: −1.
int columnOf(const OpeningLayer& layer, const Vec3& x)
{
    const Vec3i at = (x - layer.corner).cwiseQuotient(layer.width).array().floor().cast<int>();
    if ((at.array() < 0).any() || (at.array() >= layer.columns.array()).any()) return -1;
    return (at[2] * layer.columns[1] + at[1]) * layer.columns[0] + at[0];
}

/// What a step works on at an opening.
struct Passage {
    const OpeningSettings& opening;
    OpeningLayer& layer;
    double density;  ///< [g/cm^3]
    std::vector<Vec3>& positions;
    State& state;

    void enter(const NewParticles& particles, const Vec3& velocity) const
    {
        addParticles(particles, density, velocity, state);
        state.ledger.emittedMass += density * particles.sum();
    }
};

/// Lays a layer with its middle at a distance from the face.
void layAt(double distance, const Passage& passage)
{
    const OpeningSettings& opening = passage.opening;
    passage.positions = passage.layer.places;
    for (Vec3& x : passage.positions) x[opening.axis] = passage.layer.atFace - opening.outward() * distance;
    const std::vector<double>& volumes = passage.layer.volumes;
    passage.enter({passage.positions, volumes[0], volumes}, -opening.outward() * opening.velocity * Vec3::Unit(opening.axis));
}

/// The layers of an inlet that have come in since the last one.
void enterInLayers(double dt, const Passage& passage, OpeningMemory& memory)
{
    const double pitch = passage.layer.pitch;
    if (passage.layer.places.empty()) return;
    constexpr double kRoundOff = 1.0e-9;
    while (memory.moved >= pitch * (1.0 - kRoundOff)) {
        layAt(memory.moved - 0.5 * pitch, passage);
        memory.moved -= pitch;
    }
    memory.moved += passage.opening.velocity * dt;
}

/// Finds what is nearest to the face in each column.
void findNearest(const OpeningSettings& opening, const LiquidParticles& liquid, OpeningLayer& layer)
{
    std::ranges::fill(layer.nearest, OpeningLayer::Nearest{kNothing, -1});
    const int a = opening.axis;
    for (std::size_t p = 0; p < liquid.count; ++p) {
        const double distance = opening.outward() * (layer.atFace - liquid.x[a][p]);
        if (!(distance < layer.width[a])) continue;
        const int column = columnOf(layer, liquid.position(p));
        if (column < 0) continue;
        OpeningLayer::Nearest& nearest = layer.nearest[column];
        if (distance < nearest.distance) nearest = {distance, static_cast<int>(p)};
    }
}

/// Where liquid moves inwards through an outlet, a particle is laid a pitch behind the last one as soon as there is room for it.
void followInwards(const Passage& passage)
{
    const OpeningSettings& opening = passage.opening;
    OpeningLayer& layer = passage.layer;
    constexpr double kRoom = 1.5;  // [pitches]
    findNearest(opening, passage.state.liquid, layer);
    for (std::size_t n = 0; n < layer.places.size(); ++n) {
        const int column = columnOf(layer, layer.places[n]);
        if (column < 0) continue;
        const auto [distance, last] = layer.nearest[column];
        if (last < 0 || distance < kRoom * layer.pitch) continue;
        const Vec3 velocity = passage.state.liquid.velocity(last);
        if (!(opening.outward() * velocity[opening.axis] < 0.0)) continue;
        Vec3 x = layer.places[n];
        x[opening.axis] = layer.atFace - opening.outward() * (distance - layer.pitch);
        passage.enter({{&x, 1}, layer.volumes[n]}, velocity);
    }
}

/// Finds the layers anew where obstacles may have moved.
void prepare(const Scene& scene, double packing, const State& state, PassageWorkspace& work)
{
    const bool isStill =
        std::ranges::all_of(scene.obstacles, [&](const ObstacleSettings& o) { return !o.motion.moves(state.time - state.lastDt, state.time); });
    if (isStill && work.layers.size() == scene.openings.size()) return;
    work.layers.clear();
    for (const OpeningSettings& opening : scene.openings) {
        OpeningLayer layer = layerOf(scene, opening, state.time);
        for (double& volume : layer.volumes) volume *= packing;
        work.layers.push_back(std::move(layer));
    }
}

}  // namespace

OpeningLayer layerOf(const Scene& scene, const OpeningSettings& opening, double time)
{
    const FillSettings fill = scene.sources.empty() ? FillSettings() : scene.sources[0].fill;
    OpeningLayer layer;
    SeedPlan plan;
    plan.fill.spacing = fill.pitch();
    plan.dx = scene.settings.cell;
    layer.pitch = particleSpacing(plan.fill, plan.dx);
    const Eigen::AlignedBox3d domain = scene.domain->bounds(), slab = slabAt(domain, opening, layer.pitch, scene.settings.gravity);
    layer.atFace = opening.isUpper ? domain.max()[opening.axis] : domain.min()[opening.axis];
    if ((slab.sizes().array() <= 0.0).any()) return layer;
    plan.source = Shape::box(slab.center(), 0.5 * slab.sizes());
    plan.solids = solidsAt(scene, time);
    Seeds seeds = seedParticles(plan);
    layer.places = std::move(seeds.positions);
    layer.volumes = std::move(seeds.volumes);
    layer.volumes.resize(layer.places.size(), seeds.volume);
    const int a = opening.axis;
    constexpr double kReach = 3.0;  ///< how far behind the face the last particle is looked for [cells]
    layer.corner = slab.min();
    for (int b = 0; b < kAxes; ++b) {
        layer.columns[b] = b == a ? 1 : std::max(1, static_cast<int>(std::lround(slab.sizes()[b] / layer.pitch)));
        layer.width[b] = b == a ? kReach * plan.dx : slab.sizes()[b] / layer.columns[b];
    }
    if (opening.isUpper) layer.corner[a] = layer.atFace - layer.width[a];
    layer.nearest.resize(static_cast<std::size_t>(layer.columns.prod()));
    return layer;
}

void enterOpenings(const Scene& scene, double packing, double dt, State& state, PassageWorkspace& work)
{
    if (scene.openings.empty()) return;
    state.memory.openings.resize(scene.openings.size());
    prepare(scene, packing, state, work);
    for (std::size_t n = 0; n < scene.openings.size(); ++n) {
        const Passage passage{scene.openings[n], work.layers[n], scene.settings.liquid.density, work.positions, state};
        if (passage.opening.isInlet()) enterInLayers(dt, passage, state.memory.openings[n]);
        else followInwards(passage);
    }
}

}  // namespace sim
