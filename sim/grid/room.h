#pragma once

#include "sim/grid/obstacles.h"

#include <array>

namespace sim {

/// What is open of the parts of a block's cells, and of those around that the B-splines of its faces reach.
struct OpenParts {
    static constexpr int kRim = 2;    ///< cells around the block
    static constexpr int kParts = 2;  ///< number of parts of a cell along an axis, which a surface cuts as a plane would
    static constexpr int kEdge = kParts * (kBlockEdge + 2 * kRim);

    /// A value for each part.
    using OfParts = std::array<double, kEdge * kEdge * kEdge>;
    static int indexOf(const Vec3i& c) { return (c.z() * kEdge + c.y()) * kEdge + c.x(); }

    OfParts share;                      ///< [-]
    std::array<OfParts, kAxes> moment;  ///< first moments about the middle of the part [edges of a part]
};

/// Memory in which rooms are found, one for each thread.
struct RoomScratch {
    OpenParts open, smoothed;
};

/// How much of the quadratic B-spline of each lower face of a block lies outside the solids, from the open volume of
/// the parts of cells around (each is cut by the plane whose distance from its middle is the obstacle's).
/// @param mirrors  what is behind a plane wall in a plane of faces is the mirror image of what is in front
/// @param scratch  whose contents never outlive the call
/// @param room     out: 512 values [-] for each axis, one axis after another
void roomOfFaces(const BlockGrid& grid, int block, const Obstacles& obstacles, bool mirrors, RoomScratch& scratch, double* room);

}  // namespace sim
