#pragma once

#include "app/system/child_process.h"

#include <cstddef>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace app {

/// How a process of a pool ended.
struct ProcessEnd {
    ChildExit exit;
    double seconds = 0.0;   ///< wall
    bool timedOut = false;  ///< whether it was ended because it took too long
};

/// A program, run many times with different arguments, some of them side by side.
struct ProcessPool {
    std::filesystem::path program = "/proc/self/exe";  ///< program that is run; by default this very one
    std::size_t count = 0;
    int width = 1;               ///< number of runs at a time
    double limitSeconds = 60.0;  ///< wall time allowed for each run [s]
    /// Arguments of a run, asked for right before it starts.
    std::function<std::vector<std::string>(std::size_t)> arguments = {};
    /// Called as each has ended.
    std::function<void(std::size_t, const ProcessEnd&)> ended = {};
    /// Once it returns true no more are started.
    std::function<bool()> stopWanted = [] { return false; };
};

/// Returns when all have ended. Throws std::runtime_error where a child cannot be started.
void runProcesses(const ProcessPool& pool);

}  // namespace app
