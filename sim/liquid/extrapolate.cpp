#include "sim/liquid/extrapolate.h"

#include "sim/core/parallel.h"
#include "sim/grid/rows.h"

namespace sim {

namespace {

/// Mean of the valid ones among the six neighbours of the faces of row (j, k).
Pack meanOfNeighbours(const RowAccess& rows, const std::uint64_t (&neighbourBits)[6], const BlockArray<double, 3>& velocity, int axis, int j, int k)
{
    Pack sum = broadcast(0.0), count = broadcast(0.0);
    unroll<3>([&](auto a) {
        unroll<2>([&](auto side) {
            const PackMask known = maskOfBits(neighbourBits[2 * a + side] >> (j * kBlockEdge));
            const Pack u = side == 0 ? rows.below(velocity, axis, a, j, k) : rows.above(velocity, axis, a, j, k);
            sum += select(known, u, broadcast(0.0));
            count += select(known, broadcast(1.0), broadcast(0.0));
        });
    });
    return sum / count;
}

/// One sweep over the faces of one block normal to one axis. Values of faces that are valid are read, those of others written.
void sweepBlock(const BlockGrid& grid, int block, int axis, const BlockBits<3>& valid, BlockBits<3>& newlyValid, BlockArray<double, 3>& velocity)
{
    const RowAccess rows(grid, block);
    const BitAccess bits(grid, block);
    for (int k = 0; k < kBlockEdge; ++k) {
        std::uint64_t neighbourBits[6], any = 0;
        for (int a = 0; a < kAxes; ++a) {
            neighbourBits[2 * a] = bits.below(valid, axis, a, k);
            neighbourBits[2 * a + 1] = bits.above(valid, axis, a, k);
            any |= neighbourBits[2 * a] | neighbourBits[2 * a + 1];
        }
        const std::uint64_t fresh = any & ~valid.block(block, axis)[k];
        newlyValid.block(block, axis)[k] = fresh;
        for (int j = 0; j < kBlockEdge; ++j) {
            const std::uint64_t rowBits = fresh >> (j * kBlockEdge) & 0xff;
            if (rowBits == 0) continue;
            const Pack mean = meanOfNeighbours(rows, neighbourBits, velocity, axis, j, k);
            double* u = velocity.block(block, axis) + cellInBlock(0, j, k);
            for (int l = 0; l < kLanes; ++l)
                if (rowBits >> l & 1) u[l] = mean[l];
        }
    }
}

}  // namespace

void extrapolate(const BlockGrid& grid, std::span<const int> blocks, ExtrapolationScratch& scratch, BlockBits<3>& valid,
                 BlockArray<double, 3>& velocity)
{
    scratch.newlyValid.resize(grid.count());
    for (int sweep = 0; sweep < kExtrapolationSweeps; ++sweep) {
        parallelFor(blocks.size(), [&](std::size_t n) {
            for (int a = 0; a < kAxes; ++a) sweepBlock(grid, blocks[n], a, valid, scratch.newlyValid, velocity);
        });
        parallelFor(blocks.size(), 32, [&](std::size_t n) {
            const int b = blocks[n];
            for (int a = 0; a < kAxes; ++a)
                for (int k = 0; k < kBlockEdge; ++k) valid.block(b, a)[k] |= scratch.newlyValid.block(b, a)[k];
        });
    }
}

}  // namespace sim
