#pragma once

#include "app/lab/checks/check.h"
#include "app/readings/reading_context.h"

#include <string>

namespace app {

/// One comparison, whatever it says of its bounds. Throws InputError.
Check readCheck(const sim::Node& node, const std::string& path, const ReadingContext& context, const std::string& name);

}  // namespace app
