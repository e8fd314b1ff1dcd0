#include "app/reports/step_logs.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace app {

namespace {

using Json = nlohmann::ordered_json;

Json energyJson(const sim::Energies& e) { return {{"kinetic", e.kinetic}, {"modal", e.modal}, {"potential", e.potential}, {"total", e.total()}}; }

Json fabricJson(const sim::StepReport& step)
{
    const sim::FabricReport& r = step.fabric;
    const sim::FabricEnergies& e = step.energies.fabric;
    return {{"newton", r.newton},
            {"iterations", r.iterations},
            {"speed_error", r.speedError},
            {"accepted_fraction", r.acceptedFraction},
            {"substep_splits", r.substepSplits},
            {"truncated_substeps", r.truncatedSubsteps},
            {"candidate_list_builds", r.candidateListBuilds},
            {"global_scalings", r.globalScalings},
            {"candidates", r.candidates},
            {"contacts", r.contacts},
            {"obstacle_contacts", r.obstacleContacts},
            {"energy",
             {{"kinetic", e.kinetic},
              {"potential", e.potential},
              {"stretching", e.stretching},
              {"bending", e.bending},
              {"twisting", e.twisting},
              {"membrane", e.membrane},
              {"shell_bending", e.shellBending},
              {"contact", e.contact}}}};
}

/// Seconds of the stages that ran in this step.
Json stageJson(const sim::StepReport& report)
{
    Json seconds = {{"total", report.seconds()}};
    for (int s = 0; s < sim::kStages; ++s)
        if (report.stageRan[s]) seconds[std::string(sim::kStageNames[s])] = report.stageSeconds[s];
    return seconds;
}

/// What the published program sums up as energy: without the liquid's motion, elasticity and what fabric has absorbed [erg].
double publishedEnergy(const sim::FabricState& fabric, const sim::Energies& e, const sim::Vec3& gravity)
{
    double absorbed = 0.0;
    for (std::size_t v = 0; v < fabric.absorbed.size(); ++v)
        absorbed += fabric.absorbed[v] * (0.5 * fabric.v[v].squaredNorm() - gravity.dot(fabric.x[v]));
    return e.potential + e.fabric.kinetic + e.fabric.potential - absorbed;
}

}  // namespace

std::string stepLine(const sim::State& state, const sim::StepReport& report, const ForceNames& names, const sim::Forces& forces)
{
    Json line = {
        {"step", state.step},
        {"time", state.time},
        {"dt", report.dt},
        {"cfl", report.cfl},
        {"max_speed", report.maxSpeed},
        {"seconds", stageJson(report)},
        {"iterations", report.pressure.iterations},
        {"residual", report.pressure.residual},
        {"converged", report.pressure.converged && report.withheld.converged && report.viscosity.converged},
        {"rejected_steps", report.rejectedSteps},
        {"reflected", report.isReflected},
        {"volume_iterations", report.volume.iterations},
        {"viscosity_iterations", report.viscosity.iterations},
        {"hydrostatic_iterations", report.withheld.iterations},
        {"particles", report.particles},
        {"blocks", report.blocks},
        {"cells", report.liquidCells},
        {"energy", energyJson(report.energies)},
        {"ledger",
         {{"emitted_mass", state.ledger.emittedMass},
          {"left_mass", state.ledger.leftMass},
          {"liquid_mass", report.liquidMass},
          {"absorbed_mass", report.absorbedMass},
          {"pin_impulse", {report.pinImpulse.x(), report.pinImpulse.y(), report.pinImpulse.z()}}}},
    };
    if (!state.fabric.x.empty()) line["fabric"] = fabricJson(report);
    if (forces.dt > 0.0) {
        line["ledger"]["momentum"] = balanceJson(forces);
        line["forces"] = forcesJson(names, forces);
    }
    return line.dump();
}

std::string energyRow(const sim::State& state, const sim::Energies& e, double liquidMass, const sim::Vec3& gravity)
{
    const std::size_t particles = state.liquid.count;
    const double published = publishedEnergy(state.fabric, e, gravity);
    const double perParticle = particles > 0 ? e.total() / static_cast<double>(particles) : 0.0;
    return fmt::format("{:.9g},{:.12g},{:.12g},{:.12g},{:.12g},{},{:.15g},{:.12g},{:.12g},{:.12g},{:.12g},{:.12g},{:.12g}", state.time, e.kinetic,
                       e.modal, e.potential, e.total(), particles, liquidMass, perParticle, e.fabric.kinetic, e.fabric.potential, e.fabric.elastic(),
                       e.fabric.contact, published);
}

}  // namespace app
