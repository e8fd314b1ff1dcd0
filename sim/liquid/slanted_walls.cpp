#include "sim/liquid/slanted_walls.h"

#include "sim/core/parallel.h"
#include "sim/grid/rows.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace sim {

namespace {

/// Parts of a face between which there is no difference [-].
constexpr double kLeastExcess = 1.0e-4;

/// Least part of the normal along the way on which a face passes mass, relative to that across the face: with less the way is too long [-].
constexpr double kLeastRatio = 0.1;

}  // namespace

CellRef SlantedWalls::Passing::beside(const BlockGrid& grid, int block, int step) const
{
    Vec3i at(face & 7, face >> 3 & 7, face >> 6);
    at[way] += step;
    return cellNear(grid, block, at.x(), at.y(), at.z());
}

/// Does the wall at the lower faces of a cell move?
bool SlantedWalls::isMoved(const ObstacleField& field, int block, int cell)
{
    for (int a = 0; a < kAxes; ++a)
        if (field.wallVelocity(block, a)[cell] != 0.0) return true;
    return false;
}

/// The way on which a face passes mass: within its plane, for so both sums are the same, and along the axis that the wall's normal is nearest to
/// there. There is none where the wall is along the grid, so that what is behind it is even, or nearly normal to the face; and none at walls that
/// move, where turning ones gave a few particles 1 % more energy than their work.
bool SlantedWalls::findWay(const CutGrid& cut, int block, Passing& passing)
{
    if (isMoved(cut.field, block, passing.face)) return false;
    const double dx = cut.grid.dx;
    const int face = passing.face, axis = passing.axis, next = (axis + 1) % kAxes, last = (axis + 2) % kAxes;
    Vec3 x = cut.grid.lowerCorner(block) + dx * Vec3((face & 7) + 0.5, (face >> 3 & 7) + 0.5, (face >> 6) + 0.5);
    x[axis] -= 0.5 * dx;
    const Vec3 normal = cut.obstacles.normal(x);
    const int way = std::abs(normal[last]) > std::abs(normal[next]) ? last : next;
    passing.way = static_cast<std::uint8_t>(way);
    passing.outward = normal[way] > 0.0 ? 1 : -1;
    constexpr double kAlongGrid = 1.0 - 1.0e-6;  // cosine [-]
    return std::abs(normal[way]) < kAlongGrid && std::abs(normal[way]) > kLeastRatio * std::abs(normal[axis]);
}

void SlantedWalls::begin(const ColoredBlocks& near)
{
    if (passing_.size() < near.blocks.size()) passing_.resize(near.blocks.size());
    for (std::vector<Passing>& passing : passing_) passing.clear();
}

/// The faces near walls of which not the same is open as P2G brings them.
void SlantedWalls::find(const CutGrid& cut, const ColoredBlocks& near, const BlockBits<3>& known)
{
    parallelFor(near.blocks.size(), [&](std::size_t n) {
        const int b = near.blocks[n];
        for (int a = 0; a < kAxes; ++a)
            for (int row = 0; row < kBlockCells; row += kLanes) {
                const Pack excess = absPack(loadPack(cut.field.room(b, a) + row) - loadPack(cut.field.open(b, a) + row));
                const auto ofRow = static_cast<unsigned>(known.block(b, a)[row >> 6] >> (row & 63)) & 0xffu;
                for (unsigned left = maskBits(excess > kLeastExcess) & ofRow; left != 0; left &= left - 1) {
                    Passing passing{};
                    passing.face = static_cast<std::uint16_t>(row + std::countr_zero(left));
                    passing.axis = static_cast<std::uint8_t>(a);
                    if (findWay(cut, b, passing)) passing_[n].push_back(passing);
                }
            }
    });
}

/// How much room a face passes in one of its turns, and where to: back towards the wall what is missing there, if that is more than in front, else all
/// that it has beyond its open part away from the wall.
double SlantedWalls::choose(const CutGrid& cut, int block, const BlockBits<3>& known, Passing& passing, int turn) const
{
    const int a = passing.axis;
    const double excess = cut.field.room(block, a)[passing.face] - cut.field.open(block, a)[passing.face];
    if (excess < kLeastExcess) return 0.0;
    const auto missing = [&](int step) {
        const CellRef at = passing.beside(cut.grid, block, step);
        if (!known.test(at.block, at.cell, a)) return -1.0;
        return std::max(0.0, cut.field.open(at.block, a)[at.cell] - cut.field.room(at.block, a)[at.cell]);
    };
    const double inFront = missing(passing.outward), behind = missing(-passing.outward);
    const bool goesBack = behind > std::max(inFront, kLeastExcess);
    passing.toward[turn] = static_cast<std::int8_t>(goesBack ? -passing.outward : passing.outward);
    if (goesBack) return std::min(excess, behind);
    return inFront < 0.0 ? 0.0 : excess;
}

void SlantedWalls::pass(const CutGrid& cut, const ColoredBlocks& near, const BlockBits<3>& known, ObstacleField& field, FaceFields& faces,
                        BlockArray<double, 3>& weightless)
{
    find(cut, near, known);
    for (int sweep = 0; sweep < kSweeps; ++sweep)
        near.inColors([&](int place, int b) {
            const int turn = sweep >> 1;
            for (Passing& passing : passing_[place]) {
                if (passing.parity() != (sweep & 1)) continue;
                const int a = passing.axis, face = passing.face;
                const double passed = choose(cut, b, known, passing, turn), share = passed / field.room(b, a)[face];
                passing.share[turn] = share;
                if (passed == 0.0) continue;
                const CellRef to = passing.beside(cut.grid, b, passing.toward[turn]);
                const auto give = [&](double* from, double* of) {
                    const double given = share * from[face];
                    of[to.cell] += given;
                    from[face] -= given;
                };
                for (int kind : {FaceFields::kMass + a, FaceFields::kMomentum + a}) give(faces.sums.block(b, kind), faces.sums.block(to.block, kind));
                give(weightless.block(b, a), weightless.block(to.block, a));
                field.addRoom(to.block, a, to.cell, passed);
                field.addRoom(b, a, face, -passed);
            }
        });
}

void SlantedWalls::read(const BlockGrid& grid, const ColoredBlocks& near, BlockArray<double, 3>& velocity) const
{
    for (int sweep = kSweeps - 1; sweep >= 0; --sweep)
        parallelFor(near.blocks.size(), [&](std::size_t n) {
            const int b = near.blocks[n];
            for (const Passing& passing : passing_[n]) {
                const double share = passing.share[sweep >> 1];
                if (passing.parity() != (sweep & 1) || share == 0.0) continue;
                const CellRef from = passing.beside(grid, b, passing.toward[sweep >> 1]);
                double& u = velocity.block(b, passing.axis)[passing.face];
                u += share * (velocity.block(from.block, passing.axis)[from.cell] - u);
            }
        });
}

}  // namespace sim
