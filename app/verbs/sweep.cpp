#include "app/reports/output_folder.h"
#include "app/study/do_study.h"
#include "app/study/study_table.h"
#include "app/system/interrupt.h"
#include "app/verbs/verbs.h"
#include "sim/core/check.h"

#include <fmt/format.h>

namespace app {

namespace {

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
    const StudyEnd end = doStudy(study, places, {options.jobs, options.force, options.onSlurm, options.wait}, stopWanted);
    fmt::print("\n{}\n{}\n", gatherStudy(study, places), (places.folder / "study.csv").string());
    return exitCodeOf(study, end);
}

}  // namespace app
