#include "app/lab/timing/bench.h"

#include "app/provenance/provenance.h"
#include "app/system/statistics.h"
#include "sim/core/check.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <string_view>
#include <thread>

namespace app {

namespace {

constexpr int kWholeStep = sim::kStages;

std::string_view stageName(int stage) { return stage == kWholeStep ? "step" : sim::kStageNames[stage]; }

/// Steps end on frame times, as in a run, so that the states are a run's.
double nextFrameTime(const LoadedScene& setup, double time)
{
    constexpr double kRounding = 1.0e-9;
    const auto& output = setup.pictures.output;
    const double start = setup.scene.settings.time.start;
    return start + (std::floor((time - start) / output.every + kRounding) + 1.0) * output.every;
}

std::vector<double> allRepeats(const BenchResult& result, int stage)
{
    std::vector<double> values;
    for (const auto& repeat : result.repeats) values.push_back(repeat.milliseconds[stage]);
    return values;
}

void addStep(const sim::StepReport& report, double share, BenchRepeat& repeat)
{
    for (int s = 0; s < sim::kStages; ++s) {
        repeat.milliseconds[s] += 1000.0 * share * report.stageSeconds[s];
        repeat.ran[s] = repeat.ran[s] || report.stageRan[s];
    }
    repeat.milliseconds[kWholeStep] += 1000.0 * share * report.seconds();
    repeat.ran[kWholeStep] = true;
    repeat.meanIterations += share * report.pressure.iterations;
    repeat.particles = report.particles;
}

}  // namespace

double BenchResult::minimum(int stage) const { return std::ranges::min(allRepeats(*this, stage)); }
double BenchResult::middle(int stage) const { return median(allRepeats(*this, stage)); }

BenchRepeat benchOnce(const LoadedScene& setup, const Backends& backends, const Options& options)
{
    const auto simulation = backends.startSimulation(setup);
    const sim::State& state = simulation->state();
    for (int n = 0; n < options.warmupSteps; ++n) simulation->step(nextFrameTime(setup, state.time));
    BenchRepeat repeat;
    for (int n = 0; n < options.steps; ++n) addStep(simulation->step(nextFrameTime(setup, state.time)), 1.0 / options.steps, repeat);
    repeat.stateHash = simulation->stateHash();
    return repeat;
}

bool sameState(const std::vector<BenchResult>& results)
{
    const auto hash = results.front().repeats.front().stateHash;
    for (const auto& result : results)
        for (const auto& repeat : result.repeats)
            if (repeat.stateHash != hash) return false;
    return true;
}

std::string benchTable(const std::vector<BenchResult>& results)
{
    std::string table = fmt::format("{:<20}", "ms per step");
    for (const auto& result : results)
        table += fmt::format("{:>22}", fmt::format("{} threads: min", result.threads)) + fmt::format("{:>10}", "median");
    table += '\n';
    for (int s = 0; s <= kWholeStep; ++s) {
        table += fmt::format("{:<20}", stageName(s));
        for (const auto& result : results)
            table += result.ran(s) ? fmt::format("{:>22.3f}{:>10.3f}", result.minimum(s), result.middle(s)) : fmt::format("{:>22}{:>10}", "-", "-");
        table += '\n';
    }
    const auto& first = results.front().repeats.front();
    return table +
           fmt::format("particles {}, iterations per step {:.1f}, state {}\n", first.particles, first.meanIterations, hexDigits(first.stateHash));
}

std::string benchCsv(const std::string& scene, const Options& options, const std::vector<BenchResult>& results)
{
    std::string csv = "scene,threads,stage,min_ms,median_ms,steps,repeats,particles,iterations_per_step,state_hash,version\n";
    for (const auto& result : results)
        for (int s = 0; s <= kWholeStep; ++s) {
            if (!result.ran(s)) continue;
            const auto& first = result.repeats.front();
            csv += fmt::format("{},{},{},{:.4f},{:.4f},{},{},{},{:.2f},{},{}\n", scene, result.threads, stageName(s), result.minimum(s),
                               result.middle(s), options.steps, result.repeats.size(), first.particles, first.meanIterations,
                               hexDigits(first.stateHash), DRENCH_VERSION);
        }
    return csv;
}

std::string machineOf(const Options& options) { return options.machine.empty() ? machineName() : options.machine; }

std::filesystem::path machineFolder(const Options& options) { return options.results / machineOf(options); }

std::string machineName()
{
    std::string slug;
    for (const unsigned char c : processorName() + fmt::format(" {} cores", std::thread::hardware_concurrency())) {
        if (std::isalnum(c) != 0) slug += static_cast<char>(std::tolower(c));
        else if (!slug.empty() && slug.back() != '_') slug += '_';
    }
    return slug;
}

}  // namespace app
