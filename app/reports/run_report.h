#pragma once

#include "app/probes/probe_log.h"
#include "app/readings/force_log.h"
#include "app/reports/energy_ledger.h"
#include "app/scene/loaded_scene.h"
#include "app/system/atomic_files.h"
#include "sim/state.h"

#include <array>
#include <chrono>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace app {

enum class RunStatus { Running, Done, Interrupted, Failed };

/// Seconds of every step by stage, in the order of sim::kStageNames.
struct StageTimes {
    std::vector<double> total;                             ///< one per step [s]
    std::array<std::vector<double>, sim::kStages> stages;  ///< one per step in which the stage ran [s]

    void add(const sim::StepReport& step);
    double medianMilliseconds(int stage) const;  ///< median time [ms] of the steps in which it ran
};

/// "stage, median ms" as lines of text, of stages that ran.
std::string stageTable(const StageTimes& times);

/// What report.json says about a run.
struct RunSummary {
    std::string scene, variant, label, title, contentHash;
    RunStatus status = RunStatus::Running;
    std::string reason;  ///< why it did not get to its end, one line
    std::int64_t steps = 0, frames = 0;
    double simulatedTime = 0.0;  ///< [s]
    double wallSeconds = 0.0, peakMemoryMegabytes = 0.0;
    StageTimes times;
    std::size_t particles = 0, cells = 0;  ///< numbers of particles and cells at the end
    double particleSum = 0.0;              ///< over the steps
    std::int64_t totalIterations = 0, maxIterations = 0;
    std::size_t fabricVertices = 0, fabricElements = 0;  ///< elements: edges of yarns and faces of cloth
    double fabricMass = 0.0;                             ///< dry [g]
    double cell = 0.0;                                   ///< [cm]
    std::int64_t fabricIterations = 0, fabricSubstepSplits = 0, fabricTruncatedSubsteps = 0;
    double leastAcceptedFraction = 1.0;  ///< least share of the moves that the fabric's Newton asked for, over the steps [-]
    std::int64_t rejectedSteps = 0;      ///< steps that turned out bad and were made again
    double largestCfl = 0.0;
    double massError = 0.0;  ///< (entered − left − there) / entered, largest over the steps [-]
    ForceNames forceNames;
    ForceTotals forces;
    std::optional<EnergyLedger::Summary> energyLedger;  ///< summary of the ledger, where it was asked for
    std::string stateHash;
    std::string provenance;  ///< see provenanceOf()
};

/// The numbers of report.json, as a comparison reads them back.
struct RunResult {
    std::string variant, label, status, reason, contentHash, stateHash;
    std::int64_t steps = 0, frames = 0, particles = 0, maxIterations = 0, fabricVertices = 0, fabricElements = 0;
    double simulatedTime = 0.0, wallSeconds = 0.0, peakMemoryMegabytes = 0.0, meanIterations = 0.0;
    double largestCfl = 0.0, massError = 0.0;                      ///< largest CFL number and error of mass, as in RunSummary
    double secondsPerStep = 0.0, meanSecondsPerStep = 0.0;         ///< the first is the median
    double meanParticles = 0.0;                                    ///< mean number of particles of liquid, over the steps
    std::array<std::optional<double>, sim::kStages> stageSeconds;  ///< medians; nothing for a stage that never ran
};

/// Nothing where there is no report or none that can be read.
std::optional<RunResult> readReport(const std::filesystem::path& folder);

/// How far the logs of a run have come.
struct LogsSoFar {
    RunSummary summary;
    std::uintmax_t stepsBytes = 0, energyBytes = 0, ledgerBytes = 0,
                   probesBytes = 0;    ///< sizes of steps.jsonl, energy.csv, energy_ledger.csv, probes.csv
    IntervalTotals sinceReading = {};  ///< forces and pressures since the last reading of probes
};

/// The growing logs of one run, steps.jsonl and energy.csv where the scene wants them, and its report.json. What is
/// written is in the files at once, so that a run can be followed, and read after it was cut off.
class Reports {
 public:
    /// Writes a report.json that says "running".
    Reports(const std::filesystem::path& folder, const LoadedScene& setup, std::string contentHash, std::string provenance);

    /// Goes on with the logs of a run that is resumed in its folder: what its logs say of steps later than `time` [s] is forgotten.
    Reports(const std::filesystem::path& folder, const LoadedScene& setup, std::string contentHash, std::string provenance, const LogsSoFar& before,
            double time);

    /// The state before the first step: the first rows of energy.csv and probes.csv.
    void initial(const SimulationHandle& simulation);
    void step(const SimulationHandle& simulation, const sim::StepReport& report);
    void frameDone() { ++summary_.frames; }

    /// Write report.json as it stands; `reason` for runs that did not get to their end.
    void finish(RunStatus status, const std::string& reason, const std::string& stateHash);

    const RunSummary& summary() const { return summary_; }
    LogsSoFar soFar() const;

 private:
    void describe(const LoadedScene& setup, std::string contentHash, std::string provenance);
    double wallSeconds() const;
    void writeReport();
    const std::filesystem::path folder_;
    std::optional<LineFile> steps_, energy_;    ///< logs that the scene's output.data asks for
    std::optional<EnergyLedger> energyLedger_;  ///< empty unless the scene asks for it
    std::optional<ProbeLog> probes_;            ///< log of the probes, where the scene has some
    RunSummary summary_;
    double begin_ = 0.0;   ///< [s]
    double before_ = 0.0;  ///< wall seconds of the run until it was gone on with
    sim::Vec3 gravity_;    ///< [cm/s^2]
    std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

}  // namespace app
