#include "app/lab/random/random_stress.h"

#include "app/lab/endings/run_course.h"
#include "app/lab/random/escapes.h"
#include "app/lab/random/random_scene.h"
#include "app/reports/output_folder.h"
#include "app/system/atomic_files.h"
#include "app/system/progress.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <iterator>
#include <map>

namespace app {

namespace {

namespace fs = std::filesystem;

constexpr int kPictures = 3;  // of each scene: start, middle, end

struct Places {
    fs::path scenes;
    fs::path file(const std::string& name) const { return scenes / (name + ".yaml"); }
    fs::path folder(const std::string& name) const { return scenes / name; }

    explicit Places(const RandomStress& stress) : scenes(stress.folder / "scenes") {}
    void remove(const std::string& name) const
    {
        fs::remove(file(name));
        fs::remove_all(folder(name));
    }
};

void tell(const RandomStressResult& result)
{
    const RunVerdict& outcome = result.outcome;
    if (outcome.ending == RunOutcome::Finished) return;
    fmt::print("{:<18} {:>6.1f} s  {}: {}\n", result.scene, outcome.seconds, kRunOutcomes[static_cast<int>(outcome.ending)], outcome.message);
    std::fflush(stdout);
}

/// Judges a run that finished or stopped: is all where and as fast as it may be?
void judgeLaws(const fs::path& file, const fs::path& folder, const RandomScene& scene, RunVerdict& outcome)
{
    if (isFault(outcome.ending)) return;
    if (const std::string why = whyUnsound(courseOf(folder)); !why.empty()) {
        outcome.ending = RunOutcome::Unsound;
        outcome.message = why;
    }
    if (const std::string why = describeEscape(file, folder, scene.vessel); !why.empty()) {
        outcome.ending = RunOutcome::Escaped;
        outcome.message = why;
    }
}

std::string quoted(std::string text)
{
    std::ranges::replace(text, '"', '\'');
    return '"' + text + '"';
}

}  // namespace

std::vector<RandomStressResult> runRandomStress(const RandomStress& stress)
{
    const Places places(stress);
    makeFolder(places.scenes);
    const auto nameOf = [&](std::size_t n) { return randomSceneName(stress.seed, stress.first + static_cast<int>(n)); };
    const auto sceneOf = [&](std::size_t n) { return randomScene(stress.seed, stress.first + static_cast<int>(n)); };
    std::map<std::size_t, RandomStressResult> results;
    ProcessPool pool{.count = static_cast<std::size_t>(stress.count), .width = stress.width, .limitSeconds = stress.limitSeconds};
    pool.stopWanted = stress.stopWanted;
    pool.arguments = [&](std::size_t n) {
        const std::string name = nameOf(n);
        places.remove(name);
        writeWhole(places.file(name), sceneOf(n).text);
        std::vector<std::string> run = {"run", places.file(name).string(), "--out", places.folder(name).string(), "--threads", "1", "--no-video"};
        for (const std::string& key : stress.set) run.insert(run.end(), {"--set", key});
        return run;
    };
    pool.ended = [&](std::size_t n, const ProcessEnd& end) {
        if (stress.stopWanted()) return;
        const std::string name = nameOf(n);
        RandomStressResult result{name, judgeEnd(end, places.folder(name), kPictures)};
        judgeLaws(places.file(name), places.folder(name), sceneOf(n), result.outcome);
        tell(result);
        if (result.outcome.ending == RunOutcome::Finished) places.remove(name);
        results.emplace(n, std::move(result));
    };
    runProcesses(pool);
    std::vector<RandomStressResult> inOrder;
    for (auto& [n, result] : results) inOrder.push_back(std::move(result));
    return inOrder;
}

std::string randomStressReport(const RandomStress& stress, const std::vector<RandomStressResult>& results)
{
    std::map<RunOutcome, int> counts;
    double seconds = 0.0;
    for (const RandomStressResult& result : results) {
        ++counts[result.outcome.ending];
        seconds += result.outcome.seconds;
    }
    std::string text = fmt::format("# {} random scenes, seed {}\n\nThey took {} of one thread's time.\n\n| ending | scenes |\n|---|---:|\n",
                                   results.size(), stress.seed, formatDuration(seconds));
    for (int e = 0; e < static_cast<int>(RunOutcome::Count); ++e)
        text += fmt::format("| {} | {} |\n", kRunOutcomes[e], counts[static_cast<RunOutcome>(e)]);
    std::string again = "drench run FILE --threads 1";
    for (const std::string& key : stress.set) again += fmt::format(" --set {}", key);
    text += fmt::format("\n## What did not finish\n\nEach scene is a file that runs again by `{}`.\n\n| file | ending | message |\n|---|---|---|\n",
                        again);
    for (const RandomStressResult& result : results)
        if (const RunVerdict& outcome = result.outcome; outcome.ending != RunOutcome::Finished)
            text += fmt::format("| scenes/{}.yaml | {} | {} |\n", result.scene, kRunOutcomes[static_cast<int>(outcome.ending)], outcome.message);
    return text;
}

std::string randomStressTable(const std::vector<RandomStressResult>& results)
{
    std::string csv = "scene,ending,seconds,message\n";
    for (const RandomStressResult& result : results)
        fmt::format_to(std::back_inserter(csv), "{},{},{:.3f},{}\n", result.scene, kRunOutcomes[static_cast<int>(result.outcome.ending)],
                       result.outcome.seconds, quoted(result.outcome.message));
    return csv;
}

}  // namespace app
