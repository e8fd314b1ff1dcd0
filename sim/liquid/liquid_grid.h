#pragma once

#include "sim/grid/face_fields.h"
#include "sim/grid/obstacle_field.h"

namespace sim {

/// The liquid's fields on the grid during a step. All of it is computed anew from the particles.
struct LiquidGrid {
    FaceFields faces;
    BlockBits<3> wet;                    ///< faces that carry liquid mass
    BlockArray<double, 3> flipVelocity;  ///< FLIP only: velocities straight after P2G [cm/s] …
    BlockBits<3> flipValid;              ///< … and where they mean something
    BlockArray<double> levelSet;         ///< signed distance to the liquid's surface at cell middles [cm]; < 0 exactly where there is a pressure
    BlockBits<> gaps;                    ///< cells whose particles meet faces without a velocity
    bool hasGaps = false;

    /// Three numbers per cell for whoever needs them between two loops: the momenta, once the velocities are known.
    double* scratch(int block, int kind = 0) { return faces.sums.block(block, FaceFields::kMomentum + kind); }

    void resize(int blocks, bool flip)
    {
        faces.velocity.resize(blocks);
        faces.valid.resize(blocks);
        wet.resize(blocks);
        levelSet.resize(blocks);
        gaps.resize(blocks);
        if (flip) flipVelocity.resize(blocks);
    }
};

}  // namespace sim
