#pragma once

#include "sim/state.h"

#include <cstdint>

namespace sim {

/// Hash of everything that evolves but the memory of steps, by which two states that are the same may yet differ: one that a bad step was
/// taken back to, say. Equal for any number of threads.
std::uint64_t stateHash(const State& state);

}  // namespace sim
