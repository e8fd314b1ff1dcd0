#include "drench/simulation.h"

#include "app/library/convert_errors.h"
#include "app/library/scene_parts.h"
#include "app/library/simulation_parts.h"

#include <fmt/format.h>

namespace drench {

namespace {

Energies fromSim(const sim::Energies& e)
{
    return {.kinetic = e.kinetic,
            .modal = e.modal,
            .potential = e.potential,
            .fabricKinetic = e.fabric.kinetic,
            .fabricPotential = e.fabric.potential,
            .elastic = e.fabric.elastic(),
            .contact = e.fabric.contact};
}

Step fromSim(const sim::StepReport& report)
{
    return {.dt = report.dt,
            .fastest = report.maxSpeed,
            .cfl = report.cfl,
            .isFirstOfTwo = report.isReflected,
            .pressureIterations = report.pressure.iterations,
            .pressureResidual = report.pressure.residual,
            .fabricIterations = report.fabric.newton,
            .rejectedSteps = report.rejectedSteps,
            .seconds = report.seconds(),
            .liquidMass = report.liquidMass,
            .absorbedMass = report.absorbedMass,
            .energies = fromSim(report.energies)};
}

}  // namespace

Simulation::Simulation(const Scene& scene, int threads)
{
    parts_ = convertErrors([&] { return std::make_unique<Parts>(scene.parts().read(), threads); });
}

Simulation::Simulation(Simulation&&) noexcept = default;
Simulation& Simulation::operator=(Simulation&&) noexcept = default;
Simulation::~Simulation() = default;

Step Simulation::step(double until)
{
    return convertErrors([&] { return fromSim(parts_->step(until)); });
}

void Simulation::advanceTo(double until)
{
    convertErrors([&] { parts_->advanceTo(until); });
}

double Simulation::time() const { return parts_->real().state().time; }
std::int64_t Simulation::steps() const { return parts_->real().state().step; }

double Simulation::end() const
{
    const sim::TimeSettings& time = parts_->real().scene().settings.time;
    return time.start + time.duration;
}

Particles Simulation::particles() const { return parts_->particles(); }
Fabric Simulation::fabric() const { return parts_->fabric(); }
Energies Simulation::energies() const { return fromSim(parts_->real().energies()); }

Load Simulation::on(const std::string& name) const
{
    const auto along = [&](const char* what) {
        const auto component = [&](char axis) { return read(fmt::format("{}_{}(\"{}\")", what, axis, name)); };
        return Vec3{component('x'), component('y'), component('z')};
    };
    return {.force = along("force"), .torque = along("torque")};
}

double Simulation::read(const std::string& formula, const Vec3& at) const
{
    return convertErrors([&] { return parts_->read(formula, at); });
}

std::uint64_t Simulation::stateHash() const { return parts_->real().stateHash(); }

}  // namespace drench
