#include "app/lab/precision/precision_run.h"

#include "app/lab/checks/run_and_read.h"
#include "app/system/statistics.h"
#include "app/system/thread_limit.h"
#include "sim/core/check.h"

#include <fmt/format.h>

#include <cmath>
#include <limits>

namespace app {

namespace {

using Choices = std::vector<PrecisionChoice>;
using AllReadings = std::vector<std::vector<Sample>>;

LoadedScene load(const std::string& file, const std::vector<std::string>& sets, const Backends& backends)
{
    LoadedScene setup = backends.loadScene({.file = file, .variant = "", .sets = sets});
    if (!readPrecision(setup)) throw sim::InputError(fmt::format("{}: has no section precision, which tells what to run it with", file));
    return setup;
}

/// The changes of a combination, the step by the cell where it is told in cells.
std::vector<std::string> setsOf(const std::string& file, const std::array<const PrecisionChoice*, 4>& of, const Backends& backends)
{
    std::vector<std::string> sets;
    for (const PrecisionChoice* choice : of) sets.insert(sets.end(), choice->sets.begin(), choice->sets.end());
    const PrecisionChoice& step = *of[3];
    if (step.cells <= 0.0) return sets;
    const LoadedScene setup = load(file, sets, backends);
    const double speed = readPrecision(setup)->speed;
    if (!(speed > 0.0))
        throw sim::InputError(fmt::format("{}: precision.speed is missing: how fast is liquid that crosses so many cells per step?", file));
    sets.push_back(fmt::format("time.dt={:.12g}", step.cells * setup.scene.settings.cell / speed));
    return sets;
}

std::vector<Check> checksAgainst(const Precision& precision, const AllReadings& converged)
{
    std::vector<Check> checks = precision.errors;
    for (std::size_t i = 0; i < checks.size() && i < converged.size(); ++i)
        if (!checks[i].expect && checks[i].table.empty())
            for (const Sample& reading : converged[i]) checks[i].table.push_back({.at = reading.at, .value = reading.value});
    return checks;
}

/// What one run reads.
struct Outcome {
    AllReadings errors;
    std::vector<Sample> energies;
    RunReadings followed;
};

/// @param checks  that look at the section's measures
Outcome runOnce(const LoadedScene& setup, const Precision& precision, const std::vector<Check>& checks, const Backends& backends,
                const std::function<bool()>& stopWanted)
{
    const auto simulation = backends.startSimulation(setup);
    precision.measures->look(*simulation);
    Outcome outcome;
    outcome.errors.resize(checks.size());
    const auto read = [&](double time) {
        for (std::size_t i = 0; i < checks.size(); ++i) readNow(checks[i], time, outcome.errors[i]);
        if (precision.energy) outcome.energies.push_back({time, (*precision.energy)(std::array{time}), 0.0});
        precision.measures->startInterval();
    };
    outcome.followed = runAndRead(
        *simulation, setup.scene, precision.every, read, [&] { precision.measures->afterStep(); }, stopWanted);
    return outcome;
}

/// Viscosity by the energies after the start, whose particles the grid has not yet smoothed.
double viscosityOf(const Precision& precision, const std::vector<Sample>& energies)
{
    if (precision.decay <= 0.0 || energies.empty()) return std::numeric_limits<double>::quiet_NaN();
    return statisticOf(Statistic::Rate, std::span(energies).subspan(1)) / precision.decay;
}

/// Root mean square of the errors.
double errorOf(const std::vector<Check>& checks, const AllReadings& readings)
{
    double sum = 0.0;
    for (std::size_t i = 0; i < checks.size(); ++i) sum += std::pow(errorOf(checks[i], readings[i]), 2);
    return std::sqrt(sum / static_cast<double>(checks.size()));
}

PrecisionRow rowOf(const PrecisionRun& run, int threads, int repeats)
{
    const sim::Settings& settings = run.setup.scene.settings;
    PrecisionRow row;
    row.scene = run.scene;
    row.names = run.names;
    row.modes = run.setup.scene.sources.empty() ? 0 : settings.transfer.modeCount();
    row.dt = settings.time.dt;
    row.cell = settings.cell;
    row.threads = threads;
    row.repeats = repeats;
    row.settings = run.settings;
    return row;
}

}  // namespace

std::string settingsOf(const LoadedScene& setup)
{
    LoadedScene asked = setup;
    asked.identity += readPrecision(setup)->question;
    return contentHash(asked, false, 0);
}

std::vector<PrecisionRun> precisionRuns(const std::string& file, const Backends& backends, bool isQuick)
{
    const Precision precision = *readPrecision(load(file, {}, backends));
    const auto wanted = [&](Choices choices) {
        std::erase_if(choices, [&](const PrecisionChoice& choice) { return isQuick && !choice.isQuick; });
        return choices;
    };
    std::vector<PrecisionRun> runs;
    for (const auto& resolution : wanted(precision.resolutions))
        for (const auto& method : wanted(precision.methods))
            for (const auto& integrator : wanted(precision.integrators))
                for (const auto& step : wanted(precision.steps)) {
                    const PrecisionNames names{method.name, integrator.name, step.name, resolution.name};
                    LoadedScene setup = load(file, setsOf(file, {&resolution, &method, &integrator, &step}, backends), backends);
                    const std::string settings = settingsOf(setup);
                    runs.push_back({setup.scene.name, names, std::move(setup), settings});
                }
    return runs;
}

LoadedScene convergedSetup(const std::string& file, const Backends& backends)
{
    return load(file, readPrecision(load(file, {}, backends))->converged, backends);
}

AllReadings readErrors(const LoadedScene& setup, const Backends& backends, const std::function<bool()>& stopWanted)
{
    const Precision precision = *readPrecision(setup);
    std::vector<Check> checks = precision.errors;
    for (Check& check : checks) check.statistic = Statistic::Last;  // nothing to compare with yet: all readings are kept
    return runOnce(setup, precision, checks, backends, stopWanted).errors;
}

PrecisionRow measurePrecision(const PrecisionRun& run, const AllReadings& converged, int threads, int repeats, const Backends& backends,
                              const std::function<bool()>& stopWanted)
{
    const Precision precision = *readPrecision(run.setup);
    const std::vector<Check> checks = checksAgainst(precision, converged);
    PrecisionRow row = rowOf(run, threads, repeats);
    std::vector<double> seconds;
    try {
        for (int n = 0; n < repeats; ++n) {
            const Outcome outcome = withThreads(threads, [&] { return runOnce(run.setup, precision, checks, backends, stopWanted); });
            seconds.push_back(outcome.followed.stepSeconds);
            row.steps = outcome.followed.steps;
            row.cfl = outcome.followed.largestCfl;
            row.error = errorOf(checks, outcome.errors);
            row.energyLeft = statisticOf(Statistic::Last, outcome.energies) / statisticOf(Statistic::First, outcome.energies);
            row.viscosity = viscosityOf(precision, outcome.energies);
        }
        row.dt = run.setup.scene.settings.time.duration / static_cast<double>(std::max<std::int64_t>(1, row.steps));
    } catch (const sim::RunError& error) {
        if (stopWanted()) throw;
        row.outcome = error.what();
        row.error = row.energyLeft = row.viscosity = std::numeric_limits<double>::quiet_NaN();
    }
    row.wallSeconds = median(seconds);
    return row;
}

}  // namespace app
