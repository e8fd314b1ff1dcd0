#pragma once

#include "sim/grid/cut_grid.h"
#include "sim/grid/face_fields.h"

namespace sim {

/// The liquid's fields on the grid during a step. All of it is computed anew from the particles.
struct LiquidGrid {
    FaceFields faces;
    BlockBits<3> wet;                ///< faces that carry liquid mass
    BlockArray<double, 3> advected;  ///< velocities straight after P2G, of FLIP, of steps that reflect and of those that correct the strain [cm/s]
    BlockBits<3> advectedValid;      ///< faces on which these velocities mean something
    BlockArray<double, 3>
        unpressed;  ///< velocities when weight, not levelled, and viscosity have acted, but not yet pressure and surface tension [cm/s]
    BlockArray<double, 3> weightless;  ///< mass of each face near plane walls that images behind them hold against weight [g]
    double fullMass = 1.0;             ///< mass of a face with all its room, amid liquid [g]
    double pitch = 0.5;                ///< pitch of the particles' lattice [cells]
    BlockArray<double> fill;           ///< liquid in and around each cell relative to a cell amid liquid [-]
    BlockBits<> inside;                ///< cells with a pressure
    BlockBits<> surface;               ///< liquid cells beside air
    BlockBits<> deep;                  ///< liquid cells neither at the surface nor beside it
    BlockBits<> dry;                   ///< cells that are neither inside nor blocked by walls, also in blocks that do not exist
    bool hasOpenings = false;          ///< liquid passes faces of the domain
    BlockBits<> beyond;                ///< cells beyond the planes of openings, which have no pressure and are no air; only if `hasOpenings`
    BlockBits<3> atOpenings;           ///< faces in the planes of openings and beyond, whose velocities are the openings'; only if `hasOpenings`

    /// Three numbers per cell for whoever needs them between two loops: the momenta, once the velocities are known.
    double* scratch(int block, int kind = 0) { return faces.sums.block(block, FaceFields::kMomentum + kind); }

    void resize(int blocks, bool keepsAdvected)
    {
        faces.velocity.resize(blocks);
        faces.valid.resize(blocks);
        wet.resize(blocks);
        fill.resize(blocks);
        inside.resize(blocks);
        surface.resize(blocks);
        deep.resize(blocks);
        dry.resize(blocks);
        if (keepsAdvected) advected.resize(blocks);
    }
};

}  // namespace sim
