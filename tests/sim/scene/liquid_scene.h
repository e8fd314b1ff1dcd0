#pragma once

#include "sim/scene/load_scene.h"

#include <string>
#include <vector>

// The smallest scenes with liquid, for the tests of reading them.

namespace sim::test {

inline const std::string kGrid = "grid: {cell: 0.1}\n";
inline const std::string kSource = "liquid: {sources: [{name: drop, shape: {ball: {center: [0, 0, 0], radius: 1}}}]}\n";
inline const std::string kSmallest = kGrid + kSource;

inline Scene load(const std::string& text, const std::string& variant = "", const std::vector<std::string>& set = {})
{
    return sim::readScene(sim::sceneFileFromText(text, "good.yaml", {variant, set}));
}

}  // namespace sim::test
