#pragma once

#include "sim/liquid/liquid_grid.h"

namespace sim {

/// A cell whose fill is at least this has a pressure. At a plane surface that is a cell whose middle is up to half a
/// cell above the liquid, so that no face beyond carries more than 2 % of a full one's mass; those move freely.
inline constexpr double kLiquidFill = 0.2;

// The order of a step is in the types: what a function needs of those before it, it takes as an argument that only they return. So it is here and
// in pressure.h. All of them hold until the next findLiquidCells for the same liquid.

/// Token that it is known how full the cells are, and which have a pressure.
class LiquidCells {
 public:
    const LiquidGrid& liquid() const { return *liquid_; }

 private:
    friend LiquidCells findLiquidCells(const CutGrid& cut, bool noAir, LiquidGrid& liquid);
    explicit LiquidCells(const LiquidGrid& liquid) : liquid_(&liquid) {}

    const LiquidGrid* liquid_;
};

/// Token that it is known, too, which of the cells are at the surface, and which are deep.
class SurfaceCells : public LiquidCells {
    friend SurfaceCells findSurface(const CutGrid& cut, const LiquidCells& cells, LiquidGrid& liquid);
    explicit SurfaceCells(const LiquidCells& cells) : LiquidCells(cells) {}
};

/// Fill of every cell, from the masses on its open faces and their room; cells that are full enough get a pressure.
/// @param noAir  every cell with an open face has a pressure
LiquidCells findLiquidCells(const CutGrid& cut, bool noAir, LiquidGrid& liquid);

/// Which liquid cells are beside air, and which are deep: neither that nor beside such a cell. Walls are no air, nor is what is beyond openings.
/// @param cells  of this liquid
SurfaceCells findSurface(const CutGrid& cut, const LiquidCells& cells, LiquidGrid& liquid);

std::size_t countLiquidCells(const BlockGrid& grid, const LiquidCells& cells);

}  // namespace sim
