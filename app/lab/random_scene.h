#pragma once

#include <cstdint>
#include <string>

namespace app {

/// "random_1_17"
std::string randomSceneName(std::uint64_t seed, int number);

/// A scene of liquid, fabric and moving obstacles as the text of a scene file: some hundred to some thousand particles
/// and vertices for some tens of steps, with any of the program's methods and numbers far outside of what one would
/// choose. The same for the same seed and number, on any machine; always one that `drench check` accepts.
std::string randomScene(std::uint64_t seed, int number);

}  // namespace app
