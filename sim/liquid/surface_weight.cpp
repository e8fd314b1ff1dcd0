#include "sim/liquid/surface_weight.h"

#include "sim/core/parallel.h"
#include "sim/grid/rows.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numeric>
#include <optional>
#include <span>

namespace sim {

namespace {

/// Most weight that a face may get, relative to that of its own mass: more would store energy in sprays (SolidsWork: .5 % of it with 4, .24 % so) [-].
constexpr double kMostWeight = 1.5;

using OfColumn = std::array<double, kMostSurfaceColumn>;

/// A column of faces against gravity, the lowest first.
struct Column {
    std::array<CellRef, kMostSurfaceColumn> face;
    int size = 0;
    bool isTopFree = false;  ///< the highest has no pressure
};

/// The face so many cells further along an axis; the same where there is no block.
CellRef faceBeside(const BlockGrid& grid, const CellRef& face, int axis, int step)
{
    if (face.block == grid.count()) return face;
    Vec3i at(face.cell & 7, face.cell >> 3 & 7, face.cell >> 6);
    at[axis] += step;
    return cellNear(grid, face.block, at.x(), at.y(), at.z());
}

/// The axis of the grid that gravity is nearest to, along which columns stand.
struct Upright {
    int axis;
    int up;         ///< direction along it against gravity, 1 or -1
    int mostFaces;  ///< that a column of the surface layer may have

    explicit Upright(const Vec3& gravity)
    {
        const double along = gravity.cwiseAbs().maxCoeff(&axis);
        up = gravity[axis] < 0.0 ? 1 : -1;
        mostFaces = kSurfaceColumn + static_cast<int>(std::ceil(3.0 * std::sqrt(std::max(gravity.squaredNorm() / (along * along) - 1.0, 0.0))));
    }
};

/// Finds the columns of the surface layer of the faces of one axis.
class SurfaceColumns {
 public:
    SurfaceColumns(const CutGrid& cut, const HeldBodies& bodies, int axis, const Upright& upright)
        : grid_(cut.grid), obstacles_(cut.field), bodies_(bodies), free_(bodies.free()), liquid_(bodies.liquid()), axis_(axis), upright_(upright)
    {
    }

    /// The faces of a plane of a block that have a pressure on some side and are not between deep cells.
    std::uint64_t shallow(const BitAccess& access, int block, int k) const
    {
        std::uint64_t known = 0;
        for (int j = 0; j < kBlockEdge; ++j) {
            const Pack coefficient = loadPack(bodies_.coefficient().block(block, axis_) + cellInBlock(0, j, k));
            known |= std::uint64_t{maskBits(coefficient > 0.0)} << (j * kBlockEdge);
        }
        return known & ~(liquid_.deep.block(block)[k] & access.below(liquid_.deep, 0, axis_, k));
    }

    /// The column that stands on this face: none, or of size 0, if it is not the lowest of one, or if its weight is to stay where it is.
    Column from(const CellRef& lowest) const
    {
        Column column;
        const CellRef under = beside(lowest, -upright_.up);
        if (!isDeep(under) && !isSolid(under)) return column;
        if (!isHeld(lowest)) return column;
        for (CellRef at = lowest;; at = beside(at, upright_.up)) {
            const bool known = isKnown(at);
            if (!known && (!isWet(at) || isSolid(at))) break;
            if (column.size == upright_.mostFaces || isDeep(at) || (free_.hasFabric && !free_.bare.test(at.block, at.cell, axis_))) return {};
            column.face[column.size++] = at;
            if (!known) {
                column.isTopFree = true;
                break;
            }
        }
        return column;
    }

 private:
    CellRef beside(const CellRef& face, int step) const { return faceBeside(grid_, face, upright_.axis, step); }
    CellRef cellBefore(const CellRef& face) const { return faceBeside(grid_, face, axis_, -1); }
    bool exists(const CellRef& face) const { return face.block != grid_.count(); }
    bool isKnown(const CellRef& face) const { return exists(face) && bodies_.coefficient().block(face.block, axis_)[face.cell] > 0.0; }
    bool isWet(const CellRef& face) const { return exists(face) && liquid_.wet.test(face.block, face.cell, axis_); }
    bool isSolid(const CellRef& face) const { return exists(face) && obstacles_.open(face.block, axis_)[face.cell] == 0.0; }
    bool isDeep(const CellRef& face) const
    {
        if (!isKnown(face) || !liquid_.deep.test(face.block, face.cell)) return false;
        const CellRef below = cellBefore(face);
        return exists(below) && liquid_.deep.test(below.block, below.cell);
    }
    /// Does a solid hold the body that the face belongs to?
    bool isHeld(const CellRef& face) const
    {
        const ConnectedComponents& components = bodies_.components();
        const CellRef below = cellBefore(face);
        const int own = components.of(face.block, face.cell), other = exists(below) ? components.of(below.block, below.cell) : -1,
                  body = std::max(own, other);  // the same, where both are, as the face moves
        return body >= 0 && free_.bodies[body].isHeld;
    }

    const BlockGrid& grid_;
    const ObstacleField& obstacles_;
    const HeldBodies& bodies_;
    const FreeLiquid& free_;
    const LiquidGrid& liquid_;
    int axis_;
    Upright upright_;
};

/// How high, above the lowest face, liquid of this mass stands in a column, if a full face has `full` of it.
double levelOf(const EvenWeight& even, std::span<const double> full, double mass)
{
    const double mean = std::accumulate(full.begin(), full.end(), 0.0) / static_cast<double>(full.size());
    double level = mass / mean - 0.5;  // exact where all faces are as large: the shares add up to half a face more than the level
    constexpr int kRounds = 8;
    for (int round = 0; round < kRounds; ++round) {
        double sum = 0.0, slope = 0.0;
        for (std::size_t n = 0; n < full.size(); ++n) {
            sum += full[n] * even.share(level - static_cast<double>(n));
            slope += full[n] * even.slope(level - static_cast<double>(n));
        }
        if (!(slope > 0.1 * mean)) break;
        level += std::clamp((mass - sum) / slope, -1.0, 1.0);
    }
    return level;
}

/// Weights of the faces of a column that is even: what the splines of its particles would leave there if the liquid filled it up to a level.
/// @param full  faces' masses when they are full [g]; out: the weights
/// @param mass  of all [g]
/// @return  the level, above the lowest face [cells]
double fillEvenly(const EvenWeight& even, std::span<double> full, double mass)
{
    const double level = levelOf(even, full, mass);
    for (std::size_t n = 0; n < full.size(); ++n) full[n] *= even.share(level - static_cast<double>(n));
    return level;
}

/// Puts the weight of columns of faces of an axis where their liquid would be if it were even.
struct Levelling {
    const CutGrid& cut;
    int axis;
    Upright upright;
    EvenWeight even;
    double gravityStep;  ///< what weight has given to velocities along the axis [cm/s]
    LiquidGrid& liquid;
    const std::optional<LiquidOnSolids::Levelling>& told;
    PressureBeyond& beyond;

    /// Weights of a column's faces [g] as if it were even, by which none has much more than its own mass.
    /// @param weight  out
    /// @return  the level of the even column, above its lowest face [cells]
    double findWeights(const Column& column, const OfColumn& mass, OfColumn& weight) const
    {
        for (int n = 0; n < column.size; ++n) weight[n] = liquid.fullMass * cut.field.room(column.face[n].block, axis)[column.face[n].cell];
        double above = std::accumulate(mass.begin(), mass.begin() + column.size, 0.0), rest = above;
        const double level = fillEvenly(even, std::span(weight).first(column.size), above);
        for (int n = 0; n < column.size; ++n) {
            above -= mass[n];
            const double least = rest - kMostWeight * above;
            if (n + 1 == column.size) weight[n] = rest;
            else weight[n] = std::clamp(weight[n], least, std::min(rest, kMostWeight * mass[n]));
            rest -= weight[n];
        }
        return level;
    }

    /// The cell above the highest face with a pressure bears the face above it, if there is one, and presses on the face below.
    /// @param level  of the column above its lowest face [cells]
    void bearTop(const Column& column, double level, OfColumn& weight) const
    {
        const int top = column.size - 1, highest = column.isTopFree ? top - 1 : top;
        const CellRef &below = column.face[highest], &above = column.face[top];
        const CellRef cell = upright.up > 0 ? below : column.isTopFree ? above : faceBeside(cut.grid, below, axis, -1);
        double impulse = 0.0;
        if (column.isTopFree) {
            impulse = std::abs(gravityStep) * weight[top] / cut.field.room(above.block, axis)[above.cell];
            weight[highest] += weight[top];
            weight[top] = 0.0;
        }
        if (cell.block != cut.grid.count()) beyond.bear(cell, impulse, level - highest + kMostSurfaceColumn);
    }

    void operator()(const Column& column) const
    {
        OfColumn mass{}, weight{};
        for (int n = 0; n < column.size; ++n) mass[n] = liquid.faces.sums.block(column.face[n].block, FaceFields::kMass + axis)[column.face[n].cell];
        const double level = findWeights(column, mass, weight);
        if (axis == upright.axis) bearTop(column, level, weight);
        else if (column.isTopFree) {  // what pressure it has comes from the cells beside it (PressureBeyond), which balances all of its own weight
            const int top = column.size - 1;
            weight[top - 1] += weight[top] - mass[top];
            weight[top] = mass[top];
        }
        for (int n = 0; n < column.size; ++n) {
            const auto [block, cell] = column.face[n];
            const double change = gravityStep * (weight[n] / mass[n] - 1.0);
            liquid.faces.velocity.block(block, axis)[cell] += change;
            if (told) told->weightGrew(block, axis, cell, mass[n] * change);
        }
    }
};

}  // namespace

double depthOfPressure(double cells)
{
    if (std::abs(cells) >= 1.0) return std::max(cells, 0.0);
    const double rest = 1.0 - std::abs(cells);
    return std::max(cells, 0.0) + rest * rest * rest / 6.0;
}

double EvenWeight::slope(double cells) const
{
    const auto ofPressure = [](double d) {
        const double rest = std::max(1.0 - std::abs(d), 0.0);
        return d > 0.0 ? 1.0 - 0.5 * rest * rest : 0.5 * rest * rest;
    };
    return (ofPressure(cells + half_) - ofPressure(cells - half_)) / (2.0 * half_);
}

void levelWeight(const CutGrid& cut, const HeldBodies& bodies, const Vec3& gravityStep, LiquidGrid& liquid, LiquidOnSolids* onSolids,
                 PressureBeyond& beyond)
{
    if (std::ranges::none_of(bodies.free().bodies, [](const FreeLiquid::Body& body) { return body.isHeld; })) return;
    std::optional<LiquidOnSolids::Levelling> told;
    if (onSolids != nullptr) told = onSolids->meetLevelling();
    beyond.begin(cut.grid.count(), gravityStep);
    const Upright upright(gravityStep);
    for (int a = 0; a < kAxes; ++a) {
        if (gravityStep[a] == 0.0) continue;
        const SurfaceColumns columns(cut, bodies, a, upright);
        const Levelling level{cut, a, upright, EvenWeight(gravityStep[a] / gravityStep[upright.axis]), gravityStep[a], liquid, told, beyond};
        parallelFor(cut.grid.count(), 4, [&](std::size_t n) {
            const int b = static_cast<int>(n);
            const BitAccess access(cut.grid, b);
            for (int k = 0; k < kBlockEdge; ++k)
                for (std::uint64_t left = columns.shallow(access, b, k); left != 0; left &= left - 1) {
                    const Column column = columns.from({b, 64 * k + std::countr_zero(left)});
                    if (column.size > 1) level(column);
                }
        });
    }
    beyond.push(cut, bodies, liquid, told);
}

}  // namespace sim
