#include "app/verbs/verbs.h"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

namespace app {

int runVerbCheck(const Options& options, const Parts& parts)
{
    const SceneSetup setup = parts.loadScene(options.request());
    for (const std::string& note : setup.scene.notes) spdlog::warn("{}", note);
    fmt::print("{}", setup.resolved);
    return 0;
}

}  // namespace app
