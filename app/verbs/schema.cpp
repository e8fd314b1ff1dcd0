#include "app/schema/schema.h"

#include "app/system/atomic_files.h"
#include "app/verbs/verbs.h"

#include <fmt/format.h>

namespace app {

int runVerbSchema(const Options& options, const Parts&)
{
    const std::string schema = options.scene == "study" ? studySchema() : sceneSchema();
    if (options.out.empty()) fmt::print("{}", schema);
    else writeWhole(options.out, schema);
    return 0;
}

}  // namespace app
