#pragma once

#include "app/reports.h"

#include <string>
#include <vector>

namespace app {

/// The comparison as Markdown: one row per run, then the median milliseconds of every stage, "-" where it never ran.
/// @param reference  label of the run that the column of ratios refers to; empty: no such column
std::string compareTable(const std::string& title, const std::vector<RunResult>& runs, const std::string& reference);

}  // namespace app
