#include "app/reports/report_json.h"

#include "app/system/statistics.h"
#include "sim/renamed.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>

namespace app {

namespace {

using Json = nlohmann::ordered_json;

std::string_view nameOf(RunStatus status)
{
    switch (status) {
        case RunStatus::Running: return "running";
        case RunStatus::Done: return "done";
        case RunStatus::Interrupted: return "interrupted";
        default: return "failed";
    }
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
            {"residual", s.largestKinetic > 0.0 ? s.largestResidual / s.largestKinetic : 0.0}};
}

/// The value at a path with slashes between, under the name that it has now or had before.
const nlohmann::json& valueAt(const nlohmann::json& json, const std::string& path)
{
    using Pointer = nlohmann::json::json_pointer;
    const Pointer now(fmt::format("/{}", path));
    return json.at(json.contains(now) ? now : Pointer(fmt::format("/{}", sim::formerName(path))));
}

}  // namespace

std::string reportText(const RunSummary& s)
{
    const double steps = static_cast<double>(std::max<std::int64_t>(1, s.steps));
    Json json = {{"scene", s.scene}, {"title", s.title}, {"variant", s.variant}, {"label", s.label}, {"status", nameOf(s.status)}};
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
                   {"substep_splits", s.fabricSubstepSplits},
                   {"truncated_substeps", s.fabricTruncatedSubsteps},
                   {"least_accepted_fraction", s.leastAcceptedFraction}}},
                 {"rejected_steps", s.rejectedSteps},
                 {"largest_cfl", s.largestCfl},
                 {"mass_error", s.massError},
                 {"state_hash", s.stateHash},
                 {"content_hash", s.contentHash}});
    if (s.forces.time > 0.0) json["forces"] = forcesJson(s.forceNames, s.forces);
    if (s.energyLedger) json["energy_ledger"] = ledgerJson(*s.energyLedger);
    json["provenance"] = Json::parse(s.provenance);
    return json.dump(2) + '\n';
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
        const auto& value = valueAt(json, "seconds_per_step/stages/" + std::string(sim::kStageNames[s]));
        if (!value.is_null()) r.stageSeconds[s] = value.get<double>();
    }
    return r;
} catch (const std::exception&) {
    return std::nullopt;
}

}  // namespace app
