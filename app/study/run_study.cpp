#include "app/study/run_study.h"

#include "app/reports/run_report.h"
#include "app/runs/resume.h"
#include "app/system/process_pool.h"
#include "app/system/progress.h"

#include <fmt/format.h>

#include <cstdio>
#include <limits>

namespace app {

namespace {

/// Did this very program begin what is in the folder, with these very settings?
std::optional<RunResult> reportOf(const StudyRun& run, const StudyPlaces& places)
{
    auto report = readReport(places.of(run));
    if (report && report->contentHash != contentHash(run.setup, false, programHash())) report.reset();
    return report;
}

void tell(const StudyRun& run, std::size_t number, std::size_t count, const ProcessEnd& end, const StudyOutcome& outcome)
{
    const bool isDone = outcome.status == StudyStatus::Done;
    fmt::print("[{}/{}] {}: {}, {}\n", number, count, run.name, isDone ? "done" : "failed: " + end.exit.lastWords(), formatDuration(end.seconds));
    std::fflush(stdout);
}

}  // namespace

StudyOutcome outcomeOf(const StudyRun& run, const StudyPlaces& places)
{
    const auto report = reportOf(run, places);
    if (!report) return {};
    if (report->status == "done") return {StudyStatus::Done, ""};
    if (report->status == "failed") return {StudyStatus::Failed, report->reason};
    return {StudyStatus::Interrupted, report->reason};
}

std::vector<std::string> runArguments(const StudyRun& run, const StudyPlaces& places)
{
    const std::filesystem::path folder = places.of(run);
    std::vector<std::string> arguments = {"run"};
    if (canResume(folder, contentHash(run.setup, false, programHash()))) {
        arguments.insert(arguments.end(), {"--resume", folder.string()});
    } else {
        arguments.insert(arguments.end(), {run.request.file, "--out", folder.string()});
        if (!run.request.variant.empty()) arguments.insert(arguments.end(), {"--variant", run.request.variant});
        for (const std::string& set : run.request.sets) arguments.insert(arguments.end(), {"--set", set});
    }
    arguments.insert(arguments.end(), {"--threads", fmt::format("{}", places.threads)});
    if (!places.frames) arguments.push_back("--no-frames");
    if (!places.video) arguments.push_back("--no-video");
    return arguments;
}

void runHere(const Study& study, const std::vector<std::size_t>& runs, const StudyPlaces& places, int width, const std::function<bool()>& stopWanted)
{
    std::vector<std::size_t> left = runs;
    std::size_t done = 0;
    for (int attempt = 0; attempt <= study.retries && !left.empty() && !stopWanted(); ++attempt) {
        if (attempt > 0) fmt::print("again, those that failed: {}\n", left.size());
        std::vector<std::size_t> failed;
        runProcesses({.count = left.size(),
                      .width = width,
                      .limitSeconds = std::numeric_limits<double>::infinity(),
                      .arguments = [&](std::size_t n) { return runArguments(study.runs[left[n]], places); },
                      .ended =
                          [&](std::size_t n, const ProcessEnd& end) {
                              const StudyRun& run = study.runs[left[n]];
                              const StudyOutcome outcome = outcomeOf(run, places);
                              if (outcome.status == StudyStatus::Done) ++done;
                              else failed.push_back(left[n]);
                              tell(run, done, runs.size(), end, outcome);
                          },
                      .stopWanted = stopWanted});
        left = std::move(failed);
    }
}

}  // namespace app
