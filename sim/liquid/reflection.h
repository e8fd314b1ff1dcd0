#pragma once

#include "sim/liquid/pressure.h"

namespace sim {

struct ReflectionWorkspace {
    BlockArray<double, 3> velocity;  ///< r [cm/s]
    BlockBits<3> valid;              ///< faces on which r means something
    BlockArray<double> potential;
};

/// Advection-reflection after Zehnder, Narain and Thomaszewski 2018, for liquid with a surface and with weight
/// (liquid/README.md, Reflection): r = u + (P(u*) − u*), with u the velocities that solvePressure just left and u* those straight
/// after P2G. Only the divergence that advection made is reflected: what gravity and its pressure do to u stays as it
/// is. Particles that gather r and move with u make of this step and the next, a plain one of the same length, a
/// method of second order.
SolveReport reflect(const CutGrid& cut, const SolverSettings& solver, std::span<const InflowCell> inflow, const PressureSystem& system,
                    ReflectionWorkspace& work);

}  // namespace sim
