#pragma once

#include "sim/grid/obstacle_field.h"

#include <vector>

namespace sim {

/// Keeps the pressure from giving energy to faces that solids close more of than they take of their mass. The projection is orthogonal where a face
/// weighs what is open of it; but it weighs the room that solids leave it, so that liquid which is pressed through a narrow opening would take
/// along what is behind the solid for nothing (Ng, Min and Gibou 2009, "An efficient fluid-solid coupling algorithm for single-phase flows", weighs
/// by what is open; here it is by room, for the rest of liquid at slanted walls: liquid/README.md, Openings). Of the energy that the projection
/// gives to a face, seen from its wall, open/room is the face's: where walls move always, else where all such faces together have gained any.
class GainAtWalls {
 public:
    /// Velocities before the pressure [cm/s].
    void begin(const ObstacleField& field, const BlockArray<double, 3>& velocity);
    /// Velocities after it, whose gain is bounded.
    void bound(const ObstacleField& field, BlockArray<double, 3>& velocity) const;

 private:
    std::vector<int> blocks_;       ///< those in which some face is less open than heavy, or the other way round
    BlockArray<double, 3> before_;  ///< velocities of these blocks, in their order [cm/s]
};

}  // namespace sim
