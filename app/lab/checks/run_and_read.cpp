#include "app/lab/checks/run_and_read.h"

#include "app/reports/blocked_sources.h"
#include "sim/core/check.h"

#include <algorithm>
#include <chrono>
#include <cmath>

namespace app {

RunReadings runAndRead(SimulationHandle& simulation, const sim::Scene& scene, double every, const std::function<void(double time)>& read,
                       const std::function<void()>& stepped, const std::function<bool()>& stopWanted)
{
    using Clock = std::chrono::steady_clock;
    // Readings end on the duration itself but for the rounding of sums.
    constexpr double kRounding = 1.0e-9;
    const sim::TimeSettings& time = scene.settings.time;
    const auto count = static_cast<std::int64_t>(std::floor(time.duration / every + kRounding));
    RunReadings followed;
    BlockedSources shut(scene);
    read(time.start);
    for (std::int64_t n = 1; n <= count; ++n) {
        const double until = time.start + static_cast<double>(n) * every;
        const auto begin = Clock::now();
        while (simulation.state().time < until - kRounding * every) {
            followed.largestCfl = std::max(followed.largestCfl, simulation.step(until).cfl);
            stepped();
            shut.look(simulation.state());
        }
        followed.stepSeconds += std::chrono::duration<double>(Clock::now() - begin).count();
        read(simulation.state().time);
        if (stopWanted()) throw sim::RunError("stopped by the user");
    }
    followed.steps = simulation.state().step;
    return followed;
}

}  // namespace app
