#include "sim/liquid/level_set.h"

#include "sim/core/parallel.h"
#include "sim/core/simd.h"
#include "sim/grid/rows.h"
#include "sim/transfer/tile.h"

#include <limits>

namespace sim {

namespace {

constexpr double kFar = 1.0e6;  ///< squared distance [cells²] of cells that no particle is near

[[gnu::always_inline]] inline Pack minPack(Pack a, Pack b) { return a < b ? a : b; }

/// Middles of the 3×3 cells around a cell, of one plane: lane x + 4 y, as in scatter.cpp; the fourth of each row is unused.
struct PlaneLanes {
    Pack x, y[2];
    PlaneLanes()
    {
        for (int lane = 0; lane < kLanes; ++lane) {
            x[lane] = (lane & 3) - 1;
            for (int half = 0; half < 2; ++half) y[half][lane] = (lane >> 2) + 2 * half - 1;
        }
    }
};

/// Squared distances from the middles of the 27 cells around a cell to the nearest of its particles.
inline void nearestInCell(const PlaneLanes& lanes, const LiquidParticles& particles, const Vec3& middle, double inverseDx, int first,
                          int last, Pack (&nearest)[3][2])
{
    unroll<3>([&](auto n) { nearest[n][0] = nearest[n][1] = broadcast(kFar); });
    for (int s = first; s < last; ++s) {
        const double x = (particles.x[0][s] - middle.x()) * inverseDx, y = (particles.x[1][s] - middle.y()) * inverseDx,
                     z = (particles.x[2][s] - middle.z()) * inverseDx;
        const Pack dx = lanes.x - x;
        unroll<2>([&](auto h) {
            const Pack dy = lanes.y[h] - y, plane = dx * dx + dy * dy;
            unroll<3>([&](auto n) { nearest[n][h] = minPack(nearest[n][h], plane + ((n - 1) - z) * ((n - 1) - z)); });
        });
    }
}

struct NearestTile {
    alignas(64) double v[kTileSize];
};

void mergeRows(const Pack (&plane)[2], double* tile)
{
    for (int row = 0; row < 3; ++row)
        for (int x = 0; x < 3; ++x) {
            double& v = tile[row * kTileStrideY + x];
            v = std::min(v, plane[row / 2][(row % 2) * 4 + x]);
        }
}

void nearestInBlock(const LiquidParticles& particles, const ParticleOrder& order, const BlockGrid& grid, int block, const OccupiedBox& box,
                    NearestTile& tile)
{
    const PlaneLanes lanes;
    const Vec3 corner = grid.lowerCorner(block);
    std::fill_n(tile.v, kTileSize, kFar);
    for (int i = box.low[0]; i <= box.high[0]; ++i)
        for (int j = box.low[1]; j <= box.high[1]; ++j)
            for (int k = box.low[2]; k <= box.high[2]; ++k) {
                const int* start = order.cells(block) + cellRank(i, j, k);
                if (start[0] == start[1]) continue;
                Pack nearest[3][2];
                nearestInCell(lanes, particles, corner + grid.dx * (Vec3(i, j, k) + Vec3::Constant(0.5)), 1.0 / grid.dx, start[0], start[1],
                              nearest);
                for (int n = 0; n < 3; ++n) mergeRows(nearest[n], tile.v + tileIndex(i - 1, j - 1, k - 1 + n));
            }
}

/// Squared distances in cells to distances in cm; then no value beside a liquid cell may exceed that cell's by more than dx.
void toDistances(const BlockGrid& grid, LiquidGrid& liquid)
{
    parallelFor(grid.count(), 4, [&](std::size_t b) {
        double* phi = liquid.levelSet.block(static_cast<int>(b));
        for (int c = 0; c < kBlockCells; ++c) phi[c] = grid.dx * (std::sqrt(phi[c]) - kLiquidRadius);
    });
    // Only cells outside change, and only by what is inside: reading neighbours while they change is safe cell by cell, but not for the
    // race detector, so the new values are kept apart until all are known.
    parallelFor(grid.count(), 4, [&](std::size_t n) {
        const int b = static_cast<int>(n);
        const RowAccess rows(grid, b);
        double* bounded = liquid.scratch(b);
        for (int k = 0; k < kBlockEdge; ++k)
            for (int j = 0; j < kBlockEdge; ++j) {
                const Pack own = rows.row(liquid.levelSet, 0, j, k);
                Pack lowest = broadcast(0.0);
                unroll<3>([&](auto a) {
                    lowest = minPack(lowest, rows.below(liquid.levelSet, 0, a, j, k));
                    lowest = minPack(lowest, rows.above(liquid.levelSet, 0, a, j, k));
                });
                const Pack limited = select((lowest < 0.0) & (own >= 0.0), minPack(own, lowest + grid.dx), own);
                std::memcpy(bounded + cellInBlock(0, j, k), &limited, sizeof limited);
            }
    });
    parallelFor(grid.count(), 8, [&](std::size_t b) {
        std::copy_n(liquid.scratch(static_cast<int>(b)), kBlockCells, liquid.levelSet.block(static_cast<int>(b)));
    });
}

}  // namespace

void levelSetFromParticles(const LiquidParticles& particles, const ParticleOrder& order, const BlockGrid& grid, LiquidGrid& liquid)
{
    parallelFor(grid.count(), 8, [&](std::size_t b) { std::fill_n(liquid.levelSet.block(static_cast<int>(b)), kBlockCells, kFar); });
    std::fill_n(liquid.levelSet.block(grid.count()), kBlockCells, kFar);  // absent blocks hold no liquid
    for (const std::vector<int>& color : order.byColor)
        parallelFor(color.size(), [&](std::size_t n) {
            const OccupiedBox box(order.cells(color[n]));
            NearestTile tile;
            nearestInBlock(particles, order, grid, color[n], box, tile);
            forEachTileRow(grid, color[n], box, [&](int piece, int cell, int node, auto length) {
                double* to = liquid.levelSet.block(piece) + cell;
                for (int x = 0; x < length; ++x) to[x] = std::min(to[x], tile.v[node + x]);
            });
        });
    toDistances(grid, liquid);
}

namespace {

/// Does any face of cell (i, j, k) let liquid through? Liquid is never at the rim of the blocks, so that faces beyond do not count.
bool hasOpenFace(const BlockGrid& grid, const ObstacleField& obstacles, int b, int i, int j, int k)
{
    for (int a = 0; a < kAxes; ++a) {
        if (obstacles.open(b, a)[cellInBlock(i, j, k)] > 0.0) return true;
        const CellRef up = cellNear(grid, b, i + (a == 0), j + (a == 1), k + (a == 2));
        if (up.block != grid.count() && obstacles.open(up.block, a)[up.cell] > 0.0) return true;
    }
    return false;
}

/// Level set of a cell whose middle is in an obstacle: that of its neighbour on the way out, if an open face that carries liquid lies between
/// the cell and another liquid one; else `outside`.
double levelSetFromOutside(const BlockGrid& grid, const ObstacleField& obstacles, const LiquidGrid& liquid, int b, int i, int j, int k,
                           double outside)
{
    const int cell = cellInBlock(i, j, k);
    double farthest = obstacles.centerDistance(b)[cell], result = outside;
    bool touches = false;
    for (int a = 0; a < kAxes; ++a)
        for (int step : {-1, 1}) {
            const CellRef other = cellNear(grid, b, i + step * (a == 0), j + step * (a == 1), k + step * (a == 2));
            if (other.block == grid.count()) continue;
            const CellRef face = step < 0 ? CellRef{b, cell} : other;
            const double phi = liquid.levelSet.block(other.block)[other.cell], distance = obstacles.centerDistance(other.block)[other.cell];
            touches = touches || (phi < 0.0 && obstacles.open(face.block, a)[face.cell] > 0.0 && liquid.wet.test(face.block, face.cell, a));
            if (distance <= farthest) continue;
            farthest = distance;
            result = phi;
        }
    return touches ? result : outside;
}

}  // namespace

void classifyCells(const BlockGrid& grid, const ObstacleField& obstacles, bool full, LiquidGrid& liquid)
{
    const double outside = 0.5 * grid.dx;
    parallelFor(grid.count(), 4, [&](std::size_t n) {
        const int b = static_cast<int>(n);
        double* result = liquid.scratch(b);
        const double* phi = liquid.levelSet.block(b);
        if (!obstacles.nearSolid(b)) {
            for (int c = 0; c < kBlockCells; ++c) result[c] = full ? -grid.dx : phi[c];
            return;
        }
        for (int k = 0; k < kBlockEdge; ++k)
            for (int j = 0; j < kBlockEdge; ++j)
                for (int i = 0; i < kBlockEdge; ++i) {
                    const int c = cellInBlock(i, j, k);
                    result[c] = phi[c];
                    if (full || phi[c] < 0.0) {
                        const bool open = hasOpenFace(grid, obstacles, b, i, j, k);
                        result[c] = !open ? outside : full ? -grid.dx : phi[c];
                    } else if (obstacles.centerDistance(b)[c] < 0.0) {
                        const double phiOutside = levelSetFromOutside(grid, obstacles, liquid, b, i, j, k, outside);
                        if (phiOutside < 0.0) result[c] = phiOutside;
                    }
                }
    });
    parallelFor(grid.count(), 8, [&](std::size_t b) {
        std::copy_n(liquid.scratch(static_cast<int>(b)), kBlockCells, liquid.levelSet.block(static_cast<int>(b)));
    });
}

}  // namespace sim
