#include "app/runs/paper_runs.h"

#include "app/reports/output_folder.h"
#include "app/system/data_folder.h"
#include "app/system/interrupt.h"
#include "app/verbs/verbs.h"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <optional>

namespace app {

namespace {

/// What is to be run of one scene.
struct PaperWork {
    const PaperScene& scene;
    Options options;  ///< what `compare` would be asked for
    std::filesystem::path folder;
    std::vector<ComparedRun> runs;     ///< runs of the variants, with pictures if wanted
    std::vector<ComparedRun> repeats;  ///< repeats of the runs, without pictures
    bool withFrames = true;

    const PictureSettings& pictures() const { return runs.front().setup.pictures; }
    Options ofRepeats() const
    {
        Options without = options;
        without.frames = false;
        return without;
    }
    double costOfRepeats() const { return costOf(repeats, options, false); }
    double cost() const { return costOf(runs, options, withFrames) + costOfRepeats(); }
};

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

PaperWork workOf(const PaperScene& scene, const Options& options, const Backends& backends, const std::filesystem::path& folder)
{
    PaperWork work = {.scene = scene, .options = optionsOf(scene, options), .folder = folder / scene.name, .runs = {}, .repeats = {}};
    work.runs = comparedRuns(work.options, backends, work.folder);
    for (ComparedRun& run : work.runs) {
        const sim::TimeSettings& time = run.setup.scene.settings.time;
        run.cost = scene.stepCost * time.duration / time.dt;
    }
    work.repeats = repeatsOf(work.runs, options.paperRepeats, backends, work.folder);
    work.withFrames = options.frames && work.pictures().output.frames;
    return work;
}

/// Runs of a scene that got to their end, with what is made of them; nothing once somebody has asked to stop.
/// @param costAfter  of the scenes that follow
std::optional<PaperResult> runScene(const PaperWork& work, double costAfter, const Backends& backends, std::size_t& missing)
{
    makeFolder(work.folder);
    const auto done = runAll(work.runs, work.options, work.withFrames, work.costOfRepeats() + costAfter, stopWanted);
    if (!stopWanted() && !done.empty())
        makeComparisonOutputs(done, {work.pictures(), work.withFrames, work.options.video, work.folder}, backends, stopWanted);
    const auto repeated = stopWanted() ? std::vector<ComparedRun>() : runAll(work.repeats, work.ofRepeats(), false, costAfter, stopWanted);
    if (stopWanted()) return std::nullopt;
    missing += work.runs.size() - done.size() + work.repeats.size() - repeated.size();
    return PaperResult{work.scene, work.pictures(), done, ensemblesOf(done, repeated)};
}

}  // namespace

int runVerbPaper(const Options& options, const Backends& backends)
{
    const auto folder = options.out.empty() ? std::filesystem::path("out") / (options.quick ? "paper_quick" : "paper") : options.out;
    makeFolder(folder);
    // All are loaded, and so validated, before the first one starts.
    std::vector<PaperWork> all;
    for (const PaperScene& scene : paperScenes()) all.push_back(workOf(scene, options, backends, folder));

    std::vector<PaperResult> results;
    std::size_t missing = 0;
    bool allFrames = options.frames;
    for (std::size_t n = 0; n < all.size(); ++n) {
        fmt::print("{} ({}/{})\n", all[n].scene.example, n + 1, all.size());
        double costAfter = 0.0;
        for (std::size_t later = n + 1; later < all.size(); ++later) costAfter += all[later].cost();
        auto result = runScene(all[n], costAfter, backends, missing);
        if (!result) {
            spdlog::warn("stopped: the same command goes on where it was");
            return 1;
        }
        allFrames = allFrames && all[n].withFrames;
        if (!result->runs.empty()) results.push_back(std::move(*result));
    }
    if (!results.empty()) makePaper(results, backends, allFrames, folder);
    if (missing == 0) return 0;
    spdlog::error("{} runs did not get to their end", missing);
    return 1;
}

}  // namespace app
