#include "app/study/do_study.h"

#include "app/study/slurm.h"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

namespace app {

namespace {

std::vector<std::size_t> notDone(const Study& study, const StudyPlaces& places, bool all)
{
    std::vector<std::size_t> left;
    for (std::size_t n = 0; n < study.runs.size(); ++n)
        if (all || outcomeOf(study.runs[n], places).status != StudyStatus::Done) left.push_back(n);
    return left;
}

}  // namespace

StudyEnd doStudy(const Study& study, const StudyPlaces& places, const StudyWork& work, const std::function<bool()>& stopWanted)
{
    const std::vector<std::size_t> runs = notDone(study, places, work.all);
    fmt::print("{}: {} runs, {} of them done\n", study.name, study.runs.size(), study.runs.size() - runs.size());
    StudyEnd end;
    if (!runs.empty() && work.onSlurm) end.isOver = runOnSlurm(study, runs, places, work.jobs, work.wait, stopWanted);
    else if (!runs.empty()) runHere(study, runs, places, work.jobs, stopWanted);
    end.left = notDone(study, places, false).size();
    end.isStopped = stopWanted();
    return end;
}

int exitCodeOf(const Study& study, const StudyEnd& end)
{
    if (!end.isOver) return end.isStopped ? 1 : 0;
    if (end.left > 0) spdlog::error("{} of {} runs did not get to their end; the same command tries them again", end.left, study.runs.size());
    return end.left > 0 || end.isStopped ? 1 : 0;
}

}  // namespace app
