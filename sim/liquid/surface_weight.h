#pragma once

#include "sim/liquid/free_liquid.h"
#include "sim/liquid/liquid_on_solids.h"
#include "sim/liquid/pressure_beyond.h"

namespace sim {

/// Weight of the liquid's surface layer without the noise of the particles' places.
///
/// Faces between deep cells count as full; those of the layer above carry what particles brought there, and where that is more than full the
/// layer is heavier than the liquid below it: it sinks as in a Rayleigh-Taylor instability, and a pool at rest begins to move. So in each
/// column of faces along gravity, from the first that is not deep up to the air, weight is put where the particles of the column would leave it if
/// it were even: each face bears what its B-spline has below the level. A face without pressure above them has none, instead of falling into the
/// liquid: the pressure in the cell under it bears it (PressureBeyond). A column weighs what it did, so that the pressure below it, and all momentum,
/// are the same; inertia stays where it is, so that the projection stays orthogonal in the kinetic energy.
///
/// Weight is moved only in bodies that solids hold: in others nothing presses. Columns with fabric in them, thicker
/// than kSurfaceColumn, or on nothing deep or solid stay as they are.
/// @param gravityStep  velocity that weight has given to all faces in this step [cm/s]
/// @param liquid       velocity is changed; `unpressed` is not, for what weight and pressure together do is what moves liquid
/// @param onSolids     is told, if not null, for what weight gives is not from solids
void levelWeight(const CutGrid& cut, const HeldBodies& bodies, const Vec3& gravityStep, LiquidGrid& liquid, LiquidOnSolids* onSolids,
                 PressureBeyond& beyond);

/// Share of the mass of even liquid below a level that a face's quadratic B-spline, so many cells below it, has of its own [-].
double shareBelow(double cells);

/// Faces that a column of the surface layer may have. A plane surface has at most four: two cells that are not deep, and the surface's own.
inline constexpr int kSurfaceColumn = 5;

}  // namespace sim
