#include "app/ensemble/ensemble_products.h"
#include "app/reports/output_folder.h"
#include "app/study/do_study.h"
#include "app/study/ensemble_study.h"
#include "app/system/interrupt.h"
#include "app/verbs/verbs.h"
#include "sim/core/check.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <spdlog/spdlog.h>

namespace app {

namespace {

std::vector<Vary> variedBy(const Options& options)
{
    std::vector<Vary> varied;
    for (const std::string& text : options.vary) varied.push_back(readVary(text));
    if (varied.empty()) varied.push_back(readVary("positions"));
    return varied;
}

/// What is in the folder of runs that are done so far.
void gatherEnsemble(const std::filesystem::path& folder, const std::string& name, const std::vector<std::string>& vary)
{
    const Ensemble ensemble = readEnsemble(folder);
    const std::string title =
        fmt::format("{}: {} runs, varied: {}", name, ensemble.runs.size(), vary.empty() ? "positions" : fmt::format("{}", fmt::join(vary, ", ")));
    fmt::print("\n{}\n{}\n", writeEnsemble(ensemble, title, folder), (folder / "ensemble.csv").string());
}

}  // namespace

int runVerbEnsemble(const Options& options, const Backends& backends)
{
    const LoadedScene setup = backends.loadScene(options.request());
    logNotes(setup);
    const auto folder = options.out.empty() ? std::filesystem::path(defaultFolder(setup).string() + "_ensemble") : options.out;
    const EnsembleRequest request = {
        .scene = options.request(), .varied = variedBy(options), .count = options.members, .first = options.firstMember, .folder = folder};
    const Study study = ensembleStudy(request, backends.loadScene);
    makeFolder(folder);
    writeWhole(study.file, ensembleText(study, request));
    const StudyPlaces places = {.folder = folder, .threads = options.threads, .frames = options.framesOfAll, .video = options.framesOfAll};
    const StudyEnd end = doStudy(study, places, {options.jobs, options.force, options.onSlurm, options.wait}, stopWanted);
    const std::string name = setup.scene.title.empty() ? setup.scene.name : setup.scene.title;
    if (end.left < study.runs.size()) gatherEnsemble(folder, setup.label.empty() ? name : fmt::format("{}, {}", name, setup.label), options.vary);
    return exitCodeOf(study, end);
}

}  // namespace app
