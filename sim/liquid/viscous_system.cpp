#include "sim/liquid/viscous_system.h"

#include "sim/core/parallel.h"
#include "sim/grid/rows.h"
#include "sim/liquid/walls.h"
#include "sim/solvers/block_rows.h"

#include <algorithm>

namespace sim {

namespace {

/// Faces with less of a full one's mass carry nothing that would matter, but their reciprocals might overflow.
constexpr double kLeastMass = 1.0e-12;

/// Mass and room of a row of faces, and which of them are unknown.
struct FaceRow {
    Pack mass, room;
    PackMask unknown;
};

/// Mass and room of the unknown faces that a strain is made of.
struct Liquid {
    Pack mass = broadcast(0.0), room = broadcast(0.0);

    void add(const FaceRow& row)
    {
        mass += select(row.unknown, row.mass, broadcast(0.0));
        room += select(row.unknown, row.room, broadcast(0.0));
    }
    /// Share of the room that liquid fills.
    Pack fill() const { return select(room > 0.0, mass / room, broadcast(0.0)); }
};

/// One block with what it takes from its neighbours, faces of one axis at a time.
class Faces {
 public:
    Faces(const CutGrid& cut, const LiquidGrid& liquid, const BlockBits<3>& unknown, int block)
        : bits(cut.grid, block), rows_(cut.grid, block), obstacles_(cut.field), liquid_(liquid), unknown_(unknown)
    {
    }

    /// Faces normal to an axis of row (j, k) of the neighbour at the given steps down (−1) or up (1) along another axis, if any.
    FaceRow at(int axis, int along, int step, int j, int k) const
    {
        const int dj = along == 1 ? step : 0, dk = along == 2 ? step : 0;
        const int b = rows_.neighbours[neighbourIndex(0, (j + dj) >> 3, (k + dk) >> 3)];
        const FaceRow own = read(b, axis, (j + dj) & 7, (k + dk) & 7);
        if (along != 0 || step == 0) return own;
        const FaceRow other = read(rows_.neighbours[neighbourIndex(step, 0, 0)], axis, j, k);
        const auto shift = [&](auto here, auto there) { return step < 0 ? shiftRight(there, here) : shiftLeft(here, there); };
        const Pack one = broadcast(1.0), zero = broadcast(0.0);
        return {shift(own.mass, other.mass), shift(own.room, other.room),
                shift(select(own.unknown, one, zero), select(other.unknown, one, zero)) > 0.0};
    }

    BitAccess bits;

 private:
    FaceRow read(int b, int axis, int j, int k) const
    {
        const int row = cellInBlock(0, j, k);
        return {loadPack(liquid_.faces.sums.block(b, FaceFields::kMass + axis) + row), loadPack(obstacles_.room(b, axis) + row),
                rowBits(unknown_.block(b, axis), j, k)};
    }

    RowAccess rows_;
    const ObstacleField& obstacles_;
    const LiquidGrid& liquid_;
    const BlockBits<3>& unknown_;
};

void findUnknowns(const ObstacleField& obstacles, const LiquidGrid& liquid, int b, ViscousSystem& system)
{
    for (int a = 0; a < kAxes; ++a) {
        const double* mass = liquid.faces.sums.block(b, FaceFields::kMass + a);
        std::uint64_t* unknown = system.unknown.block(b, a);
        std::uint64_t rows = 0;
        for (int k = 0; k < kBlockEdge; ++k) {
            std::uint64_t heavy = 0;
            for (int j = 0; j < kBlockEdge; ++j) {
                const PackMask is = loadPack(mass + cellInBlock(0, j, k)) > kLeastMass * liquid.fullMass;
                heavy |= static_cast<std::uint64_t>(maskBits(is)) << (j * kBlockEdge);
            }
            unknown[k] = heavy & ~obstacles.closed(b, a)[k];
            for (int j = 0; j < kBlockEdge; ++j)
                rows |= static_cast<std::uint64_t>((unknown[k] >> (j * kBlockEdge) & 0xff) != 0) << (k * kBlockEdge + j);
        }
        system.rows[static_cast<std::size_t>(b) * kAxes + a] = rows;
    }
}

/// @param sticks  so do walls that pass between a face's open part and its middle
void findBehind(const CutGrid& cut, bool sticks, int b, ViscousSystem& system)
{
    for (int a = 0; a < kAxes; ++a) {
        std::copy_n(cut.field.closed(b, a), BlockBits<3>::kWords, system.behind.block(b, a));
        if (!sticks || !cut.field.nearSolid(b)) continue;
        for (int k = 0; k < kBlockEdge; ++k)
            for (std::uint64_t bits = system.unknown.block(b, a)[k]; bits != 0; bits &= bits - 1) {
                const int face = k * 64 + std::countr_zero(bits);
                if (faceDistance(cut, b, a, Vec3i(face & 7, face >> 3 & 7, k)) <= 0.0) system.behind.set(b, face, a);
            }
    }
}

void findStrains(const CutGrid& cut, const LiquidGrid& liquid, double weight, int b, ViscousSystem& system)
{
    const Faces faces(cut, liquid, system.unknown, b);
    const BlockBits<3>& unknown = system.unknown;
    for (int k = 0; k < kBlockEdge; ++k)
        for (int a = 0; a < kAxes; ++a) {
            const std::uint64_t own = unknown.block(b, a)[k], above = faces.bits.above(unknown, a, a, k);
            const std::uint64_t given = system.behind.block(b, a)[k], givenAbove = faces.bits.above(system.behind, a, a, k);
            const std::uint64_t strained = (own | given) & (above | givenAbove) & (own | above);
            const int c = (a + 1) % 3, d = (a + 2) % 3;
            const auto pair = [&](int axis, int along) {
                const std::uint64_t free = unknown.block(b, axis)[k] & ~system.behind.block(b, axis)[k];
                return free & faces.bits.below(unknown, axis, along, k) & ~faces.bits.below(system.behind, axis, along, k);
            };
            const std::uint64_t sheared = pair(c, d) & pair(d, c);
            for (int j = 0; j < kBlockEdge; ++j) {
                const int row = cellInBlock(0, j, k);
                Pack normal = broadcast(0.0), shear = broadcast(0.0);
                if (const PackMask is = rowBits(strained, j); maskBits(is) != 0) {
                    Liquid sum;
                    sum.add(faces.at(a, a, 0, j, k));
                    sum.add(faces.at(a, a, 1, j, k));
                    normal = select(is, 2.0 * weight * sum.fill(), normal);
                }
                if (const PackMask is = rowBits(sheared, j); maskBits(is) != 0) {
                    Liquid sum;
                    sum.add(faces.at(c, d, 0, j, k));
                    sum.add(faces.at(c, d, -1, j, k));
                    sum.add(faces.at(d, c, 0, j, k));
                    sum.add(faces.at(d, c, -1, j, k));
                    shear = select(is, weight * sum.fill(), shear);
                }
                storePack(system.normal.block(b, a) + row, normal);
                storePack(system.shear.block(b, a) + row, shear);
            }
        }
}

/// dt μ times area over distance for each wall beside a face.
void findWalls(const CutGrid& cut, const LiquidGrid& liquid, double weight, int b, ViscousSystem& system)
{
    for (int a = 0; a < kAxes; ++a) {
        double* wall = system.wall.block(b, a);
        std::fill_n(wall, kBlockCells, 0.0);
        for (int k = 0; k < kBlockEdge; ++k)
            for (std::uint64_t bits = system.unknown.block(b, a)[k]; bits != 0; bits &= bits - 1) {
                const int face = k * 64 + std::countr_zero(bits);
                const Vec3i cell(face & 7, face >> 3 & 7, k);
                const double room = cut.field.room(b, a)[face] * liquid.fullMass;
                if (!(room > 0.0)) continue;
                const double fill = liquid.faces.sums.block(b, FaceFields::kMass + a)[face] / room;
                for (int side = 0; side < 4; ++side) {
                    Vec3i beside = cell;
                    beside[(a + 1 + side / 2) % 3] += side % 2 == 0 ? 1 : -1;
                    const CellRef ref = cellNear(cut.grid, b, beside.x(), beside.y(), beside.z());
                    if (!system.behind.test(ref.block, ref.cell, a)) continue;
                    wall[face] += weight * fill / wallReach(cut, b, a, cell, beside);
                }
            }
    }
}

void findDiagonal(const BlockGrid& grid, const LiquidGrid& liquid, int b, ViscousSystem& system)
{
    const RowAccess rows(grid, b);
    const bool hasWalls = system.wall.size() > 0;
    for (int a = 0; a < kAxes; ++a) {
        std::fill_n(system.diagonal.block(b, a), kBlockCells, 0.0);
        forEachRow(system.rowsOf(b, a), [&](int r) {
            const int j = r % kBlockEdge, k = r / kBlockEdge, row = r * kBlockEdge;
            Pack sum = loadPack(liquid.faces.sums.block(b, FaceFields::kMass + a) + row);
            sum += rows.row(system.normal, a, j, k) + rows.below(system.normal, a, a, j, k);
            for (int side = 1; side < kAxes; ++side) {
                const int along = (a + side) % 3, edge = (a + 3 - side) % 3;
                sum += rows.row(system.shear, edge, j, k) + rows.above(system.shear, edge, along, j, k);
            }
            if (hasWalls) sum += loadPack(system.wall.block(b, a) + row);
            storePack(system.diagonal.block(b, a) + row, select(rowBits(system.unknown.block(b, a), j, k), sum, broadcast(0.0)));
        });
    }
}

/// The three components on the faces of a block and one cell around it.
struct Tile {
    static constexpr int kEdge = kBlockEdge + 2, kUp[kAxes] = {1, kEdge, kEdge*kEdge};
    double v[kAxes][kEdge * kEdge * kEdge];

    static constexpr int index(int i, int j, int k) { return ((k + 1) * kEdge + j + 1) * kEdge + i + 1; }

    Tile(const BlockGrid& grid, const BlockArray<double, 3>& field, int block)
    {
        const auto& around = grid.neighbours(block);
        for (int k = -1; k <= kBlockEdge; ++k)
            for (int j = -1; j <= kBlockEdge; ++j) {
                const int row = cellInBlock(0, j & 7, k & 7), middle = neighbourIndex(0, j >> 3, k >> 3);
                for (int a = 0; a < kAxes; ++a) {
                    double* to = v[a] + index(0, j, k);
                    to[-1] = field.block(around[middle - 1], a)[row + kBlockEdge - 1];
                    storePack(to, loadPack(field.block(around[middle], a) + row));
                    to[kBlockEdge] = field.block(around[middle + 1], a)[row];
                }
            }
    }
};

}  // namespace

void ViscousSystem::assemble(const CutGrid& cut, const LiquidGrid& liquid, double impulse, double friction)
{
    const int blocks = cut.grid.count();
    const double weight = impulse * cut.grid.dx / liquid.fullMass;  // dt μ V / dx² of a volume is this times its mass
    unknown.resize(blocks);
    behind.resize(blocks);
    rows.resize(static_cast<std::size_t>(blocks) * kAxes);
    for (BlockArray<double, 3>* field : {&diagonal, &normal, &shear}) field->resize(blocks);
    if (friction > 0.0) wall.resize(blocks);
    forEachBlock(blocks, [&](int b) { findUnknowns(cut.field, liquid, b, *this); });
    forEachBlock(blocks, [&](int b) { findBehind(cut, friction > 0.0, b, *this); });
    forEachBlock(blocks, [&](int b) { findStrains(cut, liquid, weight, b, *this); });
    if (friction > 0.0) forEachBlock(blocks, [&](int b) { findWalls(cut, liquid, friction * impulse * cut.grid.dx, b, *this); });
    forEachBlock(blocks, [&](int b) { findDiagonal(cut.grid, liquid, b, *this); });
}

void ViscousSystem::multiply(const BlockGrid& grid, const BlockArray<double, 3>& v, int block, BlockArray<double, 3>& out) const
{
    if (!hasUnknowns(block)) return;
    const Tile tile(grid, v, block);
    const RowAccess access(grid, block);
    unroll<3>([&](auto a) {
        constexpr int kUp = Tile::kUp[a];
        forEachRow(rowsOf(block, a), [&](int r) {
            const int j = r % kBlockEdge, k = r / kBlockEdge;
            const double* own = tile.v[a] + Tile::index(0, j, k);
            Pack sum = access.row(diagonal, a, j, k) * loadPack(own) - access.row(normal, a, j, k) * loadPack(own + kUp) -
                       access.below(normal, a, a, j, k) * loadPack(own - kUp);
            unroll<2>([&](auto side) {
                constexpr int kAlong = (a + 1 + side) % 3, kEdge = (a + 2 - side) % 3, kStep = Tile::kUp[kAlong];
                const double* other = tile.v[kAlong] + Tile::index(0, j, k);
                const Pack below = loadPack(own - kStep) - (loadPack(other) - loadPack(other - kUp));
                const Pack above = loadPack(own + kStep) + (loadPack(other + kStep) - loadPack(other + kStep - kUp));
                sum -= access.row(shear, kEdge, j, k) * below + access.above(shear, kEdge, kAlong, j, k) * above;
            });
            const PackMask is = rowBits(unknown.block(block, a), j, k);
            storePack(out.block(block, a) + r * kBlockEdge, select(is, sum, broadcast(0.0)));
        });
    });
}

}  // namespace sim
