#include "app/runs/paper_runs.h"

#include "app/reports/output_folder.h"
#include "app/system/data_folder.h"
#include "app/system/interrupt.h"
#include "app/verbs/verbs.h"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

namespace app {

namespace {

/// What `compare` would be asked for to run one scene.
Options optionsOf(const PaperScene& scene, const Options& options)
{
    const auto file = std::filesystem::path(scene.name + ".yaml");
    Options of = options;
    of.scene = (std::filesystem::exists("scenes" / file) ? "scenes" / file : dataFolder("scenes") / file).string();
    for (const PaperVariant& variant : kPaperVariants) of.variants.push_back(variant.name);
    of.sets.clear();
    if (options.quick) of.sets = scene.quick;
    of.sets.insert(of.sets.end(), options.sets.begin(), options.sets.end());
    return of;
}

}  // namespace

int runVerbPaper(const Options& options, const Backends& backends)
{
    const auto folder = options.out.empty() ? std::filesystem::path("out") / (options.quick ? "paper_quick" : "paper") : options.out;
    makeFolder(folder);
    // All are loaded, and so validated, before the first one starts.
    std::vector<std::vector<ComparedRun>> wanted;
    for (const PaperScene& scene : paperScenes()) wanted.push_back(comparedRuns(optionsOf(scene, options), backends, folder / scene.name));

    std::vector<PaperResult> results;
    std::size_t missing = 0;
    bool allFrames = options.frames;
    for (std::size_t n = 0; n < wanted.size(); ++n) {
        const PaperScene& scene = paperScenes()[n];
        const PictureSettings& pictures = wanted[n].front().setup.pictures;
        const bool withFrames = options.frames && pictures.output.frames;
        allFrames = allFrames && withFrames;
        fmt::print("{} ({}/{})\n", scene.example, n + 1, wanted.size());
        makeFolder(folder / scene.name);
        const auto done = runAll(wanted[n], optionsOf(scene, options), withFrames, stopWanted);
        if (!stopWanted() && !done.empty())
            makeComparisonOutputs(done, {pictures, withFrames, options.video, folder / scene.name}, backends, stopWanted);
        if (stopWanted()) {
            spdlog::warn("stopped: the same command goes on where it was");
            return 1;
        }
        missing += wanted[n].size() - done.size();
        if (!done.empty()) results.push_back({scene, pictures, done});
    }
    if (!results.empty()) makePaper(results, backends, allFrames, folder);
    if (missing == 0) return 0;
    spdlog::error("{} runs did not get to their end", missing);
    return 1;
}

}  // namespace app
