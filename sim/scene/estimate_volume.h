#pragma once

#include "sim/scene/scene.h"

namespace sim {

/// How much liquid a source holds at the start: its shape inside the domain and outside the obstacles.
struct VolumeEstimate {
    double volume = 0.0;       ///< estimate [cm^3], a few percent of a thin body, 0.1 % of a thick one
    bool isUnbounded = false;  ///< reaches to infinity; volume is then meaningless
    bool isEmpty = false;      ///< certainly nothing, not only too small to be seen
};

/// Quick even for shapes of thousands of parts: the more parts, the coarser.
VolumeEstimate estimateVolume(const SourceSettings& source, const Scene& scene, std::size_t maxBoxes);

}  // namespace sim
