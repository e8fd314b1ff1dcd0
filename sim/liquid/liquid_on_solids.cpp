#include "sim/liquid/liquid_on_solids.h"

#include "sim/core/parallel.h"

#include <algorithm>
#include <cmath>

namespace sim {

namespace {

/// A cell one above or below another along an axis.
CellRef cellBeside(const BlockGrid& grid, int block, int cell, int axis, int step)
{
    Vec3i at(cell & 7, cell >> 3 & 7, cell >> 6);
    at[axis] += step;
    return cellNear(grid, block, at.x(), at.y(), at.z());
}

bool isClosed(const ObstacleField& field, const CellRef& face, int axis) { return field.open(face.block, axis)[face.cell] == 0.0; }

/// Of the liquid, or of the solid that closes the face [cm/s].
double velocityAt(const ObstacleField& field, const LiquidGrid& liquid, const CellRef& face, int axis)
{
    return isClosed(field, face, axis) ? field.wallVelocity(face.block, axis)[face.cell] : liquid.faces.velocity.block(face.block, axis)[face.cell];
}

}  // namespace

void LiquidOnSolids::begin(const BlockGrid& grid, const ObstacleField& field, const Obstacles& obstacles, const FaceFields& faces)
{
    solids_ = obstacles.count();
    blocks_ = field.blocksNearSolid();
    place_.assign(grid.count() + 1, BlockGrid::kNone);
    brought_.resize(static_cast<int>(blocks_.size()));
    others_.resize(static_cast<int>(blocks_.size()));
    shared_.resize(static_cast<int>(blocks_.size()));
    parallelFor(blocks_.size(), 4, [&](std::size_t n) {
        const int place = static_cast<int>(n);
        place_[blocks_[n]] = place;
        std::copy_n(faces.sums.block(blocks_[n]), BlockArray<double, 6>::kStride, brought_.block(place));
        std::fill_n(others_.block(place), BlockArray<double, 3>::kStride, 0.0);
        std::fill_n(shared_.block(place), kAxes * BlockBits<3>::kWords, 0);
    });
}

void LiquidOnSolids::beforeViscosity(const BlockArray<double, 3>& velocity)
{
    before_.resize(static_cast<int>(blocks_.size()));
    parallelFor(blocks_.size(), 4, [&](std::size_t n) {
        std::copy_n(velocity.block(blocks_[n]), BlockArray<double, 3>::kStride, before_.block(static_cast<int>(n)));
    });
}

void LiquidOnSolids::afterViscosity(const BlockGrid& grid, const ObstacleField& field, const ViscousSystem& system, const LiquidGrid& liquid)
{
    const bool sticks = system.wall.size() > 0;
    parallelFor(blocks_.size(), [&](std::size_t n) {
        const int b = blocks_[n], place = static_cast<int>(n);
        for (int a = 0; a < kAxes; ++a) {
            const double *mass = liquid.faces.sums.block(b, FaceFields::kMass + a), *u = liquid.faces.velocity.block(b, a),
                         *before = before_.block(place, a), *wall = field.wallVelocity(b, a);
            double* others = others_.block(place, a);
            for (int c = 0; c < kBlockCells; ++c) {
                others[c] += mass[c] * (u[c] - before[c]);
                if (sticks) others[c] -= system.wall.block(b, a)[c] * (wall[c] - u[c]);
                if (!isClosed(field, {b, c}, a)) continue;
                // The cells on both sides pull at the face by their normal strains.
                const CellRef above = cellBeside(grid, b, c, a, 1), below = cellBeside(grid, b, c, a, -1);
                const double own = velocityAt(field, liquid, {b, c}, a);
                others[c] += system.normal.block(b, a)[c] * (velocityAt(field, liquid, above, a) - own) -
                             system.normal.block(below.block, a)[below.cell] * (own - velocityAt(field, liquid, below, a));
            }
        }
    });
}

/// What pressure does to a face is K times its room, if it is as full as it counts: the rest, per step of the pressure [cm^2 s].
double LiquidOnSolids::excess(const BlockGrid& grid, const ObstacleField& field, const Outcome& outcome, std::size_t place, int axis, int cell) const
{
    const int b = blocks_[place];
    const double coefficient = outcome.system.coefficient.block(b, axis)[cell];
    if (coefficient == 0.0 || shared_.test(static_cast<int>(place), cell, axis)) return 0.0;
    const double mass = outcome.liquid.faces.sums.block(b, FaceFields::kMass + axis)[cell];
    return outcome.perPressure * field.room(b, axis)[cell] - mass * grid.dx * coefficient / field.open(b, axis)[cell];
}

void LiquidOnSolids::finishBlock(const BlockGrid& grid, const ObstacleField& field, const Outcome& outcome, std::size_t place,
                                 std::span<OnSolid> sums) const
{
    const int b = blocks_[place], n = static_cast<int>(place);
    const double near = ObstacleField::kExactDistance * grid.dx;
    const auto pressureAt = [&](const CellRef& cell) {
        return outcome.pressure.block(cell.block)[cell.cell] + (outcome.again ? outcome.again->block(cell.block)[cell.cell] : 0.0);
    };
    for (int a = 0; a < kAxes; ++a) {
        const double *mass = brought_.block(n, kMass + a), *momentum = brought_.block(n, kMomentum + a), *others = others_.block(n, a),
                     *u = outcome.velocity.block(b, a), *open = field.open(b, a);
        for (int c = 0; c < kBlockCells; ++c) {
            const CellRef below = cellBeside(grid, b, c, a, -1);
            const double own = field.centerDistance(b)[c], other = field.centerDistance(below.block)[below.cell];
            if (std::min(own, other) >= near) continue;
            const double above = pressureAt({b, c}), under = pressureAt(below);
            if (mass[c] == 0.0 && above == under) continue;
            double before = momentum[c];
            if (outcome.flipVelocity)
                before = outcome.flipRatio * mass[c] * outcome.flipVelocity->block(b, a)[c] + (1.0 - outcome.flipRatio) * momentum[c];
            const double perStep = outcome.perPressure - excess(grid, field, outcome, place, a, c);
            const double got = mass[c] * (u[c] - outcome.fall[a]) - before - others[c] + perStep * (above - under);
            const double pressed = outcome.perPressure * (1.0 - open[c]) * (std::abs(above) + std::abs(under));
            Vec3 x = grid.lowerCorner(b) + grid.dx * Vec3((c & 7) + 0.5, (c >> 3 & 7) + 0.5, (c >> 6) + 0.5);
            x[a] -= 0.5 * grid.dx;
            const int solid = own <= other ? field.owner(b)[c] : field.owner(below.block)[below.cell];
            sums[solid] += {Impulse::at(x, -got * Vec3::Unit(a)), pressed, pressed * x};
        }
    }
}

void LiquidOnSolids::finish(const BlockGrid& grid, const ObstacleField& field, const Outcome& outcome)
{
    const Chunks chunks(blocks_.size());
    sums_.begin(chunks.count(), solids_);
    parallelFor(chunks.count(), [&](std::size_t c) {
        for (std::size_t n = chunks.begin(c); n < chunks.end(c); ++n) finishBlock(grid, field, outcome, n, sums_.of(c));
    });
}

}  // namespace sim
