#pragma once

#include "sim/liquid/pressure.h"
#include "sim/shapes/shape.h"

namespace sim {

/// Where a source has pressed liquid into liquid, which the projection is to move aside.
struct Inflow {
    std::size_t source = 0;
    Shape mouth;          ///< part of the source outside of obstacles
    double volume = 0.0;  ///< volume for which this step is to make room, spread evenly [cm^3]
};

/// The cells of the pressure system in which sources have pressed liquid into liquid, in the order of the inflows: the volume of each is spread over
/// the cells of its mouth that have a pressure, by their shares of it.
/// @param packing  mass of a full cell relative to the density of the liquid times its volume [-]
void findInflowCells(const BlockGrid& grid, const LiquidCells& liquidCells, const std::vector<Inflow>& inflows, double packing, double dt,
                     std::vector<InflowCell>& cells);

/// Work of the pressure on what came in over a step [erg]: the projection takes from the kinetic energy what it takes without inflow, and adds this.
double inflowWork(const BlockGrid& grid, const std::vector<InflowCell>& cells, const BlockArray<double>& pressure, double dt);

/// Has the liquid in a source's mouth nowhere to go? So it is if all cells of the mouth belong to pieces of the pressure system without air that are
/// as full as they can be. Of a mouth without such cells: no.
bool isShutIn(std::size_t source, const std::vector<InflowCell>& cells, const BlockGrid& grid, const PressureComponents& system);

}  // namespace sim
