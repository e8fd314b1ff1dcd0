#pragma once

#include "sim/liquid/liquid_grid.h"

namespace sim {

/// A cell whose fill is at least this has a pressure. At a plane surface that is a cell whose middle is up to half a
/// cell above the liquid, so that no face beyond carries more than 2 % of a full one's mass; those move freely.
inline constexpr double kLiquidFill = 0.2;

/// Fill of every cell, from the masses on its open faces and their room; cells that are full enough get a pressure.
/// @param noAir  every cell with an open face has a pressure
void findLiquidCells(const CutGrid& cut, bool noAir, LiquidGrid& liquid);

/// Which liquid cells are beside air, and which are deep: neither that nor beside such a cell. Walls are no air.
void findSurface(const CutGrid& cut, LiquidGrid& liquid);

std::size_t countLiquidCells(const BlockGrid& grid, const LiquidGrid& liquid);

}  // namespace sim
