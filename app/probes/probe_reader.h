#pragma once

#include "app/probes/probes.h"

#include <cstdint>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <vector>

namespace app {

class SimulationHandle;

/// What the probes of a scene tell at one time.
struct ProbeReading {
    double time = 0.0;                          ///< [s]
    std::vector<std::optional<double>> values;  ///< values of each probe at each of its points, in their units; none where a formula has no value
};

/// Reads the probes of a run at its start and after the first step that gets as far as the next reading is due. The steps are those that they would
/// be without it.
class ProbeReader {
 public:
    /// @param start  of the run, from which readings are counted [s]
    ProbeReader(const Probes& probes, double start) : probes_(probes), start_(start) {}
    /// Goes on in a run that has come to this time [s].
    ProbeReader(const Probes& probes, double start, double time, const IntervalTotals& sinceReading);

    /// Reads the state before the first step.
    ProbeReading initial(const SimulationHandle& simulation);
    /// Reads the state after a step, if a reading is due.
    /// @param isReflected  the state is one of particles that hold no flow: readings wait for the next one
    std::optional<ProbeReading> step(const SimulationHandle& simulation, bool isReflected);

    const Probes& probes() const { return probes_; }
    bool isNew() const { return next_ == 0; }  ///< nothing was read yet
    const IntervalTotals& sinceReading() const { return probes_.measures->interval(); }

 private:
    ProbeReading read(const SimulationHandle& simulation);
    std::optional<double> valueOf(const Probe& probe, std::span<const double> at);

    Probes probes_;
    double start_;                     ///< [s]
    std::int64_t next_ = 0;            ///< number of the reading that is due next
    std::set<std::string> valueless_;  ///< names of probes that were told to have none
};

}  // namespace app
