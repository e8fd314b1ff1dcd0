#include "app/reports/output_folder.h"
#include "app/study/run_study.h"
#include "app/study/slurm.h"
#include "app/study/study_table.h"
#include "app/system/interrupt.h"
#include "app/verbs/verbs.h"
#include "sim/core/check.h"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <algorithm>

namespace app {

namespace {

std::vector<std::size_t> unfinishedRuns(const Study& study, const StudyPlaces& places, bool all)
{
    std::vector<std::size_t> left;
    for (std::size_t n = 0; n < study.runs.size(); ++n)
        if (all || outcomeOf(study.runs[n], places).status != StudyStatus::Done) left.push_back(n);
    return left;
}

/// One run alone: a job of an array.
int runTask(const Study& study, std::size_t task, const StudyPlaces& places)
{
    if (task >= study.runs.size()) throw sim::InputError(fmt::format("--task {}: the study has runs 0 to {}", task, study.runs.size() - 1));
    runHere(study, {task}, places, 1, stopWanted);
    return outcomeOf(study.runs[task], places).status == StudyStatus::Done ? 0 : 1;
}

}  // namespace

int runVerbSweep(const Options& options, const Backends& backends)
{
    const Study study = readStudy(options.scene, backends.loadScene);
    const StudyPlaces places = {.folder = options.out.empty() ? std::filesystem::path("out") / study.name : options.out,
                                .threads = options.threads,
                                .frames = options.frames,
                                .video = options.video};
    makeFolder(places.folder);
    if (options.task) return runTask(study, *options.task, places);
    const std::vector<std::size_t> runs = unfinishedRuns(study, places, options.force);
    fmt::print("{}: {} runs, {} of them done\n", study.name, study.runs.size(), study.runs.size() - runs.size());
    bool isOver = true;
    if (!runs.empty() && options.onSlurm) isOver = runOnSlurm(study, runs, places, options.jobs, options.wait, stopWanted);
    else if (!runs.empty()) runHere(study, runs, places, options.jobs, stopWanted);
    fmt::print("\n{}\n{}\n", gatherStudy(study, places), (places.folder / "study.csv").string());
    if (!isOver) return stopWanted() ? 1 : 0;
    const std::size_t left = unfinishedRuns(study, places, false).size();
    if (left > 0) spdlog::error("{} of {} runs did not get to their end; the same command tries them again", left, study.runs.size());
    return left > 0 || stopWanted() ? 1 : 0;
}

}  // namespace app
