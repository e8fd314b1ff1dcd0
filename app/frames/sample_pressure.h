#pragma once

#include "sim/state.h"

namespace app {

/// Pressure of the last step at a place [dyn/cm^2]: trilinear between the middles of the cells that have one. Of the
/// cells around the place that have none - air, walls - the others take the share, so that the profile goes on up to
/// walls and the surface without a dip: at most half a cell of liquid off there. 0 where there is none, and before the
/// first step.
double smoothPressure(const sim::State& state, const sim::Vec3& place);

/// The same of any field that cells without a pressure have 0 of.
double smoothInLiquid(const sim::BlockGrid& grid, const sim::BlockArray<double>& field, const sim::Vec3& place);

}  // namespace app
