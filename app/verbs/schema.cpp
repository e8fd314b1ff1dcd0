#include "app/schema/schema.h"

#include "app/schema/key_table.h"
#include "app/system/atomic_files.h"
#include "app/verbs/verbs.h"

#include <fmt/format.h>

namespace app {

int runVerbSchema(const Options& options, const Backends&)
{
    const std::string text = options.scene == "keys" ? keyTables() : options.scene == "study" ? studySchema() : sceneSchema();
    if (options.out.empty()) fmt::print("{}", text);
    else writeWhole(options.out, text);
    return 0;
}

}  // namespace app
