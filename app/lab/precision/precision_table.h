#pragma once

#include "app/lab/precision/precision_run.h"

#include <filesystem>
#include <vector>

namespace app {

/// The runs that have been made, in a file from the moment they are: a sweep that was stopped goes on where it was.
class PrecisionTable {
 public:
    /// Throws InputError where the file is none of its.
    explicit PrecisionTable(const std::filesystem::path& file) : file_(file), rows_(readPrecisionCsv(file)) {}

    /// The row of a run that need not be made again: of the same settings and threads, and of as many repeats.
    const PrecisionRow* find(const PrecisionRun& run, int threads, int repeats) const;
    /// Puts a row in the place of what was known of its run. Throws std::runtime_error.
    void add(const PrecisionRow& row);

 private:
    std::filesystem::path file_;
    std::vector<PrecisionRow> rows_;
};

}  // namespace app
