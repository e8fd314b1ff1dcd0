#include "sim/liquid/cells.h"

#include "sim/core/parallel.h"
#include "sim/grid/rows.h"

#include <bit>

namespace sim {

namespace {

/// Mass and room of the lower faces of all cells, summed over the axes and over both sides of a cell.
class FaceSums {
 public:
    FaceSums(const CutGrid& cut, const LiquidGrid& liquid, int block) : rows_(cut.grid, block), obstacles_(cut.field), liquid_(liquid) {}

    /// Σ mass / Σ room over the open faces of the cells of row (j, k); 0 where there is no room.
    Pack fill(int j, int k) const
    {
        Pack mass = broadcast(0.0), room = broadcast(0.0);
        unroll<3>([&](auto a) {
            add<a>(rows_.neighbours[kBlockItself], j, k, false, mass, room);
            add<a>(rows_.neighbours[kBlockItself], j, k, true, mass, room);
        });
        return select(room > 0.0, mass / room, broadcast(0.0));
    }

 private:
    template <int kAxis>
    void add(int own, int j, int k, bool above, Pack& mass, Pack& room) const
    {
        Pack m, r;
        openFaces<kAxis>(own, j, k, m, r);
        if (above) {
            if constexpr (kAxis == 0) {
                Pack nextMass, nextRoom;
                openFaces<kAxis>(rows_.neighbours[neighbourIndex(1, 0, 0)], j, k, nextMass, nextRoom);
                m = shiftLeft(m, nextMass);
                r = shiftLeft(r, nextRoom);
            } else {
                const int uj = j + (kAxis == 1), uk = k + (kAxis == 2);
                openFaces<kAxis>(rows_.neighbours[neighbourIndex(0, uj >> 3, uk >> 3)], uj & 7, uk & 7, m, r);
            }
        }
        mass += m;
        room += r;
    }
    template <int kAxis>
    void openFaces(int block, int j, int k, Pack& mass, Pack& room) const
    {
        const int row = cellInBlock(0, j, k);
        const PackMask open = loadPack(obstacles_.open(block, kAxis) + row) > 0.0;
        mass = select(open, loadPack(liquid_.faces.sums.block(block, FaceFields::kMass + kAxis) + row), broadcast(0.0));
        room = select(open, loadPack(obstacles_.room(block, kAxis) + row), broadcast(0.0));
    }

    RowAccess rows_;
    const ObstacleField& obstacles_;
    const LiquidGrid& liquid_;
};

/// Bits of the six neighbours of plane k, ORed.
std::uint64_t besideAny(const BitAccess& access, const BlockBits<>& bits, int k)
{
    std::uint64_t any = 0;
    for (int a = 0; a < kAxes; ++a) any |= access.below(bits, 0, a, k) | access.above(bits, 0, a, k);
    return any;
}

}  // namespace

LiquidCells findLiquidCells(const CutGrid& cut, bool noAir, LiquidGrid& liquid)
{
    const double perCell = 1.0 / liquid.fullMass;
    parallelFor(cut.grid.count(), 2, [&](std::size_t n) {
        const int b = static_cast<int>(n);
        const FaceSums faces(cut, liquid, b);
        for (int k = 0; k < kBlockEdge; ++k) {
            std::uint64_t inside = 0;
            for (int j = 0; j < kBlockEdge; ++j) {
                const Pack fill = faces.fill(j, k) * perCell;
                std::memcpy(liquid.fill.block(b) + cellInBlock(0, j, k), &fill, sizeof fill);
                inside |= static_cast<std::uint64_t>(maskBits(fill >= kLiquidFill)) << (j * kBlockEdge);
            }
            const std::uint64_t beyond = liquid.hasOpenings ? liquid.beyond.block(b)[k] : 0;
            liquid.inside.block(b)[k] = (noAir ? ~std::uint64_t{0} : inside) & ~cut.field.blocked(b)[k] & ~beyond;
        }
    });
    return LiquidCells(liquid);
}

SurfaceCells findSurface(const CutGrid& cut, const LiquidCells& cells, LiquidGrid& liquid)
{
    BlockBits<>& dry = liquid.dry;
    parallelFor(cut.grid.count(), 16, [&](std::size_t n) {
        const int b = static_cast<int>(n);
        for (int k = 0; k < kBlockEdge; ++k) {
            const std::uint64_t beyond = liquid.hasOpenings ? liquid.beyond.block(b)[k] : 0;
            dry.block(b)[k] = ~(liquid.inside.block(b)[k] | cut.field.blocked(b)[k] | beyond);
        }
    });
    std::fill_n(dry.block(cut.grid.count()), BlockBits<>::kWords, ~std::uint64_t{0});
    parallelFor(cut.grid.count(), 16, [&](std::size_t n) {
        const int b = static_cast<int>(n);
        const BitAccess access(cut.grid, b);
        for (int k = 0; k < kBlockEdge; ++k) liquid.surface.block(b)[k] = liquid.inside.block(b)[k] & besideAny(access, dry, k);
    });
    parallelFor(cut.grid.count(), 16, [&](std::size_t n) {
        const int b = static_cast<int>(n);
        const BitAccess access(cut.grid, b);
        for (int k = 0; k < kBlockEdge; ++k)
            liquid.deep.block(b)[k] = liquid.inside.block(b)[k] & ~(liquid.surface.block(b)[k] | besideAny(access, liquid.surface, k));
    });
    return SurfaceCells(cells);
}

std::size_t countLiquidCells(const BlockGrid& grid, const LiquidCells& cells)
{
    const BlockBits<>& inside = cells.liquid().inside;
    return parallelReduce(
        grid.count(), std::size_t{0},
        [&](std::size_t b) {
            std::size_t count = 0;
            for (int k = 0; k < kBlockEdge; ++k) count += static_cast<std::size_t>(std::popcount(inside.block(static_cast<int>(b))[k]));
            return count;
        },
        std::plus<>());
}

}  // namespace sim
