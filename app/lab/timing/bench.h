#pragma once

#include "app/backends.h"
#include "app/options.h"

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace app {

/// One repeat: milliseconds per step by stage, averaged over its steps; the last one is the whole step.
struct BenchRepeat {
    std::array<double, sim::kStages + 1> milliseconds{};
    std::array<bool, sim::kStages + 1> ran{};
    std::size_t particles = 0;
    double meanIterations = 0.0;
    std::uint64_t stateHash = 0;
};

/// All repeats on one number of threads.
struct BenchResult {
    int threads = 1;
    std::vector<BenchRepeat> repeats;

    double minimum(int stage) const;  ///< over the repeats [ms]
    double middle(int stage) const;   ///< median over the repeats [ms]
    bool ran(int stage) const { return repeats.front().ran[stage]; }
};

/// Start the scene anew and time options.steps steps after the warm-up ones, on the threads that are there.
BenchRepeat benchOnce(const LoadedScene& setup, const Backends& backends, const Options& options);

/// Do all repeats end in the same state? A speed-up that changes the state is a different program.
bool sameState(const std::vector<BenchResult>& results);

std::string benchTable(const std::vector<BenchResult>& results);
std::string benchCsv(const std::string& scene, const Options& options, const std::vector<BenchResult>& results);

/// Names the results of this machine, or as --machine says; and their folder.
std::string machineOf(const Options& options);
std::filesystem::path machineFolder(const Options& options);

/// "amd_epyc_7b13_2_cores": this machine's processor in [a-z0-9_].
std::string machineName();

}  // namespace app
