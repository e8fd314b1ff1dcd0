#pragma once

#include "sim/core/types.h"

#include <limits>
#include <string>

namespace sim {

/// A face of the domain through which liquid comes in or goes out (liquid/README.md, Faces of the domain).
struct OpeningSettings {
    std::string name;
    int axis = 0;           ///< axis that the face is normal to
    bool isUpper = false;   ///< the face is at the upper end of the domain along it
    double velocity = 0.0;  ///< mean velocity of what comes in; 0: an outlet [cm/s]
    double level =
        std::numeric_limits<double>::infinity();  ///< height of the liquid beyond the face, against gravity; infinite: all of the face [cm]
    std::string where;                            ///< "flume.yaml:14", for messages

    bool isInlet() const { return velocity > 0.0; }
    double outward() const { return isUpper ? 1.0 : -1.0; }  ///< direction of the outer normal along the axis [-]
};

/// What an opening remembers from step to step.
struct OpeningMemory {
    double moved = 0.0;    ///< inlet: how far its liquid has gone since its last layer had just come in [cm]
    double mean = 0.0;     ///< outlet: slow mean of the velocity at which liquid goes out [cm/s]
    double isKnown = 0.0;  ///< 1 once there was a velocity to begin that mean with; else 0
};

}  // namespace sim
