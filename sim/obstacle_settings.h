#pragma once

#include "sim/shapes/motion.h"
#include "sim/shapes/shape.h"

#include <optional>
#include <string>
#include <vector>

namespace sim {

/// A solid as a scene describes it.
struct ObstacleSettings {
    std::string name;
    Shape shape;  ///< the solid itself: already inverted where the scene says `inside: true`
    Motion motion;
    bool inside = false;                  ///< the scene said `inside: true`
    bool collide = true;                  ///< fabric feels it
    bool cohesive = true;                 ///< fabric that is wet sticks to it, if there is cohesion
    std::optional<double> frictionAngle;  ///< friction angle of fabric on it; without: the fabric's own [rad]
    std::string where;                    ///< "drop.yaml:14", for messages
    std::string shapeText;                ///< the shape (before inverting) as a scene says it, in cgs, on one line
    std::vector<std::string> notes;       ///< notes about its meshes
    std::string motionText;               ///< the motion as a scene says it, in cgs, on one line; empty if static
};

}  // namespace sim
