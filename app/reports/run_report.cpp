#include "app/reports/run_report.h"

#include "app/backends.h"
#include "app/reports/report_json.h"
#include "app/reports/step_logs.h"
#include "app/system/peak_memory.h"
#include "app/system/statistics.h"
#include "app/system/stopwatch.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace app {

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
        if (!times.stages[s].empty()) table += fmt::format("{:<20}{:>12.3f}\n", sim::kStageNames[s], times.medianMilliseconds(s));
    return table + fmt::format("{:<20}{:>12.3f}\n", "step", 1000.0 * median(times.total));
}

Reports::Reports(const std::filesystem::path& folder, const LoadedScene& setup, std::string contentHash, std::string provenance)
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

Reports::Reports(const std::filesystem::path& folder, const LoadedScene& setup, std::string contentHash, std::string provenance,
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

void Reports::describe(const LoadedScene& setup, std::string contentHash, std::string provenance)
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

void Reports::initial(const SimulationHandle& simulation)
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
    if (energy_) energy_->add(energyRow(state, energies, state.ledger.emittedMass - state.ledger.leftMass, gravity_));
}

void Reports::step(const SimulationHandle& simulation, const sim::StepReport& report)
{
    const sim::State& state = simulation.state();
    const sim::Forces& forces = simulation.forces();
    if (probes_) probes_->step(simulation, report.isReflected);
    if (steps_) steps_->add(stepLine(state, report, summary_.forceNames, forces));
    summary_.forces.add(forces, report.isReflected);
    if (energyLedger_) energyLedger_->step(state.time, report);
    if (energy_ && !report.isReflected) energy_->add(energyRow(state, report.energies, report.liquidMass, gravity_));

    ++summary_.steps;
    summary_.simulatedTime = state.time - begin_;
    summary_.times.add(report);
    summary_.particles = report.particles;
    summary_.cells = report.liquidCells;
    summary_.particleSum += static_cast<double>(report.particles);
    summary_.totalIterations += report.pressure.iterations;
    summary_.maxIterations = std::max<std::int64_t>(summary_.maxIterations, report.pressure.iterations);
    summary_.fabricIterations += report.fabric.iterations;
    summary_.fabricSubstepSplits += report.fabric.substepSplits;
    summary_.fabricTruncatedSubsteps += report.fabric.truncatedSubsteps;
    summary_.leastAcceptedFraction = std::min(summary_.leastAcceptedFraction, report.fabric.acceptedFraction);
    summary_.rejectedSteps += report.rejectedSteps;
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
    writeWhole(folder_ / "report.json", reportText(summary_));
}

}  // namespace app
