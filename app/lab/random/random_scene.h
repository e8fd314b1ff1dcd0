#pragma once

#include "sim/core/types.h"

#include <Eigen/Geometry>

#include <cstdint>
#include <optional>
#include <string>

namespace app {

/// "random_1_17"
std::string randomSceneName(std::uint64_t seed, int number);

struct RandomScene {
    std::string text;                           ///< text of the scene file
    std::optional<Eigen::AlignedBox3d> vessel;  ///< a closed one with thin walls that everything is in
};

/// A scene of liquid, fabric and moving obstacles: some hundred to some thousand particles
/// and vertices for some tens of steps, with any of the program's methods and numbers far outside of what one would
/// choose: also on edges, thin plates and fast solids, and with sources under water. The same for the same seed and number, on any machine; always
/// one that `drench check` accepts.
RandomScene randomScene(std::uint64_t seed, int number);

}  // namespace app
