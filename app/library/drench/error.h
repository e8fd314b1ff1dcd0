#pragma once

#include <stdexcept>

namespace drench {

/// Why a call could not do what it was asked for, in one line. Beside it calls throw what a Motion throws, and std::bad_alloc.
struct Error : std::runtime_error {
    using std::runtime_error::runtime_error;
};

/// A mistake in a scene, a key, a formula or a file: "where: what, and what would do".
struct InputError : Error {
    using Error::Error;
};

/// A run that cannot go on: scene, step, time, stage, why, and what to try. The simulation can still be read.
struct RunError : Error {
    using Error::Error;
};

}  // namespace drench
