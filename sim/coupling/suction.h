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
    /// Reaction of suction on the vertices: minus the derivative of P with respect to their position, capped by volume. All vertices together get the
    /// opposite of what the liquid gets.
    /// @param perSlope  impulse of each face on its liquid for a slope of 1 [g cm/s per dyn/cm^3]
    /// @param impulse   impulse on each vertex [g cm/s]
    void applyReaction(const SortedVertices& vertices, const BlockArray<double, 3>& perSlope, std::span<Vec3> impulse);

 private:
    double pullOf(std::size_t vertex) const;

    enum Kind { kFibres, kPull, kPores, kHeld, kKinds };  ///< fibres [cm^3], they times P_c (1 - φ)/φ [dyn cm], pores, what they hold [cm^3]

    const Fabric& fabric_;
    std::vector<double> strength_;  ///< P_c (1 - φ)/φ of each material's pores [dyn/cm^2]
    double density_;                ///< density of the liquid [g/cm^3]
    BlockArray<double, kKinds> volumes_;
    BlockArray<double> suction_;  ///< P of each cell [dyn/cm^2]
    BlockArray<double, 3> back_;  ///< impulse for a pull of 1 in each cell [g cm/s per dyn cm]
};

}  // namespace sim
