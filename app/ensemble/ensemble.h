#pragma once

#include "app/diff/series.h"
#include "app/ensemble/welch.h"

#include <filesystem>
#include <string>
#include <vector>

namespace app {

inline constexpr const char* kEnsembleFile = "ensemble.yaml";
inline constexpr const char* kLessTheFirst = "total_less_that_of_the_first_percent";

/// A run of an ensemble.
struct EnsembleRun {
    std::filesystem::path folder;
    std::string draw;  ///< what chance has given it: runs of two ensembles with the same draw are a pair
};

/// Runs of the same but for chance, as they are read back.
struct Ensemble {
    std::string label;              ///< name in tables and legends
    std::vector<EnsembleRun> runs;  ///< runs that are done
    std::size_t missing = 0;        ///< runs that did not get to their end, which do not count
    std::size_t timedFrom = 0;      ///< seconds and memory are those of this run and of those after it: others had more to do
    std::vector<Series> reports;    ///< numbers of report.json, one row for each run
    /// A log of each run, energy.csv and probes.csv; none of a kind that not all of them have.
    std::vector<std::vector<Series>> logs;
};

/// One number of each run.
struct EnsembleColumn {
    std::string name;
    std::vector<double> values;  ///< NaN where a run has none
    bool isOfMachine = false;    ///< seconds and memory: told, not judged

    Spread spread() const { return spreadOf(values); }
};

/// Runs that are done.
/// Throws InputError where a log cannot be understood.
Ensemble ensembleOf(const std::vector<EnsembleRun>& runs, const std::string& label);

/// Energies get a column kLessTheFirst: the total less that of the run of another ensemble with the same draw, in percent of the largest there.
void addDifferences(const Ensemble& first, Ensemble& ensemble);

/// Is this the folder of an ensemble?
bool isEnsemble(const std::filesystem::path& folder);

/// The ensemble that `drench ensemble` has left in a folder, labelled as its runs are. Throws InputError where there is none, or no run that is done.
Ensemble readEnsemble(const std::filesystem::path& folder);

/// What an ensemble is told and judged by: numbers of the reports, each column of a log at the end and in the mean over time.
std::vector<EnsembleColumn> columnsOf(const Ensemble& ensemble);

}  // namespace app
