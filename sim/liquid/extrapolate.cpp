#include "sim/liquid/extrapolate.h"

#include "sim/core/parallel.h"
#include "sim/grid/rows.h"

#include <bit>

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

void extrapolate(const BlockGrid& grid, ExtrapolationScratch& scratch, BlockBits<3>& valid, BlockArray<double, 3>& velocity)
{
    scratch.newlyValid.resize(grid.count());
    for (int sweep = 0; sweep < kExtrapolationSweeps; ++sweep) {
        parallelFor(grid.count(), [&](std::size_t b) {
            for (int a = 0; a < kAxes; ++a) sweepBlock(grid, static_cast<int>(b), a, valid, scratch.newlyValid, velocity);
        });
        parallelFor(grid.count(), 32, [&](std::size_t b) {
            for (int a = 0; a < kAxes; ++a)
                for (int k = 0; k < kBlockEdge; ++k)
                    valid.block(static_cast<int>(b), a)[k] |= scratch.newlyValid.block(static_cast<int>(b), a)[k];
        });
    }
}

namespace {

/// Which cells of a block have all faces of one axis known that stencils of particles in them can touch: faces −1 … +1 around
/// the cell along the other axes, −1 … +2 along the face's own. Bits as in BlockBits; ANDed into `complete`.
void intersectComplete(const BlockGrid& grid, const BlockBits<3>& valid, int block, int axis, std::uint64_t (&complete)[kBlockEdge])
{
    constexpr int kEdge = kBlockEdge + 3;  // faces −1 … 9
    std::uint32_t alongY[kEdge][kBlockEdge];
    const int* neighbours = grid.neighbours(block).data();
    for (int z = 0; z < kEdge; ++z) {
        std::uint32_t row[kEdge];
        for (int y = 0; y < kEdge; ++y) {
            const int j = y - 1, k = z - 1;
            const int* three = neighbours + neighbourIndex(-1, j >> 3, k >> 3);
            const auto bits = [&](int n) { return valid.block(three[n], axis)[k & 7] >> ((j & 7) * kBlockEdge) & 0xff; };
            const std::uint32_t faces = static_cast<std::uint32_t>(bits(0) >> 7 | bits(1) << 1 | (bits(2) & 3) << 9);
            row[y] = faces & faces >> 1 & faces >> 2 & (axis == 0 ? faces >> 3 : ~0u);
        }
        for (int j = 0; j < kBlockEdge; ++j) alongY[z][j] = row[j] & row[j + 1] & row[j + 2] & (axis == 1 ? row[j + 3] : ~0u);
    }
    for (int k = 0; k < kBlockEdge; ++k)
        for (int j = 0; j < kBlockEdge; ++j) {
            const std::uint32_t all = alongY[k][j] & alongY[k + 1][j] & alongY[k + 2][j] & (axis == 2 ? alongY[k + 3][j] : ~0u);
            complete[k] &= ~(static_cast<std::uint64_t>(~all & 0xff) << (j * kBlockEdge));
        }
}

bool findGapsInBlock(const BlockGrid& grid, const ParticleOrder& order, int block, LiquidGrid& liquid)
{
    std::uint64_t complete[kBlockEdge];
    std::fill_n(complete, kBlockEdge, ~std::uint64_t{0});
    for (int a = 0; a < kAxes; ++a) intersectComplete(grid, liquid.faces.valid, block, a, complete);
    std::uint64_t any = 0;
    for (int k = 0; k < kBlockEdge; ++k) {
        std::uint64_t gaps = 0;
        for (std::uint64_t open = ~complete[k]; open != 0; open &= open - 1) {
            const int bit = std::countr_zero(open), i = bit & 7, j = bit >> 3;
            const int* start = order.cells(block) + cellRank(i, j, k);
            if (start[0] != start[1]) gaps |= std::uint64_t{1} << bit;
        }
        liquid.gaps.block(block)[k] = gaps;
        any |= gaps;
    }
    return any != 0;
}

}  // namespace

void findGaps(const BlockGrid& grid, const ParticleOrder& order, LiquidGrid& liquid)
{
    liquid.hasGaps = parallelReduce(
        order.occupied.size(), false, [&](std::size_t n) { return findGapsInBlock(grid, order, order.occupied[n], liquid); },
        [](bool a, bool b) { return a || b; });
}

}  // namespace sim
