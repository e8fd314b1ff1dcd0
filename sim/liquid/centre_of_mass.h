#pragma once

#include "sim/liquid/pressure.h"

#include <vector>

namespace sim {

/// What displacements of faces do to the centres of mass of pieces of liquid.
struct CentreWorkspace {
    /// Liquid that is one component of the pressure system.
    struct Body {
        Vec3 mass = Vec3::Zero();   ///< of its faces, by axes [g]
        Vec3 moved = Vec3::Zero();  ///< sum of mass and displacement [g cm]
        bool isHeld = false;        ///< a solid or fabric is on one of its faces
    };
    BlockBits<3> unheld;        ///< faces on which there is neither
    std::vector<Body> bodies;   ///< by their number among all components
    std::vector<Body> ofBlock;  ///< sums over blocks that belong to one body
};

/// Faces that no solid closes, not even in part. The caller takes out those that fabric is on.
void findUnheldFaces(const BlockGrid& grid, const ObstacleField& obstacles, CentreWorkspace& work);

/// Shift the displacements of each piece of liquid that nothing holds by what brings its centre of mass back to where it was. Gradients of a
/// potential that is 0 around the piece leave it there by themselves; shortened ones do not.
void keepCentresOfMass(const BlockGrid& grid, const PressureWorkspace& pressure, const LiquidGrid& liquid, CentreWorkspace& work,
                       BlockArray<double, 3>& displacement);

}  // namespace sim
