#pragma once

#include "app/backends.h"

namespace app {

/// The whole program: command line to exit code. 0 done, 2 the user's mistake, 1 anything else; mistakes are told in one
/// line on standard error.
int runProgram(int argc, const char* const* argv, const Backends& backends);

}  // namespace app
