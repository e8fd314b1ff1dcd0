#pragma once

#include "sim/liquid/free_liquid.h"
#include "sim/liquid/liquid_on_solids.h"
#include "sim/liquid/pressure_beyond.h"

#include <algorithm>
#include <cmath>

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

/// Depth [cells] of which even liquid has the pressure in a cell whose middle is so many cells below its level: that of its middle, rounded off
/// within a cell of the level, by which the differences of neighbours are what quadratic B-splines of faces have below the level.
double depthOfPressure(double cells);

/// Weight of faces of one axis amid even liquid: the difference of its pressure from cell to cell, relative to that amid the liquid.
class EvenWeight {
 public:
    /// @param slope  gravity along the axis relative to that along the axis that it is nearest to, -1 to 1 [-]
    explicit EvenWeight(double slope) : half_(0.5 * std::clamp(std::abs(slope), 1e-3, 1.0)) {}

    /// Share of its weight that a face has, so many cells below the level along the axis that gravity is nearest to [-].
    double share(double cells) const { return (depthOfPressure(cells + half_) - depthOfPressure(cells - half_)) / (2.0 * half_); }
    /// Derivative of the share [1/cell].
    double slope(double cells) const;

 private:
    double half_;  ///< half of what the depth changes by from cell to cell; 1/2 where gravity is along the axis [cells]
};

/// Faces that a column of the surface layer may have. A plane surface has at most four: two cells that are not deep, and the surface's own.
inline constexpr int kSurfaceColumn = 5;
/// With gravity between the axes splines reach three cells further per slope of the surface, which is at most the root of two.
inline constexpr int kMostSurfaceColumn = kSurfaceColumn + 5;

}  // namespace sim
