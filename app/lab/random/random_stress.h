#pragma once

#include "app/lab/endings/run_outcome.h"

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace app {

/// Random scenes (random_scene.h) of one seed, each run as a process of its own.
struct RandomStress {
    std::uint64_t seed = 1;
    int first = 0, count = 100;  ///< numbers of the scenes
    int width = 1;               ///< so many side by side, each on one thread
    double limitSeconds = 120.0;
    std::vector<std::string> set;  ///< keys that all scenes have otherwise, as --set has them
    std::filesystem::path folder;  ///< folder of the report, with the scenes that are worth a look below `scenes`
    std::function<bool()> stopWanted = [] { return false; };
};

struct RandomStressResult {
    std::string scene;
    RunVerdict outcome;
};

/// Scenes that finished are removed, with what they left; of the others scene and logs stay. Returns those that were run,
/// in their order. Throws std::runtime_error.
std::vector<RandomStressResult> runRandomStress(const RandomStress& stress);

/// How many ended how, and how to run each again that did not finish.
std::string randomStressReport(const RandomStress& stress, const std::vector<RandomStressResult>& results);

/// scene,ending,seconds,message
std::string randomStressTable(const std::vector<RandomStressResult>& results);

}  // namespace app
