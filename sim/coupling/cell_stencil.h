#pragma once

#include "sim/core/spline.h"
#include "sim/grid/block_grid.h"

#include <algorithm>
#include <cmath>

namespace sim {

/// The 27 cells around a point, with the weights of the quadratic B-spline at their middles.
struct CellStencil {
    int cell[kAxes];          ///< the cell that the point lies in, in its block
    double weight[kAxes][3];  ///< weights of the cells at −1, 0, 1

    /// @param lowerCorner  lower corner of the block that the point was sorted into [cm]
    CellStencil(const Vec3& x, const Vec3& lowerCorner, double dx)
    {
        for (int a = 0; a < kAxes; ++a) {
            const double at = (x[a] - lowerCorner[a]) / dx;
            cell[a] = std::clamp(static_cast<int>(std::floor(at)), 0, kBlockEdge - 1);
            splineWeights(at - cell[a] - 0.5, weight[a]);
        }
    }

    /// Visits the cells as they lie in a cube of kTileEdge³ cells, the block's and those around it: body(place, weight).
    static constexpr int kTileEdge = kBlockEdge + 2;
    template <class Body>
    void forEachInTile(Body&& body) const
    {
        for (int dz = 0; dz < 3; ++dz)
            for (int dy = 0; dy < 3; ++dy)
                for (int dx = 0; dx < 3; ++dx)
                    body(((cell[2] + dz) * kTileEdge + cell[1] + dy) * kTileEdge + cell[0] + dx, weight[0][dx] * weight[1][dy] * weight[2][dz]);
    }

    /// body(block, cell, weight); `blocks` are the 27 around the point's.
    template <class Body>
    void forEach(const std::array<int, 27>& blocks, Body&& body) const
    {
        int block[kAxes][3], inBlock[kAxes][3];  // each axis' part of the numbers of blocks and cells
        for (int n = 0; n < 3; ++n) {
            const int i = cell[0] + n - 1, j = cell[1] + n - 1, k = cell[2] + n - 1;
            block[0][n] = neighbourIndex(i >> 3, 0, 0), block[1][n] = 3 * (j >> 3), block[2][n] = 9 * (k >> 3);
            inBlock[0][n] = cellInBlock(i & 7, 0, 0), inBlock[1][n] = cellInBlock(0, j & 7, 0), inBlock[2][n] = cellInBlock(0, 0, k & 7);
        }
        for (int dz = 0; dz < 3; ++dz)
            for (int dy = 0; dy < 3; ++dy)
                for (int dx = 0; dx < 3; ++dx)
                    body(blocks[block[0][dx] + block[1][dy] + block[2][dz]], inBlock[0][dx] + inBlock[1][dy] + inBlock[2][dz],
                         weight[0][dx] * weight[1][dy] * weight[2][dz]);
    }
};

}  // namespace sim
