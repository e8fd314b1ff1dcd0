#pragma once

#include "sim/grid/block_grid.h"

#include <algorithm>
#include <cmath>

namespace sim {

/// The 27 cells around a point, with the weights of the quadratic B-spline at their middles.
struct CellStencil {
    int cell[kAxes];           ///< the point's own, in its block
    double weight[kAxes][3];   ///< of the cells at −1, 0, 1

    /// @param lowerCorner  of the block that the point was sorted into [cm]
    CellStencil(const Vec3& x, const Vec3& lowerCorner, double dx)
    {
        for (int a = 0; a < kAxes; ++a) {
            const double at = (x[a] - lowerCorner[a]) / dx;
            cell[a] = std::clamp(static_cast<int>(std::floor(at)), 0, kBlockEdge - 1);
            const double r = at - cell[a] - 0.5;
            weight[a][0] = 0.5 * (0.5 - r) * (0.5 - r);
            weight[a][1] = 0.75 - r * r;
            weight[a][2] = 0.5 * (0.5 + r) * (0.5 + r);
        }
    }

    /// body(block, cell, weight); `blocks` are the 27 around the point's.
    template <class Body>
    void forEach(const std::array<int, 27>& blocks, Body&& body) const
    {
        for (int dz = 0; dz < 3; ++dz)
            for (int dy = 0; dy < 3; ++dy)
                for (int dx = 0; dx < 3; ++dx) {
                    const int i = cell[0] + dx - 1, j = cell[1] + dy - 1, k = cell[2] + dz - 1;
                    body(blocks[neighbourIndex(i >> 3, j >> 3, k >> 3)], cellInBlock(i & 7, j & 7, k & 7),
                         weight[0][dx] * weight[1][dy] * weight[2][dz]);
                }
    }
};

}  // namespace sim
