#pragma once

#include "sim/scene/scene.h"

namespace sim {

/// How much liquid a source holds at the start: its shape inside the domain and outside the obstacles.
struct RegionMeasure {
    double volume = 0.0;       ///< estimate [cm^3], a few percent of a thin body, 0.1 % of a thick one
    bool isUnbounded = false;  ///< reaches to infinity; volume is then meaningless
    bool isEmpty = false;      ///< certainly nothing, not only too small to be seen
};

RegionMeasure measureRegion(const Shape& source, const std::vector<ObstacleSettings>& obstacles,
                            const std::optional<Shape>& domain);

}  // namespace sim
