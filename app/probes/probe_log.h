#pragma once

#include "app/probes/probes.h"
#include "app/readings/force_log.h"
#include "app/system/atomic_files.h"

#include <cstdint>
#include <filesystem>
#include <set>
#include <string>

namespace app {

class Steppable;

inline constexpr const char* kProbesFile = "probes.csv";

/// probes.csv: a row of readings at the start and after the first step that gets as far as the next one is due. The steps are those that
/// they would be without it.
class ProbeLog {
 public:
    /// @param start  of the run, from which readings are counted [s]
    ProbeLog(const std::filesystem::path& file, const Probes& probes, double start);
    /// Goes on behind the first `bytes` of the file, in a run that has come to this time [s].
    ProbeLog(const std::filesystem::path& file, const Probes& probes, double start, double time, std::uintmax_t bytes,
             const ForceTotals& sinceReading);

    /// The state before the first step.
    void initial(const Steppable& simulation);
    /// @param isReflected  the state is one of particles that hold no flow: readings wait for the next one
    void step(const Steppable& simulation, bool isReflected);

    bool isNew() const { return next_ == 0; }             ///< nothing was read yet
    std::uintmax_t size() const { return file_.size(); }  ///< of the file [bytes]
    const ForceTotals& sinceReading() const { return probes_.measures->interval(); }

 private:
    void read(const Steppable& simulation);
    std::string valueOf(const Probe& probe, std::span<const double> at);

    LineFile file_;
    Probes probes_;
    double start_;
    std::int64_t next_ = 0;            ///< number of the reading that is due next
    std::set<std::string> valueless_;  ///< names of probes that were told to have none
};

/// The table of readings that is in a folder as probes.png, with its script beside it. Throws std::runtime_error with gnuplot's own words.
void plotProbes(const Probes& probes, const std::string& title, const std::filesystem::path& folder);

}  // namespace app
