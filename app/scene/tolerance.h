#pragma once

#include "render/image_compare.h"

#include <string>
#include <vector>

namespace app {

/// How far apart results may be that count as the same: `compare.tolerance` of a scene, or a file of its own.
struct Tolerance {
    render::ImageTolerance pictures;
    double series = 0.0;              ///< tolerance of a number in a log or a report, relative to the largest of its column [-]
    std::vector<std::string> ignore;  ///< columns that are not judged, and those below them
    double position = 0.0;            ///< tolerance of a particle or vertex [cm]
    double velocity = 0.0;            ///< tolerance of a particle or vertex [cm/s]
    double mass = 0.0;                ///< tolerance of a particle, or that a vertex has absorbed [g]

    /// Nothing but the same states will do.
    bool wantsSameStates() const { return position == 0.0 && velocity == 0.0 && mass == 0.0; }
};

}  // namespace app
