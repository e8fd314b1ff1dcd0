#pragma once

#include "sim/liquid/liquid_grid.h"
#include "sim/solvers/block_rows.h"

#include <vector>

namespace sim {

/// The symmetric positive system of one implicit step of viscosity on the faces of the liquid (Batty and Bridson 2008,
/// "Accurate Viscous Free Surfaces for Buckling, Coiling, and Rotating Liquids"; liquid/README.md, Viscosity): the minimum over u of
///     ½ Σ m (u − u*)² + dt μ Σ V |e(u)|²,  e = ½ (grad u + (grad u)ᵀ).
/// m are the masses that P2G put on the faces, so that the step conserves the momentum of the particles and takes
/// energy from them. Normal strains stand in the middles of cells, shears on their edges; the volume V of a strain is
/// the liquid on the faces it is made of. Where one of them has none, V is 0: a free surface pulls nowhere. What rigid
/// motions strain is 0 to rounding.
///
/// Faces behind walls are not unknown: they have the obstacle's velocity in normal strains. A wall that slips leaves
/// out the shears that reach behind it. On one that sticks, the liquid's velocity relative to it falls to 0 at the
/// wall's place between the two faces.
///
/// Fabric changes nothing here: with the room for liquid, the volume of its strains shrinks; drag is another matter.
struct ViscousSystem {
    BlockBits<3> unknown;             ///< faces with liquid that are not closed
    BlockBits<3> behind;              ///< closed faces, and those with their middles inside a wall that sticks
    std::vector<std::uint64_t> rows;  ///< rows of 8 along x that hold unknowns, a bit each; by block and axis
    BlockArray<double, 3> diagonal;   ///< diagonal of the matrix; 0 where a face is not unknown [g]
    BlockArray<double, 3> normal;     ///< 2 dt μ V / dx² of the normal strain along each axis in the middles of cells [g]
    BlockArray<double, 3> shear;      ///< dt μ V / dx² of the shear on each cell's lower edge along each axis [g]
    BlockArray<double, 3> wall;       ///< part of the diagonal by which walls that stick hold each face [g]; empty if they slip

    /// @param impulse   dt μ [g/cm]
    /// @param friction  0: walls slip … 1: they stick [-]
    void assemble(const CutGrid& cut, const LiquidGrid& liquid, double impulse, double friction);

    /// out = A v on the unknowns of one block, out untouched elsewhere. v must be finite everywhere and 0 where it is
    /// neither unknown nor a given velocity.
    void multiply(const BlockGrid& grid, const BlockArray<double, 3>& v, int block, BlockArray<double, 3>& out) const;

    std::uint64_t rowsOf(int block, int axis) const { return rows[static_cast<std::size_t>(block) * kAxes + axis]; }
    /// body(axis, index of its first cell) for the rows of a block with unknowns.
    template <class Body>
    void forEachUnknownRow(int block, Body&& body) const
    {
        for (int a = 0; a < kAxes; ++a) forEachRow(rowsOf(block, a), [&](int r) { body(a, r * kBlockEdge); });
    }
    bool hasUnknowns(int block) const { return (rowsOf(block, 0) | rowsOf(block, 1) | rowsOf(block, 2)) != 0; }
};

}  // namespace sim
