#pragma once

#include "sim/fabric/block_matrix.h"
#include "sim/fabric/grid/block_points.h"
#include "sim/fabric/rods/strand_matrix.h"
#include "sim/fabric/triple.h"

#include <array>
#include <span>
#include <vector>

namespace sim {

/// What stiffness K of the vertices does to fields that are smooth, as those of a grid are whose cells hold several vertices. A field w
/// along axis a with the slope z at each vertex has wᵀ K w = Σ zᵀ B z, with B = B(a) of six components each: xx, yy, zz, xy, yz, zx.
/// Neighbours nearly cancel: K's diagonal alone would make a grid's field several times too stiff. Vertices that are farther apart than
/// a cell do not: what ties them acts on w itself.
class SlopeForms {
 public:
    /// @param vertices  of each row of `cloth`
    /// @param x         of each vertex [cm]
    /// @param cell      of the grid [cm]
    void assemble(const StrandLayout& layout, const StrandMatrix& strands, std::span<const int> vertices, const BlockMatrix& cloth,
                  std::span<const Vec3> x, double cell);

    /// Component i of B(a) of a vertex, at 6 a + i [dyn cm].
    double slope(int component, int vertex) const { return form_.of[component][vertex]; }
    /// What acts on w itself [dyn/cm].
    Vec3 value(int vertex) const {
        return {form_.of[kSlopes][vertex], form_.of[kSlopes + 1][vertex], form_.of[kSlopes + 2][vertex]};
    }

 private:
    void addCloth(std::span<const int> vertices, const BlockMatrix& cloth, std::span<const Vec3> x);
    void findOnStrands(const StrandLayout::Group& group, const StrandLayout& layout, const StrandMatrix& strands, std::span<const Vec3> x);

    static constexpr int kSlopes = 18, kNumbers = kSlopes + kAxes;

    double farthest_ = 0.0;                                ///< neighbours of which slopes tell [cm]
    PointArray<kNumbers> form_;                            ///< of each vertex: its forms, then values
    std::vector<std::array<Pack, kNumbers>> onStrands_;    ///< of each packed vertex
};

}  // namespace sim
