#include "sim/liquid/extrapolate.h"

#include "sim/core/parallel.h"
#include "sim/grid/rows.h"

#include <bit>
#include <cstring>

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

/// One sweep over the faces of one block normal to one axis: which become valid, and their velocities.
void sweepBlock(const BlockGrid& grid, int block, int axis, const BlockBits<3>& valid, const BlockArray<double, 3>& velocity,
                ExtrapolationScratch& scratch)
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
        scratch.newlyValid.block(block, axis)[k] = fresh;
        for (int j = 0; j < kBlockEdge; ++j) {
            if ((fresh >> (j * kBlockEdge) & 0xff) == 0) continue;
            const Pack mean = meanOfNeighbours(rows, neighbourBits, velocity, axis, j, k);
            std::memcpy(scratch.found.block(block, axis) + cellInBlock(0, j, k), &mean, sizeof mean);
        }
    }
}

/// Takes over what a sweep has found for one block.
void takeFound(int block, const ExtrapolationScratch& scratch, BlockBits<3>& valid, BlockArray<double, 3>& velocity)
{
    for (int a = 0; a < kAxes; ++a)
        for (int k = 0; k < kBlockEdge; ++k) {
            std::uint64_t fresh = scratch.newlyValid.block(block, a)[k];
            valid.block(block, a)[k] |= fresh;
            for (; fresh != 0; fresh &= fresh - 1) {
                const int cell = cellInBlock(0, 0, k) + std::countr_zero(fresh);
                velocity.block(block, a)[cell] = scratch.found.block(block, a)[cell];
            }
        }
}

}  // namespace

void extrapolate(const BlockGrid& grid, std::span<const int> blocks, ExtrapolationScratch& scratch, BlockBits<3>& valid,
                 BlockArray<double, 3>& velocity)
{
    scratch.newlyValid.resize(grid.count());
    scratch.found.resize(grid.count());
    for (int sweep = 0; sweep < kExtrapolationSweeps; ++sweep) {
        parallelFor(blocks.size(), [&](std::size_t n) {
            for (int a = 0; a < kAxes; ++a) sweepBlock(grid, blocks[n], a, valid, velocity, scratch);
        });
        parallelFor(blocks.size(), 32, [&](std::size_t n) { takeFound(blocks[n], scratch, valid, velocity); });
    }
}

}  // namespace sim
