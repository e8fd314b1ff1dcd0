#pragma once

#include "app/lab/precision/precision_cases.h"

#include <string>
#include <vector>

namespace app {

/// "at equal error the best of ours needs 1/12 of the run time of the published scheme", of the first resolution it
/// was run with; empty where it was not.
std::string gainSentence(const PrecisionCase& of);

/// A paragraph per case: what its error is, what the published scheme takes and what the best for the same error.
std::string precisionReport(const std::vector<PrecisionCase>& cases, const std::string& machine, bool withPlots);

}  // namespace app
