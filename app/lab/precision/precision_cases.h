#pragma once

#include "app/lab/precision/pareto.h"
#include "app/lab/precision/precision_row.h"

#include <optional>
#include <string>
#include <vector>

namespace app {

/// The rows of one case, with what plots and the report tell of it.
struct PrecisionCase {
    std::string name, title;
    Precision precision;
    std::vector<PrecisionRow> rows;  ///< rows of the runs that came to their end

    std::vector<Cost> front() const;  ///< front of all rows
    std::vector<Cost> costsOf(const std::string& method, const std::string& integrator) const;
    bool isOnFront(const PrecisionRow& row) const;
    bool isPublished(const PrecisionRow& row) const;
};

/// A run of the published scheme beside the front.
struct Gain {
    const PrecisionRow* published = nullptr;
    double seconds = 0.0;                ///< time of the front at its error
    const PrecisionRow* ours = nullptr;  ///< the fastest run that is no further off

    double factor() const { return published->wallSeconds / seconds; }
};

/// Gain at every resolution that the published scheme was run with, in the order of the rows.
std::vector<Gain> gainsOf(const PrecisionCase& of);

}  // namespace app
