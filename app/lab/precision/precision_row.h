#pragma once

#include "app/lab/precision/precision.h"

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace app {

/// What came of one run: a row of the table.
struct PrecisionRow {
    std::string scene;  ///< the case
    PrecisionNames names;
    int modes = 0;      ///< per component of the liquid's velocity; 0 without liquid
    double dt = 0.0;    ///< mean [s]
    double cfl = 0.0;   ///< largest [-]
    double cell = 0.0;  ///< [cm]
    std::int64_t steps = 0;
    double wallSeconds = 0.0;  ///< wall time of the steps; median of the repeats
    double error = 0.0;        ///< [-]
    double energyLeft = 0.0;   ///< energy left, as a share of that at the start [-]
    double viscosity = 0.0;    ///< kinematic, that would make the energy decay like this; NaN if not known [cm²/s]
    int threads = 1, repeats = 1;
    std::string settings;          ///< 16 digits: what the error depends on
    std::string outcome = "done";  ///< "done", or why the run did not come to its end

    bool isDone() const { return outcome == "done"; }
};

/// The table's file, with its header.
std::string precisionCsv(const std::vector<PrecisionRow>& rows);

/// Nothing where there is no such file. Throws InputError at a line that is no row of such a table.
std::vector<PrecisionRow> readPrecisionCsv(const std::filesystem::path& file);

}  // namespace app
