#pragma once

#include "sim/scene/node.h"

#include <string>
#include <vector>

namespace sim {

/// Gives keys of a scene that were called otherwise before (sim/renamed.h) their names and values of now, wherever they stand: in the
/// sections, in variants and changes, with dots between. Each is told in a note "file:line: X is called Y now".
/// Throws InputError where a key stands under both names.
void renameOldKeys(Node& root, std::vector<std::string>& notes);

/// What is lost where this share is kept [0..1]: the shortest number x for which 1 - x is that share; the nearest, where there is none.
std::string lostText(double kept);

}  // namespace sim
