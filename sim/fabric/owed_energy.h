#pragma once

#include "sim/energy_changes.h"
#include "sim/fabric/fabric.h"
#include "sim/fabric/groups.h"

#include <span>

namespace sim {

// What leads fabric where it cannot follow (pins that draw it into a solid) leaves it with energy that nothing gave. The fabric's motion pays for
// it; what that cannot pay stays owed (FabricState::owed), and later steps pay. Where more is owed than can ever be paid, fabric is jammed.

/// Work of pins, solids and the liquid on the fabric in a step [erg].
double externalWork(const EnergyChanges& changes);

/// Kinetic energy of what is not pinned, against the drift of groups that nothing holds, by which no force of the fabric can pay [erg]: the same
/// in every frame.
/// @param mass  of each vertex, with what it has absorbed [g]
double ownKinetic(const Fabric& fabric, const FabricGroups& groups, std::span<const double> mass, const FabricState& state);

/// Takes energy [erg] from the motion of ownKinetic, as far as there is any. Returns what it took.
double slowDown(double energy, const Fabric& fabric, const FabricGroups& groups, std::span<const double> mass, FabricState& state);

/// Pays the energy [erg] that is due with the motion; the rest is owed from now on. Returns what was paid.
double payOwed(double due, const Fabric& fabric, const FabricGroups& groups, std::span<const double> mass, FabricState& state);

/// Throws RunError if the fabric owes more than all of its motion has, and than can be let pass.
/// @param kinetic  energy of its motion, or of one that is not felt [erg]
void throwJammed(const Fabric& fabric, const FabricState& state, double kinetic);

}  // namespace sim
