#pragma once

#include "sim/scene/key_list.h"
#include "sim/scene/node.h"

#include <functional>
#include <string>
#include <vector>

namespace app {

/// Keys of a map that only its reader knows: it is given a text to read, and is asked which keys it looked for in the last map that it
/// came to. What it thinks of the text does not count.
std::vector<sim::DeclaredKey> keysReadBy(const std::string& text, const std::function<void(const sim::Node&)>& read);

}  // namespace app
