#pragma once

#include "sim/core/types.h"
#include "sim/grid/block_grid.h"

#include <vector>

namespace sim {

/// What liquid does to each vertex in a step, with the liquid's velocity solved for (coupling/README.md, Mixture): M (v − v*) = impulse − drag v
/// beside the fabric's own forces, by components.
struct LiquidLoads {
    std::vector<Vec3> drag;     ///< Σ D' of the faces around; 0 where there is no liquid [g]
    std::vector<Vec3> impulse;  ///< Σ D' ũ of the liquid and of its pressure [g cm/s]
};

/// Loads of the liquid on the faces of a grid with the fabric's cells (coupling/README.md, Mixture).
struct FaceLoads {
    const BlockGrid& grid;
    const BlockArray<double, 3>& drag;     ///< D' [g]
    const BlockArray<double, 3>& impulse;  ///< D' ũ of the liquid and of its pressure [g cm/s]
};

/// Velocities of the fabric on the faces of a grid of its own [cm/s].
struct FabricFaces {
    const BlockGrid& grid;
    const BlockArray<double, 3>& velocity;
};

}  // namespace sim
