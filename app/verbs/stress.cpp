#include "app/lab/random/random_stress.h"
#include "app/lab/stability/stability_report.h"
#include "app/reports/output_folder.h"
#include "app/runs/paper_runs.h"
#include "app/system/atomic_files.h"
#include "app/system/data_folder.h"
#include "app/system/gnuplot.h"
#include "app/system/interrupt.h"
#include "app/verbs/verbs.h"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <cmath>

namespace app {

namespace {

int stressRandomScenes(const Options& options)
{
    const auto folder = options.out.empty() ? std::filesystem::path("out/stress") / fmt::format("random_{}", options.seed) : options.out;
    makeFolder(folder);
    const RandomStress stress{.seed = options.seed,
                              .first = options.firstScene,
                              .count = options.randomScenes,
                              .width = options.threads,
                              .limitSeconds = options.limitSeconds,
                              .set = options.sets,
                              .folder = folder,
                              .stopWanted = stopWanted};
    const auto results = runRandomStress(stress);
    writeWhole(folder / "random.csv", randomStressTable(results));
    const std::string report = randomStressReport(stress, results);
    writeWhole(folder / "report.md", report);
    fmt::print("\n{}\n{}\n", report, (folder / "report.md").string());
    const auto faults = std::ranges::count_if(results, [](const RandomStressResult& result) { return isFault(result.outcome.ending); });
    if (faults > 0) spdlog::error("{} of {} random scenes crashed, were refused, not finite or undiagnosed", faults, results.size());
    return faults > 0 || stopWanted() ? 1 : 0;
}

constexpr double kPublishedStep = 2.0e-4;  // [s]

std::filesystem::path sceneFile(const std::string& name)
{
    if (std::filesystem::exists(name)) return name;
    const auto file = std::filesystem::path("scenes") / (name + ".yaml");
    return std::filesystem::exists(file) ? file : dataFolder("scenes") / (name + ".yaml");
}

std::vector<std::string> sceneNames(const Options& options)
{
    if (!options.scenes.empty()) return options.scenes;
    std::vector<std::string> names;
    for (const PaperScene& scene : paperScenes()) names.push_back(scene.name);
    return names;
}

std::vector<double> stepsOf(const Options& options)
{
    std::vector<double> factors = {0.5, 1.0, 2.0, 5.0, 10.0, 20.0};
    if (options.quick) factors = {1.0, 5.0, 20.0};
    if (!options.stepFactors.empty()) factors = options.stepFactors;
    std::ranges::sort(factors);
    for (double& factor : factors) factor *= kPublishedStep;
    return factors;
}

/// A whole number of the longest steps, of the published and of half the published ones.
double wholeDuration(double duration, const std::vector<double>& steps)
{
    const double longest = std::max(20.0 * kPublishedStep, steps.back());
    return longest * std::max(1.0, std::round(duration / longest));
}

StabilityResult mapOf(const std::string& scene, const Options& options, const Backends& backends, const std::filesystem::path& folder)
{
    constexpr double kFirstMoments = 0.32, kQuick = 0.24;  // [s]: so long until water and fabric of the paper's splashes have met
    const auto file = sceneFile(scene);
    const LoadedScene setup = backends.loadScene({file.string(), "", options.sets});
    const double whole = setup.scene.settings.time.duration;
    const double wanted = options.duration > 0.0 ? options.duration : std::min(whole, options.quick ? kQuick : kFirstMoments);
    std::vector<StabilityMethod> methods = stabilityMethods(setup, options.methods);
    if (!options.parameter.empty()) methods = withParameter(methods, setup, options.parameter, options.parameterFactors);
    const std::vector<double> steps = stepsOf(options);
    const StabilityMap map{.scene = file.string(),
                           .sets = options.sets,
                           .methods = methods,
                           .steps = steps,
                           .duration = wholeDuration(wanted, steps),
                           .folder = folder / setup.scene.name,
                           .largestOnly = options.largestOnly,
                           .width = options.threads,
                           .limitSeconds = options.limitSeconds,
                           .stopWanted = stopWanted};
    const std::string title = setup.scene.title.empty() ? setup.scene.name : setup.scene.title;
    return {setup.scene.name, title, map, {}};
}

int mapStability(const Options& options, const Backends& backends)
{
    const auto folder = options.out.empty() ? std::filesystem::path("out/stress") : options.out;
    // All are loaded, and so validated, before the first one starts.
    std::vector<StabilityResult> results;
    for (const std::string& scene : sceneNames(options)) results.push_back(mapOf(scene, options, backends, folder));
    for (StabilityResult& result : results) {
        fmt::print("{}\n", result.title);
        result.rows = runStabilityMap(result.map);
        if (canPlot()) plotStabilityMap(result);
        writeWhole(folder / "stability.md", stabilityReport(results, canPlot()));
        if (!stopWanted()) continue;
        spdlog::warn("stopped: the same command goes on where it was");
        return 1;
    }
    fmt::print("{}\n", (folder / "stability.md").string());
    return 0;
}

}  // namespace

int runVerbStress(const Options& options, const Backends& backends)
{
    return options.randomScenes > 0 ? stressRandomScenes(options) : mapStability(options, backends);
}

}  // namespace app
