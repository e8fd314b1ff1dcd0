#include "sim/liquid/liquid_on_solids.h"

#include "sim/core/parallel.h"
#include "sim/grid/rows.h"

#include <algorithm>
#include <bit>

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

/// The solid that is nearest to a face.
int nearestTo(const CutGrid& cut, const CellRef& face, int axis)
{
    const ObstacleField& field = cut.field;
    const CellRef below = cellBeside(cut.grid, face.block, face.cell, axis, -1);
    const bool isOwn = field.centerDistance(face.block)[face.cell] <= field.centerDistance(below.block)[below.cell];
    return isOwn ? field.owner(face.block)[face.cell] : field.owner(below.block)[below.cell];
}

/// Of the liquid, or of the solid that closes the face [cm/s].
double velocityAt(const ObstacleField& field, const LiquidGrid& liquid, const CellRef& face, int axis)
{
    return isClosed(field, face, axis) ? field.wallVelocity(face.block, axis)[face.cell] : liquid.faces.velocity.block(face.block, axis)[face.cell];
}

}  // namespace

void LiquidOnSolids::begin(const CutGrid& cut, const FaceFields& faces)
{
    const double near = ObstacleField::kExactDistance * cut.grid.dx;
    solids_ = cut.obstacles.count();
    hasOthers_ = false;
    blocks_ = cut.field.blocksNearSolid();
    place_.assign(cut.grid.count() + 1, BlockGrid::kNone);
    brought_.resize(static_cast<int>(blocks_.size()));
    others_.resize(static_cast<int>(blocks_.size()));
    shared_.resize(static_cast<int>(blocks_.size()));
    near_.resize(cut.grid.count());
    std::fill_n(near_.block(0), static_cast<std::size_t>(cut.grid.count()) * BlockBits<>::kWords, 0);
    parallelFor(blocks_.size(), 4, [&](std::size_t n) {
        place_[blocks_[n]] = static_cast<int>(n);
        const double* distance = cut.field.centerDistance(blocks_[n]);
        for (int row = 0; row < kBlockCells; row += kLanes)
            near_.block(blocks_[n])[row >> 6] |= std::uint64_t{maskBits(loadPack(distance + row) < near)} << (row & 63);
    });
    parallelFor(blocks_.size(), 4, [&](std::size_t n) {
        const int b = blocks_[n], place = static_cast<int>(n);
        const BitAccess bits(cut.grid, b);
        for (int a = 0; a < kAxes; ++a)
            for (int k = 0; k < kBlockEdge; ++k) {
                if (facesNear(bits, b, a, k) == 0) continue;
                std::copy_n(faces.sums.block(b, FaceFields::kMass + a) + 64 * k, 64, brought_.block(place, kMass + a) + 64 * k);
                std::copy_n(faces.sums.block(b, FaceFields::kMomentum + a) + 64 * k, 64, brought_.block(place, kMomentum + a) + 64 * k);
            }
    });
}

void LiquidOnSolids::clearOthers()
{
    if (hasOthers_) return;
    hasOthers_ = true;
    parallelFor(blocks_.size(), 4, [&](std::size_t n) {
        std::fill_n(others_.block(static_cast<int>(n)), BlockArray<double, 3>::kStride, 0.0);
        std::fill_n(shared_.block(static_cast<int>(n)), kAxes * BlockBits<3>::kWords, 0);
    });
}

LiquidOnSolids::Levelling LiquidOnSolids::meetLevelling()
{
    clearOthers();
    return Levelling(*this);
}

LiquidOnSolids::Exchange LiquidOnSolids::meetFabric()
{
    clearOthers();
    return Exchange(*this);
}

LiquidOnSolids::KeptVelocities LiquidOnSolids::keepVelocities(const BlockArray<double, 3>& velocity)
{
    clearOthers();
    before_.resize(static_cast<int>(blocks_.size()));
    parallelFor(blocks_.size(), 4,
                [&](std::size_t n) { std::copy_n(velocity.block(blocks_[n]), BlockArray<double, 3>::kStride, before_.block(static_cast<int>(n))); });
    return KeptVelocities();
}

double LiquidOnSolids::afterViscosity(const KeptVelocities&, const CutGrid& cut, const ViscousSystem& system, const LiquidGrid& liquid)
{
    const bool sticks = system.wall.size() > 0;
    return parallelSum(blocks_.size(), [&](std::size_t n) {
        const int b = blocks_[n], place = static_cast<int>(n);
        double work = 0.0;
        for (int a = 0; a < kAxes; ++a) {
            const double *mass = liquid.faces.sums.block(b, FaceFields::kMass + a), *u = liquid.faces.velocity.block(b, a),
                         *before = before_.block(place, a), *wall = cut.field.wallVelocity(b, a);
            double* others = others_.block(place, a);
            for (int c = 0; c < kBlockCells; ++c) {
                double onSolid = sticks ? system.wall.block(b, a)[c] * (u[c] - wall[c]) : 0.0;
                if (isClosed(cut.field, {b, c}, a)) {
                    // The cells on both sides pull at the face by their normal strains.
                    const CellRef above = cellBeside(cut.grid, b, c, a, 1), below = cellBeside(cut.grid, b, c, a, -1);
                    const double own = velocityAt(cut.field, liquid, {b, c}, a);
                    onSolid += system.normal.block(b, a)[c] * (velocityAt(cut.field, liquid, above, a) - own) -
                               system.normal.block(below.block, a)[below.cell] * (own - velocityAt(cut.field, liquid, below, a));
                }
                others[c] += mass[c] * (u[c] - before[c]) + onSolid;
                work -= onSolid * wall[c];
            }
        }
        return work;
    });
}

void LiquidOnSolids::afterStrain(const KeptVelocities&, const CutGrid& cut, const StrainWorkspace& strain, const LiquidGrid& liquid)
{
    parallelFor(blocks_.size(), 4, [&](std::size_t n) {
        const int b = blocks_[n], place = static_cast<int>(n);
        for (int a = 0; a < kAxes; ++a) {
            const double *mass = liquid.faces.sums.block(b, FaceFields::kMass + a), *u = liquid.faces.velocity.block(b, a),
                         *before = before_.block(place, a), *stretch = strain.stretch.block(b, a);
            double* others = others_.block(place, a);
            for (int c = 0; c < kBlockCells; ++c) {
                others[c] += mass[c] * (u[c] - before[c]);
                if (!isClosed(cut.field, {b, c}, a)) continue;
                const CellRef below = cellBeside(cut.grid, b, c, a, -1);
                others[c] += liquid.fullMass * (strain.stretch.block(below.block, a)[below.cell] - stretch[c]);
            }
        }
    });
}

/// Faces of plane k of a block that a solid is near to, and where there is anything of the liquid, or its viscosity pulls.
std::uint64_t LiquidOnSolids::wetNear(const BitAccess& bits, const Outcome& outcome, std::size_t place, int axis, int k) const
{
    const int b = blocks_[place];
    const std::uint64_t near = facesNear(bits, b, axis, k);
    if (near == 0) return 0;
    const BlockBits<>& inside = outcome.liquid.inside;
    const double* mass = brought_.block(static_cast<int>(place), kMass + axis) + 64 * k;
    std::uint64_t wet = inside.block(b)[k] | bits.below(inside, 0, axis, k);
    for (int row = 0; row < 64; row += kLanes) wet |= std::uint64_t{maskBits(loadPack(mass + row) > 0.0)} << row;
    if (hasOthers_) {
        const double* others = others_.block(static_cast<int>(place), axis) + 64 * k;
        for (int row = 0; row < 64; row += kLanes) wet |= std::uint64_t{maskBits(absPack(loadPack(others + row)) > 0.0)} << row;
    }
    return near & wet;
}

/// K, but on faces of the pressure system, which feel K times their room if they are as full as they count: there also what they are short of,
/// or have beyond, as it is not from a solid [cm^2 s].
Pack LiquidOnSolids::stepOf(const CutGrid& cut, const Outcome& outcome, const FaceRow& faces) const
{
    const auto [place, axis, row] = faces;
    const int b = blocks_[place];
    const Pack coefficient = loadPack(outcome.system.coefficient().block(b, axis) + row), all = broadcast(outcome.perPressure);
    PackMask counts = coefficient > 0.0;
    if (hasOthers_) counts &= ~maskOfBits(shared_.block(static_cast<int>(place), axis)[row >> 6] >> (row & 63));
    const Pack mass = loadPack(outcome.liquid.faces.sums.block(b, FaceFields::kMass + axis) + row);
    const Pack felt = mass * cut.grid.dx * coefficient / loadPack(cut.field.open(b, axis) + row);
    return select(counts, all - (all * loadPack(cut.field.room(b, axis) + row) - felt), all);
}

LiquidOnSolids::GotByRow LiquidOnSolids::onRow(const CutGrid& cut, const Outcome& outcome, const FaceRow& faces) const
{
    const auto [place, axis, row] = faces;
    const int b = blocks_[place], n = static_cast<int>(place), j = row >> 3 & 7, k = row >> 6;
    const RowAccess rows(cut.grid, b);
    Pack above = rows.row(outcome.pressure, 0, j, k), under = rows.below(outcome.pressure, 0, axis, j, k);
    if (outcome.again) {
        above += rows.row(*outcome.again, 0, j, k);
        under += rows.below(*outcome.again, 0, axis, j, k);
    }
    const Pack mass = loadPack(brought_.block(n, kMass + axis) + row);
    Pack before = loadPack(brought_.block(n, kMomentum + axis) + row);
    if (outcome.flipVelocity)
        before = outcome.flipRatio * mass * loadPack(outcome.flipVelocity->block(b, axis) + row) + (1.0 - outcome.flipRatio) * before;
    if (hasOthers_) before += loadPack(others_.block(n, axis) + row);
    const Pack after = mass * (loadPack(outcome.velocity.block(b, axis) + row) - outcome.fall[axis]);
    return {after - before + stepOf(cut, outcome, faces) * (above - under),
            outcome.perPressure * (1.0 - loadPack(cut.field.open(b, axis) + row)) * (absPack(above) + absPack(under)),
            outcome.perPressure * (above - under)};
}

/// Where several solids are near, pressure is on those that close the face, by their areas; what else the face got is from the one that is nearest.
void LiquidOnSolids::addShared(const CutGrid& cut, const FaceRow& row, int lane, const Vec3& at, const GotByRow& on, std::span<OnSolid> sums) const
{
    const ObstacleField& field = cut.field;
    const int b = blocks_[row.place], c = row.first + lane, axis = row.axis;
    const FaceOcclusion occlusion = field.occlusion(b, axis, c);
    const double closed = occlusion.ofFirst + occlusion.ofSecond, rest = on.got[lane] - closed * on.push[lane];
    const auto add = [&](int solid, double got, double share, double work) {
        sums[solid] += {{-got * Vec3::Unit(axis), -got * at.cross(Vec3::Unit(axis))}, share * on.pressed[lane], share * on.pressed[lane] * at, work};
    };
    add(nearestTo(cut, {b, c}, axis), rest, 0.0, rest * field.wallVelocity(b, axis)[c]);
    if (!(closed > 0.0)) return;
    add(occlusion.first, occlusion.ofFirst * on.push[lane], occlusion.ofFirst / closed, on.push[lane] * field.swept(b, axis)[c]);
    if (occlusion.second != FaceOcclusion::kNone) add(occlusion.second, occlusion.ofSecond * on.push[lane], occlusion.ofSecond / closed, 0.0);
}

/// To the solids that the faces of a row are nearest to.
void LiquidOnSolids::addRow(const CutGrid& cut, const FaceRow& where, unsigned faces, const GotByRow& on, std::span<OnSolid> sums) const
{
    const int b = blocks_[where.place], axis = where.axis, row = where.first;
    Vec3 x = cut.grid.lowerCorner(b) + cut.grid.dx * Vec3(0.5, (row >> 3 & 7) + 0.5, (row >> 6) + 0.5);
    x[axis] -= 0.5 * cut.grid.dx;
    const auto add = [&](int solid, double got, double pressed, const Vec3& gotAt, const Vec3& pressedAt, double work) {
        sums[solid] += {{-got * Vec3::Unit(axis), -gotAt.cross(Vec3::Unit(axis))}, pressed, pressedAt, work};
    };
    const Pack work = on.got * loadPack(cut.field.wallVelocity(b, axis) + row);
    if (solids_ == 1) {
        constexpr Pack kPlaces = {0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0};
        const Pack got = select(maskOfBits(faces), on.got, broadcast(0.0)), pressed = select(maskOfBits(faces), on.pressed, broadcast(0.0));
        const double allGot = sumLanes(got), allPressed = sumLanes(pressed);
        add(0, allGot, allPressed, allGot * x + cut.grid.dx * sumLanes(got * kPlaces) * Vec3::UnitX(),
            allPressed * x + cut.grid.dx * sumLanes(pressed * kPlaces) * Vec3::UnitX(), sumLanes(select(maskOfBits(faces), work, broadcast(0.0))));
        return;
    }
    for (; faces != 0; faces &= faces - 1) {
        const int i = std::countr_zero(faces), c = row + i;
        const Vec3 at = x + cut.grid.dx * i * Vec3::UnitX();
        if (cut.field.isShared(b)) {
            addShared(cut, where, i, at, on, sums);
            continue;
        }
        add(nearestTo(cut, {b, c}, axis), on.got[i], on.pressed[i], on.got[i] * at, on.pressed[i] * at, work[i]);
    }
}

void LiquidOnSolids::finishBlock(const CutGrid& cut, const Outcome& outcome, std::size_t place, std::span<OnSolid> sums) const
{
    const BitAccess bits(cut.grid, blocks_[place]);
    for (int a = 0; a < kAxes; ++a)
        for (int k = 0; k < kBlockEdge; ++k) {
            const std::uint64_t wet = wetNear(bits, outcome, place, a, k);
            for (int j = 0; j < kBlockEdge && wet != 0; ++j) {
                const unsigned faces = wet >> (j * kBlockEdge) & 0xff;
                if (faces == 0) continue;
                const FaceRow row = {place, a, cellInBlock(0, j, k)};
                addRow(cut, row, faces, onRow(cut, outcome, row), sums);
            }
        }
}

void LiquidOnSolids::finish(const CutGrid& cut, const Outcome& outcome)
{
    const Chunks chunks(blocks_.size());
    sums_.begin(chunks.count(), solids_);
    parallelFor(chunks.count(), [&](std::size_t c) {
        for (std::size_t n = chunks.begin(c); n < chunks.end(c); ++n) finishBlock(cut, outcome, n, sums_.of(c));
    });
}

}  // namespace sim
