#pragma once

#include "sim/liquid/pressure.h"

namespace sim {

struct VolumeWorkspace {
    BlockArray<double> potential;
    BlockArray<double, 3> displacement;  ///< displacement of the lower faces [cm]
};

/// Error of a cell's volume that is not corrected, relative to its own: that is the noise of particles at rest on their lattice, and to mend it
/// would lift them for nothing, again and again [-].
inline constexpr double kVolumeNoise = 0.005;

/// Where solids leave the open faces of a cell the share r of their room, noise is more by kCutOffNoise pitch^3 (1 / r - 1), with the particles'
/// pitch in cells: twice the standard deviation over lattices that walls of any direction cut, at pitches from .3 to .5; kMostCutOffNoise at most
/// [-].
inline constexpr double kCutOffNoise = 0.6, kMostCutOffNoise = 0.25;

/// Farthest that one correction moves anything [cells].
inline constexpr double kLargestCorrection = 0.2;

/// Displacements that bring the liquid back to its volume: cells that hold too much expand, holes amid the liquid close
/// (implicit density projection after Kugelstadt et al. 2019, for the errors that advection leaves behind). They are
/// the gradient of a potential in the matrix of the pressure, left in work.displacement; velocities, and so
/// all momenta and the kinetic energy, stay as they are.
/// @param settings  of which the direction of gravity tells ceilings, from which liquid may come off
/// @param strength  share of the error that is corrected at once [0..1]
SolveReport correctVolume(const CutGrid& cut, const Settings& settings, double strength, const PressureSystem& system, VolumeWorkspace& work);

}  // namespace sim
