#pragma once

#include <cstdio>
#include <cstdlib>
#include <stdexcept>
#include <string>

namespace sim {

/// The user's mistake (scene, command line, file): one line "where: what, and what would do". Exit code 2.
struct InputError : std::runtime_error {
    using std::runtime_error::runtime_error;
};

/// A run that cannot go on; the message names the scene, step, stage and why. Exit code 1.
struct RunError : std::runtime_error {
    using std::runtime_error::runtime_error;
};

}  // namespace sim

/// Our own invariant. Checked in every build but release (DRENCH_CHECKS); prints and aborts.
#ifdef DRENCH_CHECKS
#define SIM_CHECK(condition)                                                                       \
    do {                                                                                           \
        if (!(condition)) {                                                                        \
            std::fprintf(stderr, "%s:%d: broken invariant: %s\n", __FILE__, __LINE__, #condition); \
            std::abort();                                                                          \
        }                                                                                          \
    } while (false)
#else
#define SIM_CHECK(condition) static_cast<void>(0)
#endif
