#include "app/interrupt.h"
#include "app/lab/random_stress.h"
#include "app/output_files.h"
#include "app/output_folder.h"
#include "app/verbs/verbs.h"
#include "sim/core/check.h"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <algorithm>

namespace app {

namespace {

bool stopWanted() { return interruptsSeen() > 0; }

int stressRandomScenes(const Options& options)
{
    const auto folder = options.out.empty() ? std::filesystem::path("out/stress") / fmt::format("random_{}", options.seed) : options.out;
    makeFolder(folder);
    const RandomStress stress{.seed = options.seed,
                              .first = options.firstScene,
                              .count = options.randomScenes,
                              .width = options.threads,
                              .limitSeconds = options.limitSeconds,
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

}  // namespace

int runVerbStress(const Options& options, const Parts&)
{
    if (options.randomScenes > 0) return stressRandomScenes(options);
    throw sim::InputError("stress: --random N is missing");
}

}  // namespace app
