#pragma once

#include "app/backends.h"
#include "app/lab/validation/validation.h"

#include <functional>
#include <string>
#include <vector>

namespace app {

/// What came of one case of the validation.
struct CaseResult {
    std::string name;  ///< name of its file
    LoadedScene setup;
    Validation validation;                      ///< validation of the case
    std::vector<std::vector<Sample>> readings;  ///< readings of each check
    std::vector<Finding> findings = {};         ///< findings of each check; none when the run failed
    std::string failure = {};                   ///< why the run did not come to its end
    std::int64_t steps = 0;
    double wallSeconds = 0.0;

    /// Tells whether a check misses and does not say that it is known to.
    bool fails(std::size_t check) const;
    bool passes() const;
};

/// Runs a scene with a section `validate` to its end and compares it with what is known.
CaseResult runCase(const std::string& name, const LoadedScene& setup, const Backends& backends, const std::function<bool()>& stopWanted);

}  // namespace app
