#pragma once

#include "app/diff/finding.h"
#include "app/scene/tolerance.h"

#include <filesystem>
#include <limits>
#include <map>
#include <string>
#include <vector>

namespace app {

/// Number in the place of one that is not there.
inline constexpr double kNothing = std::numeric_limits<double>::quiet_NaN();

/// Numbers by column, one of each per row: a log of a run, or its report as one row. A row that lacks a column has kNothing in it.
struct Series {
    std::string name;                                   ///< name of the file
    std::vector<std::string> columns;                   ///< in their order in the file
    std::map<std::string, std::vector<double>> values;  ///< values of each column, one per row
    std::size_t rows = 0;
    std::vector<double> times;  ///< times of each row [s]; empty where the file has none
};

/// A table of numbers: .csv with names in its first line, or .jsonl with an object per line. Columns of objects are named like
/// "energy/total", elements of lists like "force[0]". How long things took is left out.
/// Columns that were called otherwise before (sim/renamed.h) have their names of now.
/// Throws InputError "file:line: …" at what is no number.
Series readSeries(const std::filesystem::path& file);

/// The numbers of report.json, without those that depend on the machine and the clock. Throws InputError.
Series readReportNumbers(const std::filesystem::path& file);

/// A column at a time, on the straight line between the rows around it, the last row beyond them; kNothing where one of them has no value.
double valueAt(const Series& series, const std::vector<double>& values, double time);

/// A column of ours less that of theirs at each of our times, in percent of their largest; kNothing where they have none, and after their end.
std::vector<double> percentOfDifference(const Series& ours, const Series& theirs, const std::string& column);

/// Largest difference in each column, relative to the largest number of A in the column (in the whole vector, for one of its
/// components), and when it is. Rows of equal times are held against each other; without times those of equal number.
std::vector<DiffFinding> diffSeries(const Series& a, const Series& b, const Tolerance& tolerance);

}  // namespace app
