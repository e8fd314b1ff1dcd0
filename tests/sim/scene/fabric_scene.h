#pragma once

#include "sim/scene/load_scene.h"

#include <string>
#include <vector>

// Scenes with one piece of fabric, for the tests of reading it.

namespace sim::test {

inline Scene load(const std::string& text, const std::vector<std::string>& set = {})
{
    return sim::readScene(sim::sceneFileFromText(text, "good.yaml", {"", set}));
}

inline const std::string kBegin = "grid: {cell: 0.1}\nmaterials: {wool: {young: 6.6e+7, density: 1.32, volume_fraction: 0.4}}\n";

inline FabricPiece piece(const std::string& text) { return load(kBegin + "fabrics: [{name: it, " + text + "}]\n").fabrics.at(0); }

}  // namespace sim::test
