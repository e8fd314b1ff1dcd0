#pragma once

#include "sim/liquid/pressure.h"

namespace sim {

struct ReflectionWorkspace {
    BlockArray<double, 3> velocity;  ///< r [cm/s]
    BlockBits<3> valid;              ///< faces on which r means something
    BlockArray<double> potential;
    BlockArray<double> atSurface;  ///< pressure at the surface that each of its cells has [dyn/cm^2]
};

/// Liquid that solids or fabric hold, whose surface moves in the step that is reflected.
struct MovingSurface {
    const BlockBits<>& held;  ///< its cells
    const Vec3* frames;       ///< velocities by blocks of what holds it [cm/s]; null where all rests
    double density;           ///< density of the liquid [g/cm^3]
    double dt;                ///< [s]
};

/// Advection-reflection after Zehnder, Narain and Thomaszewski 2018, for liquid with a surface and with weight
/// (liquid/README.md, Reflection): r = u + (P(u*) − u*), with u the velocities that solvePressure just left and u* those straight
/// after P2G. Only the divergence that advection made is reflected: what gravity and its pressure do to u stays as it
/// is. Particles that gather r and move with u make of this step and the next, a plain one of the same length, a
/// method of second order, if P has the pressure at the surface that its motion between them asks for.
SolveReport reflect(const CutGrid& cut, const SolverSettings& solver, std::span<const InflowCell> inflow, const PressureSystem& system,
                    const MovingSurface& surface, ReflectionWorkspace& work);

}  // namespace sim
