#include "app/reports/run_report.h"

#include "app/parts.h"
#include "app/system/peak_memory.h"
#include "app/system/statistics.h"
#include "app/system/stopwatch.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace app {

namespace {

using Json = nlohmann::ordered_json;

constexpr std::array<std::string_view, 4> kStatusNames = {"running", "done", "interrupted", "failed"};

Json energyJson(const sim::Energies& e) { return {{"kinetic", e.kinetic}, {"modal", e.modal}, {"potential", e.potential}, {"total", e.total()}}; }

Json fabricJson(const sim::StepReport& step)
{
    const sim::FabricReport& r = step.fabric;
    const sim::FabricEnergies& e = step.energies.fabric;
    return {{"newton", r.newton},
            {"iterations", r.iterations},
            {"speed_error", r.speedError},
            {"taken_fraction", r.takenFraction},
            {"halvings", r.halvings},
            {"shortened", r.shortened},
            {"list_builds", r.listBuilds},
            {"scalings", r.scalings},
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
        {"taken_back", report.takenBack},
        {"reflected", report.isReflected},
        {"volume_iterations", report.volume.iterations},
        {"viscosity_iterations", report.viscosity.iterations},
        {"withheld_iterations", report.withheld.iterations},
        {"particles", report.particles},
        {"blocks", report.blocks},
        {"cells", report.liquidCells},
        {"energy", energyJson(report.energies)},
        {"ledger",
         {{"emitted_mass", state.ledger.emittedMass},
          {"left_mass", state.ledger.leftMass},
          {"liquid_mass", report.liquidMass},
          {"absorbed_mass", report.absorbedMass},
          {"momentum_to_pins", {report.toPins.x(), report.toPins.y(), report.toPins.z()}}}},
    };
    if (!state.fabric.x.empty()) line["fabric"] = fabricJson(report);
    if (forces.dt > 0.0) {
        line["ledger"]["momentum"] = balanceJson(forces);
        line["forces"] = forcesJson(names, forces);
    }
    return line.dump();
}

constexpr std::string_view kEnergyHeader =
    "time_s,kinetic_erg,modal_erg,potential_erg,total_erg,particles,liquid_mass_g,total_per_particle_erg,"
    "fabric_kinetic_erg,fabric_potential_erg,fabric_elastic_erg,fabric_contact_erg,published_erg";

/// What the published program sums up as energy: without the liquid's motion, elasticity and what fabric has absorbed [erg].
double publishedEnergy(const sim::FabricState& fabric, const sim::Energies& e, const sim::Vec3& gravity)
{
    double absorbed = 0.0;
    for (std::size_t v = 0; v < fabric.absorbed.size(); ++v)
        absorbed += fabric.absorbed[v] * (0.5 * fabric.v[v].squaredNorm() - gravity.dot(fabric.x[v]));
    return e.potential + e.fabric.kinetic + e.fabric.potential - absorbed;
}

std::string energyRow(double time, const sim::Energies& e, std::size_t particles, double liquidMass, double published)
{
    const double perParticle = particles > 0 ? e.total() / static_cast<double>(particles) : 0.0;
    return fmt::format("{:.9g},{:.12g},{:.12g},{:.12g},{:.12g},{},{:.15g},{:.12g},{:.12g},{:.12g},{:.12g},{:.12g},{:.12g}", time, e.kinetic, e.modal,
                       e.potential, e.total(), particles, liquidMass, perParticle, e.fabric.kinetic, e.fabric.potential, e.fabric.elastic(),
                       e.fabric.contact, published);
}

Json secondsPerStepJson(const StageTimes& times)
{
    Json stages = Json::object();
    for (int s = 0; s < sim::kStages; ++s)
        stages[std::string(sim::kStageNames[s])] = times.stages[s].empty() ? Json(nullptr) : Json(times.medianMilliseconds(s) / 1000.0);
    double sum = 0.0;
    for (double t : times.total) sum += t;
    return {{"median", median(times.total)}, {"mean", times.total.empty() ? 0.0 : sum / static_cast<double>(times.total.size())}, {"stages", stages}};
}

Json ledgerJson(const EnergyLedger::Summary& s)
{
    Json changes = Json::object();
    for (int i = 0; i < sim::kEnergyChanges; ++i) changes[std::string(sim::kEnergyChangeNames[i])] = s.changes.of[i];
    return {{"changes", changes},
            {"largest_kinetic", s.largestKinetic},
            {"unbooked", s.largestKinetic > 0.0 ? s.largestUnbooked / s.largestKinetic : 0.0}};
}

Json reportJson(const RunSummary& s)
{
    const double steps = static_cast<double>(std::max<std::int64_t>(1, s.steps));
    Json json = {
        {"scene", s.scene}, {"title", s.title}, {"variant", s.variant}, {"label", s.label}, {"status", kStatusNames[static_cast<int>(s.status)]}};
    if (!s.reason.empty()) json["reason"] = s.reason;
    json.update({{"steps", s.steps},
                 {"frames", s.frames},
                 {"simulated_time", s.simulatedTime},
                 {"wall_seconds", s.wallSeconds},
                 {"seconds_per_step", secondsPerStepJson(s.times)},
                 {"peak_memory_mb", s.peakMemoryMegabytes},
                 {"particles", s.particles},
                 {"particles_mean", s.particleSum / steps},
                 {"cells", s.cells},
                 {"cell", s.cell},
                 {"iterations", {{"mean", static_cast<double>(s.totalIterations) / steps}, {"max", s.maxIterations}, {"total", s.totalIterations}}},
                 {"fabric",
                  {{"vertices", s.fabricVertices},
                   {"elements", s.fabricElements},
                   {"mass", s.fabricMass},
                   {"iterations_mean", static_cast<double>(s.fabricIterations) / steps},
                   {"halvings", s.fabricHalvings},
                   {"shortened", s.fabricShortened},
                   {"least_taken_fraction", s.leastTakenFraction}}},
                 {"taken_back", s.takenBack},
                 {"largest_cfl", s.largestCfl},
                 {"mass_error", s.massError},
                 {"state_hash", s.stateHash},
                 {"content_hash", s.contentHash}});
    if (s.forces.time > 0.0) json["forces"] = forcesJson(s.forceNames, s.forces);
    if (s.energyLedger) json["energy_ledger"] = ledgerJson(*s.energyLedger);
    json["provenance"] = Json::parse(s.provenance);
    return json;
}

}  // namespace

void StageTimes::add(const sim::StepReport& step)
{
    total.push_back(step.seconds());
    for (int s = 0; s < sim::kStages; ++s)
        if (step.stageRan[s]) stages[s].push_back(step.stageSeconds[s]);
}

double StageTimes::medianMilliseconds(int stage) const { return 1000.0 * median(stages[stage]); }

std::string stageTable(const StageTimes& times)
{
    std::string table = fmt::format("{:<20}{:>12}\n", "stage", "median ms");
    for (int s = 0; s < sim::kStages; ++s)
        table +=
            fmt::format("{:<20}{:>12}\n", sim::kStageNames[s], times.stages[s].empty() ? "-" : fmt::format("{:.3f}", times.medianMilliseconds(s)));
    return table + fmt::format("{:<20}{:>12.3f}\n", "step", 1000.0 * median(times.total));
}

std::optional<RunResult> readReport(const std::filesystem::path& folder)
try {
    const auto json = nlohmann::json::parse(readWhole(folder / "report.json"));
    RunResult r;
    r.variant = json.at("variant");
    r.label = json.at("label");
    r.status = json.at("status");
    r.reason = json.value("reason", "");
    r.contentHash = json.at("content_hash");
    r.largestCfl = json.at("largest_cfl");
    r.massError = json.at("mass_error");
    r.stateHash = json.at("state_hash");
    r.steps = json.at("steps");
    r.frames = json.at("frames");
    r.particles = json.at("particles");
    r.simulatedTime = json.at("simulated_time");
    r.wallSeconds = json.at("wall_seconds");
    r.secondsPerStep = json.at("seconds_per_step").at("median");
    r.meanSecondsPerStep = json.at("seconds_per_step").at("mean");
    r.meanParticles = json.at("particles_mean");
    r.fabricVertices = json.at("fabric").at("vertices");
    r.fabricElements = json.at("fabric").at("elements");
    r.peakMemoryMegabytes = json.at("peak_memory_mb");
    r.meanIterations = json.at("iterations").at("mean");
    r.maxIterations = json.at("iterations").at("max");
    for (int s = 0; s < sim::kStages; ++s) {
        const auto& value = json.at("seconds_per_step").at("stages").at(std::string(sim::kStageNames[s]));
        if (!value.is_null()) r.stageSeconds[s] = value.get<double>();
    }
    return r;
} catch (const std::exception&) {
    return std::nullopt;
}

Reports::Reports(const std::filesystem::path& folder, const SceneSetup& setup, std::string contentHash, std::string provenance)
    : folder_(folder), begin_(setup.scene.settings.time.start), gravity_(setup.scene.settings.gravity)
{
    const auto& output = setup.pictures.output;
    if (output.stats) steps_.emplace(folder / "steps.jsonl");
    if (output.energy) energy_.emplace(folder / "energy.csv");
    if (output.ledger) energyLedger_.emplace(folder / "energy_ledger.csv");
    if (energy_) energy_->add(kEnergyHeader);
    if (const auto probes = readProbes(setup)) probes_.emplace(folder / kProbesFile, *probes, begin_);
    describe(setup, std::move(contentHash), std::move(provenance));
}

Reports::Reports(const std::filesystem::path& folder, const SceneSetup& setup, std::string contentHash, std::string provenance,
                 const LogsSoFar& before, double time)
    : folder_(folder),
      summary_(before.summary),
      begin_(setup.scene.settings.time.start),
      before_(before.summary.wallSeconds),
      gravity_(setup.scene.settings.gravity)
{
    const auto& output = setup.pictures.output;
    if (output.stats) steps_.emplace(folder / "steps.jsonl", before.stepsBytes);
    if (output.energy) energy_.emplace(folder / "energy.csv", before.energyBytes);
    if (output.ledger)
        energyLedger_.emplace(folder / "energy_ledger.csv", before.ledgerBytes, before.summary.energyLedger.value_or(EnergyLedger::Summary()));
    if (const auto probes = readProbes(setup)) probes_.emplace(folder / kProbesFile, *probes, begin_, time, before.probesBytes, before.sinceReading);
    describe(setup, std::move(contentHash), std::move(provenance));
}

void Reports::describe(const SceneSetup& setup, std::string contentHash, std::string provenance)
{
    summary_.scene = setup.scene.name;
    summary_.title = setup.scene.title;
    summary_.variant = setup.variant;
    summary_.label = setup.label;
    summary_.cell = setup.scene.settings.cell;
    summary_.forceNames = ForceNames(setup.scene);
    summary_.contentHash = std::move(contentHash);
    summary_.provenance = std::move(provenance);
    writeReport();
}

double Reports::wallSeconds() const { return before_ + secondsSince(start_); }

LogsSoFar Reports::soFar() const
{
    LogsSoFar soFar = {.summary = summary_};
    soFar.summary.wallSeconds = wallSeconds();
    if (energyLedger_) soFar.summary.energyLedger = energyLedger_->summary();
    if (steps_) soFar.stepsBytes = steps_->size();
    if (energy_) soFar.energyBytes = energy_->size();
    if (energyLedger_) soFar.ledgerBytes = energyLedger_->size();
    if (probes_) soFar.probesBytes = probes_->size();
    if (probes_) soFar.sinceReading = probes_->sinceReading();
    return soFar;
}

void Reports::initial(const Steppable& simulation)
{
    const sim::State& state = simulation.state();
    const sim::Fabric& fabric = simulation.fabric();
    const sim::Energies energies = simulation.energies();
    if (probes_) probes_->initial(simulation);
    if (energyLedger_) energyLedger_->initial(state.time, energies);
    summary_.particles = state.liquid.count;
    summary_.fabricVertices = fabric.vertexCount();
    summary_.fabricMass = std::accumulate(fabric.mass.begin(), fabric.mass.end(), 0.0);
    summary_.fabricElements = fabric.edges.size() + fabric.faces.size();
    if (energy_)
        energy_->add(energyRow(state.time, energies, state.liquid.count, state.ledger.emittedMass - state.ledger.leftMass,
                               publishedEnergy(state.fabric, energies, gravity_)));
}

void Reports::step(const Steppable& simulation, const sim::StepReport& report)
{
    const sim::State& state = simulation.state();
    const sim::Forces& forces = simulation.forces();
    if (probes_) probes_->step(simulation, report.isReflected);
    if (steps_) steps_->add(stepLine(state, report, summary_.forceNames, forces));
    summary_.forces.add(forces, report.isReflected);
    if (energyLedger_) energyLedger_->step(state.time, report);
    if (energy_ && !report.isReflected)
        energy_->add(
            energyRow(state.time, report.energies, report.particles, report.liquidMass, publishedEnergy(state.fabric, report.energies, gravity_)));

    ++summary_.steps;
    summary_.simulatedTime = state.time - begin_;
    summary_.times.add(report);
    summary_.particles = report.particles;
    summary_.cells = report.liquidCells;
    summary_.particleSum += static_cast<double>(report.particles);
    summary_.totalIterations += report.pressure.iterations;
    summary_.maxIterations = std::max<std::int64_t>(summary_.maxIterations, report.pressure.iterations);
    summary_.fabricIterations += report.fabric.iterations;
    summary_.fabricHalvings += report.fabric.halvings;
    summary_.fabricShortened += report.fabric.shortened;
    summary_.leastTakenFraction = std::min(summary_.leastTakenFraction, report.fabric.takenFraction);
    summary_.takenBack += report.takenBack;
    summary_.largestCfl = std::max(summary_.largestCfl, report.cfl);
    const double entered = state.ledger.emittedMass;
    if (entered > 0.0)
        summary_.massError =
            std::max(summary_.massError, std::abs(entered - state.ledger.leftMass - report.liquidMass - report.absorbedMass) / entered);
}

void Reports::finish(RunStatus status, const std::string& reason, const std::string& stateHash)
{
    summary_.status = status;
    summary_.reason = reason;
    summary_.stateHash = stateHash;
    writeReport();
}

void Reports::writeReport()
{
    summary_.wallSeconds = wallSeconds();
    summary_.peakMemoryMegabytes = peakMemoryMegabytes();
    if (energyLedger_) summary_.energyLedger = energyLedger_->summary();
    writeWhole(folder_ / "report.json", reportJson(summary_).dump(2) + '\n');
}

}  // namespace app
