#pragma once

#include "app/system/process_pool.h"

#include <array>
#include <filesystem>
#include <string>
#include <string_view>

namespace app {

/// How a run under stress ended.
enum class RunOutcome {
    Finished,  ///< the run came to its end, all numbers finite, all pictures there
    Stopped,   ///< the run told scene, step, stage and why
    TimedOut,
    Unsound,      ///< the run gained energy or speed from nothing
    Escaped,      ///< something is inside a solid, or outside of the vessel that it was in
    Refused,      ///< the scene could not be read: a mistake of who made it
    NotFinite,    ///< the run went on with numbers that are none
    Undiagnosed,  ///< the run failed without telling where and why
    Crashed,      ///< a signal ended it
    Count
};
inline constexpr std::array<std::string_view, static_cast<int>(RunOutcome::Count)> kRunOutcomes = {
    "finished", "stopped with a diagnosis", "timed out", "unsound", "through a solid", "refused", "not finite", "undiagnosed", "crashed"};

/// Must never happen.
inline bool isFault(RunOutcome ending) { return ending >= RunOutcome::Unsound; }

struct RunVerdict {
    RunOutcome ending = RunOutcome::Finished;
    std::string message;   ///< why, one line; empty where it finished
    double seconds = 0.0;  ///< wall
};

/// Judge the end of `drench run` by its exit code, its last words and what it left in its folder.
/// @param pictures  that it must have left, were it finished
RunVerdict judgeEnd(const ProcessEnd& end, const std::filesystem::path& folder, int pictures);

}  // namespace app
