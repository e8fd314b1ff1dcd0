#include "app/import/import_scene.h"
#include "app/verbs/verbs.h"

#include <fmt/format.h>

namespace app {

int runVerbImport(const Options& options, const Backends& backends)
{
    const std::filesystem::path xml = options.scene;
    const std::filesystem::path yaml = options.out.empty() ? xml.filename().replace_extension(".yaml") : options.out;
    fmt::print("{}", importScene(xml, yaml, options.import, backends));
    return 0;
}

}  // namespace app
