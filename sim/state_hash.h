#pragma once

#include "sim/state.h"

#include <cstdint>

namespace sim {

/// Hash of everything that evolves; equal for any number of threads.
std::uint64_t stateHash(const State& state);

}  // namespace sim
