#pragma once

#include "app/reports/run_report.h"

#include <string>

namespace app {

/// What stands in report.json, which readReport() reads back.
std::string reportText(const RunSummary& summary);

}  // namespace app
