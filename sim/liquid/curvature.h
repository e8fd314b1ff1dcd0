#pragma once

#include "sim/grid/cut_grid.h"
#include "sim/grid/face_fields.h"
#include "sim/liquid/cells.h"

#include <cstdint>
#include <vector>

namespace sim {

/// Curvature of the liquid's surface, from the fill of the cells around it.
///
/// The fill is smoothed by passes of (1 4 1)/6 along each axis and then sharpened by a part of its Laplacian, so that
/// the spread of kernel, B-splines and differences moves a curved surface in fourth order of (width / radius) only. On
/// the smooth colour c that this gives, n = −∇c / |∇c| and κ = ∇·n (Brackbill, Kothe and Zemach 1992), positive where
/// the liquid is convex. Walls mirror: the surface meets them at right angles. Walls in blocks that no liquid reaches
/// are not seen.
class Curvature {
 public:
    /// Curvature around all cells at the surface.
    /// @param passes  of smoothing; each adds a third of a cell squared to the kernel's variance
    void find(const CutGrid& cut, const SurfaceCells& cells, int passes);

    /// Where the surface, c = ½, crosses the line between the middles of a liquid cell and of an air cell beside it,
    /// both relative to `block` of the liquid's grid [1/cm]. At most that of a ball of one cell's radius.
    double between(int block, const Vec3i& liquidCell, const Vec3i& airCell) const;

 private:
    void fitTo(const BlockGrid& grid);
    void takeFill(const ObstacleField& obstacles, const LiquidGrid& liquid);
    void findActive();
    void smoothOnce();
    void sharpen(double variance);
    template <class Take>
    void mirrorAtWalls(Take&& take);
    void findNormals();
    void findDivergence();
    /// Parallel loop over the blocks near the surface: body(number in band_).
    template <class Body>
    void forEachActive(Body&& body) const;

    BlockGrid band_;  ///< the liquid's blocks and all around them
    std::vector<Vec3i> liquidCoords_, coords_;
    std::vector<int> liquidBlock_, bandBlock_;  ///< number in the other grid of each block of the one
    std::vector<int> active_;                   ///< blocks at most one away from the surface; the others are not smoothed
    std::vector<std::uint8_t> isActive_;
    bool hasWalls_ = false;
    BlockBits<> wall_;                            ///< cells amid obstacles
    BlockBits<> known_, fresh_;                   ///< scratch
    BlockBits<> surface_;                         ///< liquid cells beside air
    BlockBits<> beside_;                          ///< cells whose curvature is asked for, and their neighbours
    BlockBits<> around_;                          ///< cells whose normal is asked for: those of beside_ and their neighbours
    BlockArray<double> colour_, other_, smooth_;  ///< [-]
    BlockArray<double, 3> normal_;                ///< out of the liquid [-]
    BlockArray<double> curvature_;                ///< [1/cell]
};

}  // namespace sim
