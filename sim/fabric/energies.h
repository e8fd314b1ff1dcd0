#pragma once

#include "sim/fabric/rods/rods.h"
#include "sim/fabric/shells/shells.h"
#include "sim/step_report.h"

namespace sim {

/// Kinetic, potential and elastic energies (model-fabric 6.6); what contact and pins hold is not among them.
FabricEnergies fabricEnergies(const Fabric& fabric, const FabricState& state, const Rods& rods, const Shells& shells,
                              const Vec3& gravity);

}  // namespace sim
