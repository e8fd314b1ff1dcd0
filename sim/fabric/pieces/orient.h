#pragma once

#include "sim/core/types.h"

#include <string>
#include <vector>

namespace sim {

/// Turns faces over until neighbours run along their common edge in opposite directions; of each connected part the
/// first face stays. Returns what makes that impossible, "" if nothing does: an edge of three faces, or a surface with
/// one side only.
/// @param names  of the vertices, for what it returns; empty: their numbers
[[nodiscard]] std::string orientAlike(std::vector<Vec3i>& faces, const std::vector<int>& names = {});

}  // namespace sim
