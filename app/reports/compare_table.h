#pragma once

#include "app/reports/run_report.h"

#include <string>
#include <vector>

namespace app {

/// The comparison as Markdown: one row per run, then the median milliseconds of each stage that ran, "-" where it did not.
/// @param reference  label of the run that the column of ratios refers to; empty: no such column
std::string compareTable(const std::string& title, const std::vector<RunResult>& runs, const std::string& reference);

/// What a run is remembered by.
struct RunOutcome {
    std::string label;
    double energyKept = 0.0;  ///< last total energy by the first [-]
    double wallSeconds = 0.0;
};

/// "Energy kept and time taken: Best 97.1 % in 38 s, PIC 74.2 % in 1 m 02 s.", those that kept most first; "" for no runs.
std::string outcomeSentence(std::vector<RunOutcome> runs);

}  // namespace app
