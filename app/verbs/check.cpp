#include "app/verbs/verbs.h"

#include <fmt/format.h>

namespace app {

int runVerbCheck(const Options& options, const Parts& parts)
{
    const SceneSetup setup = parts.loadScene(options.request());
    tellNotes(setup);
    fmt::print("{}", setup.resolved);
    return 0;
}

}  // namespace app
