#pragma once

#include "app/probes/probe_reader.h"
#include "app/system/atomic_files.h"

#include <cstdint>
#include <filesystem>
#include <string>

namespace app {

class SimulationHandle;

inline constexpr const char* kProbesFile = "probes.csv";

/// probes.csv: a row for each reading.
class ProbeLog {
 public:
    /// @param start  of the run, from which readings are counted [s]
    ProbeLog(const std::filesystem::path& file, const Probes& probes, double start);
    /// Goes on behind the first `bytes` of the file, in a run that has come to this time [s].
    ProbeLog(const std::filesystem::path& file, const Probes& probes, double start, double time, std::uintmax_t bytes,
             const IntervalTotals& sinceReading);

    /// The state before the first step.
    void initial(const SimulationHandle& simulation);
    /// @param isReflected  the state is one of particles that hold no flow: readings wait for the next one
    void step(const SimulationHandle& simulation, bool isReflected);

    bool isNew() const { return reader_.isNew(); }        ///< nothing was read yet
    std::uintmax_t size() const { return file_.size(); }  ///< size of the file [bytes]
    const IntervalTotals& sinceReading() const { return reader_.sinceReading(); }

 private:
    void write(const ProbeReading& reading);

    LineFile file_;
    ProbeReader reader_;
};

/// The table of readings that is in a folder as probes.png, with its script beside it. Throws std::runtime_error with gnuplot's own words.
void plotProbes(const Probes& probes, const std::string& title, const std::filesystem::path& folder);

}  // namespace app
