#include "app/verbs/verbs.h"

#include <fmt/format.h>

namespace app {

int runVerbCheck(const Options& options, const Parts& parts)
{
    fmt::print("{}", parts.loadScene(options.request()).resolved);
    return 0;
}

}  // namespace app
