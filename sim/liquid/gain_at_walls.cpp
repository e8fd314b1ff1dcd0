#include "sim/liquid/gain_at_walls.h"

#include "sim/core/parallel.h"
#include "sim/core/simd.h"

#include <algorithm>
#include <iterator>
#include <limits>

namespace sim {

void GainAtWalls::begin(const ObstacleField& field, const BlockArray<double, 3>& velocity)
{
    blocks_.clear();
    std::ranges::copy_if(field.blocksNearSolid(), std::back_inserter(blocks_), [&](int b) { return !field.isEven(b); });
    before_.resize(static_cast<int>(blocks_.size()));
    parallelFor(blocks_.size(), 4,
                [&](std::size_t n) { std::copy_n(velocity.block(blocks_[n]), BlockArray<double, 3>::kStride, before_.block(static_cast<int>(n))); });
}

void GainAtWalls::bound(const ObstacleField& field, BlockArray<double, 3>& velocity) const
{
    // Along slanted walls that rest some faces gain what others lose; walls that move are bounded face by face.
    const double gained = parallelSum(blocks_.size(), [&](std::size_t n) {
        const int b = blocks_[n];
        double sum = 0.0;
        for (int a = 0; a < kAxes; ++a) {
            const double *before = before_.block(static_cast<int>(n), a), *open = field.open(b, a), *room = field.room(b, a),
                         *wall = field.wallVelocity(b, a), *u = velocity.block(b, a);
            for (int c = 0; c < kBlockCells; ++c) {
                if (!(open[c] > 0.0) || open[c] == room[c] || u[c] == before[c]) continue;
                if (wall[c] != 0.0) return std::numeric_limits<double>::infinity();
                sum += room[c] * (u[c] * u[c] - before[c] * before[c]);
            }
        }
        return sum;
    });
    if (gained <= 0.0) return;
    parallelFor(blocks_.size(), 4, [&](std::size_t n) {
        const int b = blocks_[n];
        for (int a = 0; a < kAxes; ++a) {
            const double *before = before_.block(static_cast<int>(n), a), *open = field.open(b, a), *room = field.room(b, a),
                         *wall = field.wallVelocity(b, a);
            double* u = velocity.block(b, a);
            for (int row = 0; row < kBlockCells; row += kLanes) {
                const Pack opened = loadPack(open + row), roomed = loadPack(room + row), w = loadPack(wall + row), after = loadPack(u + row);
                const Pack from = loadPack(before + row) - w, to = after - w;
                const Pack most = from * from + opened / roomed * (to * to - from * from);
                const PackMask gains = (opened > 0.0) & (opened < roomed) & (to * to > most);
                if (maskBits(gains) == 0) continue;
                const Pack size = sqrtPack(maxPack(most, broadcast(0.0)));
                storePack(u + row, select(gains, w + select(to < 0.0, -size, size), after));
            }
        }
    });
}

}  // namespace sim
