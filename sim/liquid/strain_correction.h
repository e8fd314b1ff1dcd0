#pragma once

#include "sim/liquid/pressure.h"

namespace sim {

/// What the strain correction needs beside the pressure's system.
struct StrainWorkspace {
    BlockArray<double, 3> viscous;  ///< where viscosity acts: velocities after P2G and it, without weight [cm/s]
    BlockBits<3> acts;              ///< faces on which it may act: those that liquid shares with fabric are left out
    BlockArray<double, 3>
        inverseMass;  ///< 1/m̂ of each lower face; 0 where it is closed, kNoMass where it has no part in the correction; relative to full ones [-]
    BlockArray<double, 3> impulse;  ///< a: by how much weight, pressure and surface tension changed the velocity, the latter by the masses m̂ [cm/s]
    BlockArray<double, 3> stretch;  ///< m̂/4 times the step of that from the lower to the upper face of each cell, by axes [cm/s]
    BlockArray<double, 3> shear;    ///< stretching by shear, m̂/8, around the lower edges of each cell, by their direction [cm/s]
};

/// Velocities that do not count the stretching of the liquid within the reach of a B-spline as inertia (liquid/README.md, Surface of second
/// order): u += α² M⁻¹ L a with the change a of velocities by weight, pressure and surface tension, the variance α² = h²/4 of the spline, and uᵀ L u
/// the mass times the square of the strain of u. L takes no account of rigid motion, so that momentum and angular momentum stay, and amid liquid it
/// makes a gradient of a gradient. What comes out has a divergence that the pressure must take out again.
///
/// To leave weight out would be the same where there is no solid, for it strains nothing; but only together with the pressure that
/// holds against it does it nothing to liquid at rest between solids, whose faces are at rest.
///
/// @param before     velocities without weight, pressure and surface tension [cm/s]
/// @param work       `acts` is given, the rest is scratch
/// @param liquid     velocities of faces in the system are changed
void correctStrain(const CutGrid& cut, const BlockArray<double, 3>& before, const PressureFaces& faces, StrainWorkspace& work, LiquidGrid& liquid);

}  // namespace sim
