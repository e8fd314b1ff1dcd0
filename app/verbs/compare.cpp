#include "app/runs/compare.h"

#include "app/ensemble/ensemble_products.h"
#include "app/reports/output_folder.h"
#include "app/system/interrupt.h"
#include "app/verbs/verbs.h"
#include "sim/core/check.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <set>

namespace app {

namespace {

/// Labels that tell ensembles apart: those of their runs, or else their folders.
void tellApart(std::vector<Ensemble>& ensembles, const std::vector<std::filesystem::path>& folders)
{
    std::set<std::string> labels;
    for (const Ensemble& ensemble : ensembles) labels.insert(ensemble.label);
    if (labels.size() == ensembles.size()) return;
    for (std::size_t n = 0; n < ensembles.size(); ++n) ensembles[n].label = folders[n].lexically_normal().string();
}

int compareEnsembles(const Options& options)
{
    if (options.from.size() < 2) throw sim::InputError(fmt::format("--from {}: give another ensemble, too", options.from.front().string()));
    std::vector<Ensemble> ensembles;
    for (const std::filesystem::path& folder : options.from) {
        ensembles.push_back(readEnsemble(folder));
        const Ensemble& ensemble = ensembles.back();
        if (ensemble.missing > 0) spdlog::warn("{}: {} runs that are not done do not count", folder.string(), ensemble.missing);
        if (ensemble.runs.size() < 2) throw sim::InputError(fmt::format("{}: two runs at least must be done to tell their spread", folder.string()));
    }
    tellApart(ensembles, options.from);
    makeFolder(options.out);
    std::vector<std::string> labels;
    for (const Ensemble& ensemble : ensembles) labels.push_back(ensemble.label);
    fmt::print("{}\n{}\n", writeDifferences(ensembles, fmt::format("{}", fmt::join(labels, ", ")), options.confidence, options.out),
               (options.out / "compare.csv").string());
    return 0;
}

/// Runs that are there already, or ensembles.
int compareFolders(const Options& options, const Backends& backends)
{
    if (std::ranges::any_of(options.from, isEnsemble)) return compareEnsembles(options);
    const std::vector<ComparedRun> runs = storedRuns(options.from, options.sets, backends);
    makeFolder(options.out);
    makeComparisonOutputs(runs, {runs.front().setup.pictures, true, options.video, options.out}, backends, stopWanted);
    return stopWanted() ? 1 : 0;
}

}  // namespace

int runVerbCompare(const Options& options, const Backends& backends)
{
    if (!options.from.empty()) return compareFolders(options, backends);
    const LoadedScene asWritten = backends.loadScene({options.scene, "", options.sets});
    if (options.orRun && (asWritten.pictures.compare.variants.empty() || options.variants.size() == 1)) return runVerbRun(options, backends);
    const auto folder = options.out.empty() ? defaultComparisonFolder(asWritten) : options.out;
    const auto runs = comparedRuns(options, backends, folder);
    const bool withFrames = options.frames && asWritten.pictures.output.frames;
    makeFolder(folder);

    const auto done = runAll(runs, options, withFrames, 0.0, stopWanted);
    if (stopWanted()) return 1;
    if (!done.empty()) makeComparisonOutputs(done, {asWritten.pictures, withFrames, options.video, folder}, backends, stopWanted);
    if (stopWanted()) return 1;
    if (const std::string seen = summarizeRuns(done); !seen.empty()) fmt::print("{}\n", seen);
    if (done.size() == runs.size()) return 0;
    spdlog::error("{} of {} variants did not get to their end", runs.size() - done.size(), runs.size());
    return 1;
}

}  // namespace app
