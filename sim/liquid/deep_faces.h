#pragma once

#include "sim/liquid/free_liquid.h"

namespace sim {

/// Faces between deep cells count as full (findPressureFaces), which is no more than the noise of the particles' places away from what P2G put
/// there; but with that noise the pressure turns the liquid a little, for what it does to faces is carried by the masses that they have. Where
/// a solid holds the liquid it bears the difference, and a pool under its weight stays at rest only if it is even. Liquid that nothing holds has
/// no weight to bear: its deep faces weigh what they weigh, and it keeps its angular momentum to rounding (liquid/README.md, Free liquid).
///
/// Changes the coefficients of the deep faces of free bodies.
/// @return are there any? Then the matrix of these faces has to be assembled anew.
bool weighDeepFaces(const CutGrid& cut, const HeldBodies& bodies, PressureFaces& faces);

}  // namespace sim
