#pragma once

#include "app/system/atomic_files.h"
#include "sim/step_report.h"

#include <filesystem>

namespace app {

/// energy_ledger.csv: where the energy of a run has gone up to each step (sim/README.md, Energy).
class EnergyLedger {
 public:
    /// How far it has come.
    struct Summary {
        double first = 0.0;            ///< energy at the start [erg]
        sim::EnergyChanges changes;    ///< changes since the start [erg]
        double largestKinetic = 0.0;   ///< largest kinetic energy of liquid and fabric [erg]
        double largestResidual = 0.0;  ///< change of the energy that no part of the steps has booked [erg]
    };

    explicit EnergyLedger(const std::filesystem::path& file);
    /// Goes on behind the first `bytes` of the file.
    EnergyLedger(const std::filesystem::path& file, std::uintmax_t bytes, const Summary& summary);
    /// The state before the first step.
    void initial(double time, const sim::Energies& energies);
    /// The report must have its energies booked.
    void step(double time, const sim::StepReport& report);
    const Summary& summary() const { return summary_; }
    std::uintmax_t size() const { return file_.size(); }  ///< size of the file [bytes]

 private:
    void add(double time, const sim::Energies& energies);

    LineFile file_;
    Summary summary_;
};

}  // namespace app
