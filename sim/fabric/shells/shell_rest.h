#pragma once

#include "sim/fabric/fabric.h"
#include "sim/fabric/shells/shell_kernel.h"

namespace sim {

/// Constants of one triangle of the fabric with the vertices across its edges (−1 on the boundary).
ShellRest<double> shellRest(const Fabric& fabric, int face, const std::array<int, 3>& across, const FabricSettings& settings);

/// One triangle's constants into a lane of a pack.
void setLane(ShellRest<Pack>& rest, int lane, const ShellRest<double>& one);

}  // namespace sim
