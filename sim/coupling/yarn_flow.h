#pragma once

#include "sim/fabric/fabric.h"
#include "sim/settings.h"

#include <vector>

namespace sim {

/// Drag per volume of yarns and relative speed on liquid that flows around them [g/(cm^3 s)].
struct DragAround {
    double along, across;
};

/// Drag of a long cylinder across a flow: C_D = 1 + 10 Re^(-2/3), White, Viscous Fluid Flow (3rd ed., eq. 3-225). In creeping flow, Re below
/// kCreeping, drag is linear; along the cylinder it is half of that (Batchelor 1970).
/// @param diameter   of the yarn [cm]
/// @param narrowing  mean speed in the gaps that neighbours leave, over that far away, squared [-]
/// @param speed      of the liquid past the yarn [cm/s]
DragAround dragAround(const LiquidSettings& liquid, DragLaw law, double diameter, double constriction, double speed);

/// Diameter of each vertex's yarns, that of a circle as large as the section; 0 where there are none [cm].
std::vector<double> yarnDiameters(const Fabric& fabric);

/// Constriction 1/(1 - s)² at each vertex, with the part s of the view along the fabric's normal that neighbouring yarns cover; 1 at a lone yarn.
/// Yarns within kReach diameters count, as two crossing sets of which each covers half of c: s = 1 - (1 - c/2)².
std::vector<double> constrictions(const Fabric& fabric, const std::vector<double>& diameter);

}  // namespace sim
