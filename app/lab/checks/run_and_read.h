#pragma once

#include "app/backends.h"

#include <cstdint>
#include <functional>

namespace app {

/// What it took to follow a run to its end.
struct RunReadings {
    std::int64_t steps = 0;
    double stepSeconds = 0.0;  ///< wall time in the steps alone
    double largestCfl = 0.0;   ///< [-]
};

/// Steps to the end, and calls `read` at the start and after every `every` seconds, `stepped` after every step. Throws RunError, also when
/// it is to stop. Tells of sources that stop.
RunReadings runAndRead(SimulationHandle& simulation, const sim::Scene& scene, double every, const std::function<void(double time)>& read,
                       const std::function<void()>& stepped, const std::function<bool()>& stopWanted);

}  // namespace app
