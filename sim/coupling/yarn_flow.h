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
/// @param diameter      of the yarn [cm]
/// @param constriction  drag across yarns with neighbours over that of lone ones [-]
/// @param speed         of the liquid past the yarn [cm/s]
DragAround dragAround(const LiquidSettings& liquid, DragLaw law, double diameter, double constriction, double speed);

/// Diameter of each vertex's yarns, that of a circle as large as the section; 0 where there are none [cm].
std::vector<double> yarnDiameters(const Fabric& fabric);

/// Constriction (1 + √α)(1 + α)/(4 α²) at each vertex, with the part α of the view along the fabric's normal that neighbouring yarns leave open; 1 at a
/// lone yarn. With it a square weave has the head of measured screens, C_D (1 - α²)/(2 α²) (Blevins 1984 with 2 β for C_D). Yarns within kReach
/// diameters count, as two crossing sets of which each covers half of c: α = (1 - c/2)².
std::vector<double> constrictions(const Fabric& fabric, const std::vector<double>& diameter);

}  // namespace sim
