#include "app/lab/timing/bench.h"

#include "app/system/atomic_files.h"
#include "app/system/data_folder.h"
#include "app/system/thread_limit.h"
#include "app/verbs/verbs.h"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <cstdio>

namespace app {

namespace {

/// scenes/bench/NAME.yaml, here or where Drench keeps its own; anything with a slash or an ending is a file.
std::filesystem::path benchScene(const std::string& name)
{
    const std::filesystem::path given = name;
    if (given.has_extension() || given.has_parent_path()) return given;
    const auto file = std::filesystem::path("bench") / (name + ".yaml");
    return std::filesystem::exists("scenes" / file) ? "scenes" / file : dataFolder("scenes") / file;
}

void writeCsv(const std::string& scene, const Options& options, const std::vector<BenchResult>& results)
{
    const auto folder = machineFolder(options);
    std::filesystem::create_directories(folder);
    const auto file = folder / (scene + ".csv");
    writeWhole(file, benchCsv(scene, options, results));
    fmt::print("{}\n", file.string());
}

}  // namespace

int runVerbBench(const Options& options, const Backends& backends)
{
    SceneRequest request = options.request();
    request.file = benchScene(options.scene).string();
    const LoadedScene setup = backends.loadScene(request);
    std::vector<BenchResult> results;
    for (const int threads : options.benchThreads) {
        results.push_back({threads, {}});
        for (int n = 0; n < options.repeats; ++n)
            results.back().repeats.push_back(withThreads(threads, [&] { return benchOnce(setup, backends, options); }));
    }
    fmt::print("{}, {} steps, {} repeats\n{}", setup.scene.name, options.steps, options.repeats, benchTable(results));
    if (!sameState(results)) {
        spdlog::error("the repeats of {} ended in different states: the program is not deterministic", setup.scene.name);
        return 1;
    }
    if (options.csv) writeCsv(setup.scene.name, options, results);
    return 0;
}

}  // namespace app
