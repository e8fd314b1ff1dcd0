#include "app/study/slurm.h"

#include "app/system/atomic_files.h"
#include "app/system/child_process.h"
#include "sim/core/check.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <chrono>
#include <cstdio>
#include <stdexcept>
#include <thread>

namespace app {

namespace fs = std::filesystem;

namespace {

/// How many have ended, as their folders say.
std::size_t doneOf(const Study& study, const std::vector<std::size_t>& runs, const StudyPlaces& places)
{
    std::size_t done = 0;
    for (const std::size_t n : runs) done += outcomeOf(study.runs[n], places).status == StudyStatus::Done ? 1 : 0;
    return done;
}

}  // namespace

std::string slurmScript(const Study& study, const std::vector<std::size_t>& runs, const StudyPlaces& places, int width)
{
    const fs::path folder = fs::absolute(places.folder), program = fs::canonical("/proc/self/exe");
    std::string script = fmt::format(
        "#!/bin/bash\n#SBATCH --job-name={}\n#SBATCH --array={}%{}\n#SBATCH --cpus-per-task={}\n#SBATCH --output={}\n#SBATCH --chdir={}\n",
        study.name, fmt::join(runs, ","), width, places.threads, shellQuoted((folder / "slurm_%a.log").string()),
        shellQuoted(fs::current_path().string()));
    script += fmt::format("exec {} sweep {} --out {} --threads {} --task \"$SLURM_ARRAY_TASK_ID\"{}{}\n", shellQuoted(program.string()),
                          shellQuoted(fs::absolute(study.file).string()), shellQuoted(folder.string()), places.threads,
                          places.frames ? "" : " --no-frames", places.video ? "" : " --no-video");
    return script;
}

bool runOnSlurm(const Study& study, const std::vector<std::size_t>& runs, const StudyPlaces& places, int width, bool wait,
                const std::function<bool()>& stopWanted)
{
    const auto sbatch = findProgram("sbatch");
    if (!sbatch) throw sim::InputError("--on slurm: there is no sbatch along PATH; leave it out to run here");
    const fs::path script = places.folder / "study.sbatch";
    writeWhole(script, slurmScript(study, runs, places, width));
    std::vector<std::string> arguments = {script.string()};
    if (wait) arguments.insert(arguments.begin(), "--wait");
    ChildProcess child(*sbatch, arguments);
    std::size_t shown = 0;
    while (true) {
        if (const auto end = child.poll()) {
            // Its code is the worst of the jobs', which their folders tell better, or that of sbatch itself, which has words.
            if (!end->ok() && !end->errorText.empty()) throw std::runtime_error(fmt::format("sbatch: {}", end->lastWords()));
            return wait;
        }
        if (stopWanted()) {
            child.kill();
            fmt::print("the jobs go on by themselves: the same command tells how they are\n");
            return false;
        }
        if (const std::size_t done = doneOf(study, runs, places); done != shown) {
            fmt::print("[{}/{}] done\n", shown = done, runs.size());
            std::fflush(stdout);
        }
        std::this_thread::sleep_for(std::chrono::milliseconds(200));
    }
}

}  // namespace app
