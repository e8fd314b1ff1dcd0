#include "app/library/simulation_parts.h"

#include "app/library/scene_parts.h"
#include "app/readings/reading_context.h"
#include "app/system/thread_limit.h"
#include "sim/core/parallel.h"

#include <utility>

namespace drench {

template <class Body>
auto Simulation::Parts::withThreads(Body&& body) const
{
    return threads_ > 0 ? app::withThreads(threads_, body) : body();
}

Simulation::Parts::Parts(const sim::Scene& scene, int threads) : threads_(threads), measures_(scene)
{
    simulation_ = withThreads([&] { return std::make_unique<app::RealSimulation>(scene); });
    measures_.look(*simulation_);
    const sim::Node nothing = sim::Node::map({});
    names_ = app::readContext(sim::SectionReader(nothing, "read"), scene, measures_).reading;
    names_.variables = {"x", "y", "z", "t"};
    copyLinks();
}

void Simulation::Parts::copyLinks()
{
    for (const auto& edge : real().fabric().edges.vertices) edges_.push_back({edge[0], edge[1]});
    for (const auto& face : real().fabric().faces.vertices) triangles_.push_back({face[0], face[1], face[2]});
}

/// Nothing that was copied holds any longer, whatever becomes of the step. Forces are means over what follows; of two steps that belong together
/// only both tell.
void Simulation::Parts::beginStep()
{
    hasParticles_ = hasFabric_ = false;
    if (!real().state().reflected) measures_.startInterval();
}

sim::StepReport Simulation::Parts::step(double until)
{
    beginStep();
    const sim::StepReport report = withThreads([&] { return simulation_->step(until); });
    measures_.afterStep();
    return report;
}

void Simulation::Parts::advanceTo(double until)
{
    if (real().state().time >= until) return;
    beginStep();
    withThreads([&] {
        while (real().state().time < until) {
            simulation_->step(until);
            measures_.afterStep();
        }
    });
}

Particles Simulation::Parts::particles()
{
    const sim::LiquidParticles& liquid = real().state().liquid;
    const std::size_t n = liquid.count;
    if (!std::exchange(hasParticles_, true)) {
        for (auto& component : velocity_) component.resize(n);
        sim::parallelFor(n, sim::kGrain, [&](std::size_t p) {
            const sim::Vec3 v = liquid.velocity(p);
            for (int a = 0; a < sim::kAxes; ++a) velocity_[a][p] = v[a];
        });
    }
    const auto of = [n](const auto& array) { return std::span(array.data(), n); };
    return {.x = of(liquid.x[0]),
            .y = of(liquid.x[1]),
            .z = of(liquid.x[2]),
            .u = of(velocity_[0]),
            .v = of(velocity_[1]),
            .w = of(velocity_[2]),
            .mass = of(liquid.mass),
            .id = of(liquid.id)};
}

Fabric Simulation::Parts::fabric()
{
    const sim::Fabric& fabric = real().fabric();
    const sim::FabricState& state = real().state().fabric;
    const std::size_t n = fabric.vertexCount();
    if (!std::exchange(hasFabric_, true)) {
        const std::vector<double> capacity = sim::poreCapacity(fabric, real().scene().settings.liquid.density);
        position_.resize(n);
        vertexVelocity_.resize(n);
        saturation_.resize(n);
        for (std::size_t v = 0; v < n; ++v) {
            position_[v] = fromSim(state.x[v]);
            vertexVelocity_[v] = fromSim(state.v[v]);
            saturation_[v] = capacity[v] > 0.0 ? state.absorbed[v] / capacity[v] : 0.0;
        }
    }
    return {.position = position_,
            .velocity = vertexVelocity_,
            .mass = fabric.mass,
            .absorbed = state.absorbed,
            .saturation = saturation_,
            .piece = fabric.vertexMaterial,
            .edges = edges_,
            .triangles = triangles_};
}

double Simulation::Parts::read(const std::string& formula, const Vec3& at)
{
    auto known = formulas_.find(formula);
    if (known == formulas_.end()) {
        try {
            known = formulas_.emplace(formula, sim::Formula(formula, names_)).first;
        } catch (const sim::FormulaError& error) {
            throw InputError(sim::inQuotes(formula) + ": " + error.what());
        }
    }
    try {
        return known->second(std::array{at.x, at.y, at.z, real().state().time});
    } catch (const sim::FormulaError&) {
        return std::numeric_limits<double>::quiet_NaN();
    }
}

}  // namespace drench
