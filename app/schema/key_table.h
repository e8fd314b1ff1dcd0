#pragma once

#include <string>

namespace app {

/// The keys of scene files as tables in Markdown, one for each section and for each thing that stands in lists: what values they have,
/// what holds where they are left out, what they do. From the schema, and so from the declarations.
std::string keyTables();

}  // namespace app
