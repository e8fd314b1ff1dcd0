#include "app/verbs/verbs.h"

#include <fmt/format.h>

namespace app {

int runVerbCheck(const Options& options, const Backends& backends)
{
    const LoadedScene setup = backends.loadScene(options.request());
    logNotes(setup);
    fmt::print("{}", setup.resolved);
    return 0;
}

}  // namespace app
