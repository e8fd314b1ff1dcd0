#pragma once

#include "sim/scene/node.h"
#include "sim/shapes/motion.h"
#include "sim/shapes/shape.h"

#include <string>
#include <vector>

namespace sim {

/// A shape, and the same in the words of a scene (cgs, one line), which read back to it.
struct ReadShape {
    Shape shape;
    std::string text;
    std::vector<std::string> notes = {};  ///< "drop.yaml:14: …": what was mended in meshes
};

/// Builds a shape from {box: …}, {union: [..]}, … with optional `rotate` and `translate`.
/// @param path  names it in messages, like "liquid.sources.column.shape"
/// @param cell  grid cell [cm]; meshes are sampled at half of it unless they say otherwise
ReadShape readShape(const Node& node, const std::string& path, double cell);

/// "box", "ball", …: the keys that say what body a shape is.
const std::vector<std::string>& shapeKinds();

struct ReadMotion {
    Motion motion;
    std::string text;
};

/// Builds a motion from one piece {t: [0, 1], translate: …}, or a list of pieces that act one after another.
ReadMotion readMotion(const Node& node, const std::string& path);

}  // namespace sim
