#pragma once

#include "sim/coupling/porous_law.h"
#include "sim/coupling/sorted_vertices.h"
#include "sim/liquid/liquid_grid.h"

#include <span>

namespace sim {

/// Capillary suction of fabric on the liquid around: P = P_c (1 − S) in the cells that vertices reach (coupling/README.md, Suction). S is how full a
/// cell is, or its fabric's pores, whichever is more: what is wet through does not draw, nor does what is under liquid.
class Suction {
 public:
    Suction(const Fabric& fabric, const Settings& settings);

    /// @param liquidBlock  the liquid's block for each of the vertices', or BlockGrid::kNone
    void find(const SortedVertices& vertices, const FabricState& state, const BlockGrid& grid, std::span<const int> liquidBlock,
              const LiquidGrid& liquid);
    /// dP/da at the lower face of a cell along an axis [dyn/cm^3].
    double slope(const BlockGrid& grid, int block, int axis, int cell) const;
    /// What draws is drawn: each vertex gets, by its own part of P in the cells that it reaches, the opposite of what it makes of slopes. All
    /// vertices together get what liquid gets, and none more than goes with its volume, however little of it a face with much liquid has.
    /// @param perSlope  of each face: impulse on its liquid for a slope of 1 [g cm/s per dyn/cm^3]
    /// @param impulse   of each vertex [g cm/s]
    void applyReaction(const SortedVertices& vertices, const BlockArray<double, 3>& perSlope, std::span<Vec3> impulse);

 private:
    double pullOf(std::size_t vertex) const;

    enum Kind { kFibres, kPull, kPores, kHeld, kKinds };  ///< fibres [cm^3], they times P_c (1 - φ)/φ [dyn cm], pores, what they hold [cm^3]

    const Fabric& fabric_;
    std::vector<double> strength_;  ///< of each material: P_c (1 - φ)/φ of its pores [dyn/cm^2]
    double density_;                ///< of the liquid [g/cm^3]
    BlockArray<double, kKinds> volumes_;
    BlockArray<double> suction_;  ///< of each cell [dyn/cm^2]
    BlockArray<double, 3> back_;  ///< of each cell: impulse for a pull of 1 [g cm/s per dyn cm]
};

}  // namespace sim
