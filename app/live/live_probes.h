#pragma once

#include "app/probes/probe_reader.h"

#include <limits>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

namespace app {

/// What a window tells of a probe beside its values.
struct ProbeTitle {
    std::string name, unit;
    std::size_t points = 0;  ///< along a line; 0: it is read once
    friend bool operator==(const ProbeTitle&, const ProbeTitle&) = default;
};

/// What was read since it was last taken.
struct LiveReadings {
    std::shared_ptr<const std::vector<ProbeTitle>> titles;       ///< titles of all probes; null where the scene has none
    double dropAfter = std::numeric_limits<double>::infinity();  ///< what was taken before and is of a later time does not hold any more [s]
    std::vector<ProbeReading> readings;                          ///< oldest first
};

/// The probes of a live simulation: read on its thread, taken on another.
class LiveProbes {
 public:
    /// All is read anew, beginning with the state before the first step. Throws InputError.
    void begin(const LoadedScene& setup, const SimulationHandle& simulation);
    /// What was read after a time does not hold [s]; from there on it is read again, forces as means since then.
    void goBack(const LoadedScene& setup, double time);
    void step(const SimulationHandle& simulation, bool isReflected);

    LiveReadings take();

 private:
    void add(ProbeReading reading);

    std::optional<ProbeReader> reader_;  ///< reader, where the scene has probes

    std::mutex mutex_;  ///< guards what follows
    LiveReadings waiting_;
};

}  // namespace app
