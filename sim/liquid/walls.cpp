#include "sim/liquid/walls.h"

#include "sim/core/parallel.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace sim {

namespace {

constexpr double kNearestWall = 0.1;  ///< to a face [cells]
constexpr int kMirrorDepth = 2;       ///< layers behind a wall that stencils in front of it touch

/// Call f(cell) for each closed face of a block normal to `axis`.
template <class F>
void forEachClosedFace(const ObstacleField& field, int block, int axis, F&& f)
{
    const std::uint64_t* closed = field.closed(block, axis);
    for (int k = 0; k < kBlockEdge; ++k)
        for (std::uint64_t bits = closed[k]; bits != 0; bits &= bits - 1) f(k * 64 + std::countr_zero(bits));
}

/// The velocity of a closed face that goes on straight from those of the open ones beside it; the wall's own where there are none.
double extrapolateLinearly(const CutGrid& cut, const BlockBits<3>& valid, const BlockArray<double, 3>& velocity, int b, int axis, int face)
{
    constexpr double kFarthest = 1.0;  // the mirror image's speed: more would blow up rounding next to walls that almost touch a face
    const Vec3i cell(face & 7, face >> 3 & 7, face >> 6);
    double sum = 0.0;
    int count = 0;
    for (int side = 0; side < 4; ++side) {
        Vec3i front = cell;
        front[(axis + 1 + side / 2) % 3] += side % 2 == 0 ? 1 : -1;
        const CellRef ref = cellNear(cut.grid, b, front.x(), front.y(), front.z());
        if (!valid.test(ref.block, ref.cell, axis) || !(cut.field.open(ref.block, axis)[ref.cell] > 0.0)) continue;
        const double reach = wallReach(cut, b, axis, front, cell);
        const double relative = velocity.block(ref.block, axis)[ref.cell] - cut.field.wallVelocity(ref.block, axis)[ref.cell];
        sum -= std::min((1.0 - reach) / reach, kFarthest) * relative;
        ++count;
    }
    return cut.field.wallVelocity(b, axis)[face] + (count > 0 ? sum / count : 0.0);
}

void stick(const CutGrid& cut, bool goesStraight, const BlockBits<3>& valid, BlockArray<double, 3>& velocity)
{
    parallelFor(cut.field.blocksNearSolid().size(), 4, [&](std::size_t n) {
        const int b = cut.field.blocksNearSolid()[n];
        for (int a = 0; a < kAxes; ++a)
            forEachClosedFace(cut.field, b, a, [&](int face) {
                velocity.block(b, a)[face] =
                    goesStraight ? extrapolateLinearly(cut, valid, velocity, b, a, face) : cut.field.wallVelocity(b, a)[face];
            });
    });
}

/// Call f(component, layer, face, image) for the faces of one block that a wall at cell coordinate `plane` mirrors: those behind it with
/// their images in front, or the other way round. Normal faces of layer 0 stand in the plane and are their own image.
template <class F>
void forEachImage(const BlockGrid& grid, int b, const Obstacles::Wall& wall, int plane, bool behind, F&& f)
{
    const int first = kBlockEdge * grid.coords(b)[wall.axis];
    for (int layer = 0; layer <= kMirrorDepth; ++layer)
        for (int c = 0; c < kAxes; ++c) {
            const bool normal = c == wall.axis;
            if (!normal && layer == kMirrorDepth) continue;
            // Normal faces stand in the plane and `layer` cells away from it, tangential ones in the cells on either side.
            const int upper = plane + layer, lower = plane - layer - (normal ? 0 : 1);
            const int at = (behind == wall.above ? upper : lower) - first, image = upper + lower - 2 * first - at;
            if (at < 0 || at >= kBlockEdge) continue;
            for (int v = 0; v < kBlockEdge; ++v)
                for (int u = 0; u < kBlockEdge; ++u) {
                    Vec3i to, from;
                    to[wall.axis] = at;
                    from[wall.axis] = image;
                    to[(wall.axis + 1) % 3] = from[(wall.axis + 1) % 3] = u;
                    to[(wall.axis + 2) % 3] = from[(wall.axis + 2) % 3] = v;
                    f(c, layer, cellInBlock(to.x(), to.y(), to.z()), cellNear(grid, b, from.x(), from.y(), from.z()));
                }
        }
}

/// Call f(wall, plane, forBlocksAtWall) for each wall in a plane of faces, one after another, so that edges and corners get the image of
/// an image. forBlocksAtWall(g) calls g(block) for the blocks whose faces the wall mirrors.
template <class F>
void forEachPlaneWall(const BlockGrid& grid, const Obstacles& obstacles, F&& f)
{
    for (const Obstacles::Wall& wall : obstacles.planeWalls()) {
        const std::optional<int> found = planeOfFaces(grid, wall);
        if (!found) continue;
        const int plane = *found;
        f(wall, plane, [&](auto&& g) {
            parallelFor(grid.count(), 4, [&](std::size_t n) {
                const int first = kBlockEdge * grid.coords(static_cast<int>(n))[wall.axis];
                if (first <= plane + kMirrorDepth && first + kBlockEdge > plane - kMirrorDepth - 1) g(static_cast<int>(n));
            });
        });
    }
}

void mirror(const BlockGrid& grid, const Obstacles& obstacles, double friction, BlockBits<3>& valid, BlockBits<3>& newlyValid,
            BlockArray<double, 3>& velocity)
{
    forEachPlaneWall(grid, obstacles, [&](const Obstacles::Wall& wall, int plane, auto&& forBlocksAtWall) {
        forBlocksAtWall([&](int b) {
            for (int a = 0; a < kAxes; ++a) std::fill_n(newlyValid.block(b, a), BlockBits<3>::kWords, 0);
            forEachImage(grid, b, wall, plane, true, [&](int c, int layer, int face, CellRef image) {
                const bool normal = c == wall.axis, inWall = normal && layer == 0;
                if (!inWall && !valid.test(image.block, image.cell, c)) return;
                const double value = velocity.block(image.block, c)[image.cell];
                velocity.block(b, c)[face] = inWall ? 0.0 : normal ? -value : (1.0 - friction) * value;
                newlyValid.set(b, face, c);
            });
        });
        forBlocksAtWall([&](int b) {
            for (int a = 0; a < kAxes; ++a)
                for (int k = 0; k < kBlockEdge; ++k) valid.block(b, a)[k] |= newlyValid.block(b, a)[k];
        });
    });
}

}  // namespace

double faceDistance(const CutGrid& cut, int block, int axis, Vec3i cell)
{
    const CellRef upper = cellNear(cut.grid, block, cell.x(), cell.y(), cell.z());
    cell[axis] -= 1;
    const CellRef lower = cellNear(cut.grid, block, cell.x(), cell.y(), cell.z());
    return 0.5 * (cut.field.centerDistance(upper.block)[upper.cell] + cut.field.centerDistance(lower.block)[lower.cell]);
}

double wallReach(const CutGrid& cut, int block, int axis, const Vec3i& cell, const Vec3i& beside)
{
    const double own = faceDistance(cut, block, axis, cell), other = faceDistance(cut, block, axis, beside);
    return own > other ? std::clamp(own / (own - other), kNearestWall, 1.0) : 1.0;
}

void applyWalls(const CutGrid& cut, double friction, bool goesStraight, WallFaces& followers, BlockBits<3>& valid, BlockArray<double, 3>& velocity)
{
    if (!usesMirrorBoundary(friction)) {
        stick(cut, goesStraight, valid, velocity);
        return;
    }
    followers.extend(cut, valid, velocity);
    mirror(cut.grid, cut.obstacles, friction, valid, followers.mirrored, velocity);
}

void mirrorAtPlaneWalls(const BlockGrid& grid, const Obstacles& obstacles, FaceFields& faces, BlockArray<double, 3>& weightless)
{
    weightless.resize(grid.count());
    forEachPlaneWall(grid, obstacles, [&](const Obstacles::Wall&, int, auto&& forBlocksAtWall) {
        forBlocksAtWall([&](int b) { std::fill_n(weightless.block(b), BlockArray<double, 3>::kStride, 0.0); });
    });
    forEachPlaneWall(grid, obstacles, [&](const Obstacles::Wall& wall, int plane, auto&& forBlocksAtWall) {
        forBlocksAtWall([&](int b) {
            forEachImage(grid, b, wall, plane, false, [&](int c, int layer, int face, CellRef image) {
                const bool normal = c == wall.axis;
                if (normal && layer == 0) return;
                const double mass = faces.sums.block(image.block, FaceFields::kMass + c)[image.cell],
                             momentum = faces.sums.block(image.block, FaceFields::kMomentum + c)[image.cell],
                             held = weightless.block(image.block, c)[image.cell];
                faces.sums.block(b, FaceFields::kMass + c)[face] += mass;
                faces.sums.block(b, FaceFields::kMomentum + c)[face] += normal ? -momentum : momentum;
                weightless.block(b, c)[face] += normal ? 2.0 * mass - held : held;
            });
        });
        forBlocksAtWall([&](int b) {
            forEachImage(grid, b, wall, plane, true, [&](int c, int layer, int face, CellRef) {
                if (c == wall.axis && layer == 0) return;
                faces.sums.block(b, FaceFields::kMass + c)[face] = faces.sums.block(b, FaceFields::kMomentum + c)[face] = 0.0;
                weightless.block(b, c)[face] = 0.0;
            });
        });
    });
}

void mirrorAtWalls(const BlockGrid& grid, const Obstacles& obstacles, double friction, ObstacleField& field, WallFaces& followers, LiquidGrid& liquid)
{
    const std::vector<int>& blocks = field.blocksNearSolid();
    liquid.weightless.resize(grid.count());
    parallelFor(blocks.size(), 8, [&](std::size_t n) { std::fill_n(liquid.weightless.block(blocks[n]), BlockArray<double, 3>::kStride, 0.0); });
    mirrorAtPlaneWalls(grid, obstacles, liquid.faces, liquid.weightless);
    followers.find({grid, field, obstacles}, friction, liquid.faces);
    followers.driven = obstacles.anyMoving() ? followers.drivenByWalls(field, liquid.faces, liquid.weightless) : WallFaces::WallDriven{};
    followers.fold({grid, field, obstacles}, field, liquid.faces, liquid.weightless);
}

void withholdWeightOfImages(const ObstacleField& field, const Vec3& gravity, double dt, LiquidGrid& liquid)
{
    const std::vector<int>& blocks = field.blocksNearSolid();
    parallelFor(blocks.size(), 2, [&](std::size_t n) {
        for (int a = 0; a < kAxes; ++a) {
            if (gravity[a] == 0.0) continue;
            const double *held = liquid.weightless.block(blocks[n], a), *mass = liquid.faces.sums.block(blocks[n], FaceFields::kMass + a);
            double* velocity = liquid.faces.velocity.block(blocks[n], a);
            for (int c = 0; c < kBlockCells; ++c)
                if (held[c] != 0.0 && mass[c] > 0.0) velocity[c] -= dt * gravity[a] * held[c] / mass[c];
        }
    });
}

void levelWeightOfImages(const CutGrid& cut, const BlockBits<3>* bare, const Vec3& gravityStep, LiquidGrid& liquid)
{
    const auto isDeep = [&](int b, int axis, int face) {
        Vec3i lower(face & 7, face >> 3 & 7, face >> 6);
        lower[axis] -= 1;
        const CellRef below = cellNear(cut.grid, b, lower.x(), lower.y(), lower.z());
        return liquid.deep.test(b, face) && liquid.deep.test(below.block, below.cell) && (bare == nullptr || bare->test(b, face, axis));
    };
    const std::vector<int>& blocks = cut.field.blocksNearSolid();
    parallelFor(blocks.size(), 2, [&](std::size_t n) {
        const int b = blocks[n];
        for (int a = 0; a < kAxes; ++a) {
            if (gravityStep[a] == 0.0) continue;
            const double *held = liquid.weightless.block(b, a), *mass = liquid.faces.sums.block(b, FaceFields::kMass + a);
            for (int c = 0; c < kBlockCells; ++c)
                if (held[c] != 0.0 && mass[c] > 0.0 && isDeep(b, a, c)) liquid.faces.velocity.block(b, a)[c] += gravityStep[a] * held[c] / mass[c];
        }
    });
    forEachPlaneWall(cut.grid, cut.obstacles, [&](const Obstacles::Wall& wall, int plane, auto&& forBlocksAtWall) {
        const int a = wall.axis;
        if (gravityStep[a] == 0.0) return;
        const auto forDeepFaces = [&](int b, auto&& f) {
            forEachImage(cut.grid, b, wall, plane, false, [&](int c, int layer, int face, CellRef) {
                if (c == a && layer == 1 && isDeep(b, a, face)) f(face);
            });
        };
        const auto sumOf = [&](auto&& ofBlock) {
            return parallelSum(cut.grid.count(), [&](std::size_t n) {
                double sum = 0.0;
                forDeepFaces(static_cast<int>(n), [&](int face) { sum += ofBlock(static_cast<int>(n))[face]; });
                return sum;
            });
        };
        const double held = sumOf([&](int b) { return liquid.weightless.block(b, a); });
        const double mass = sumOf([&](int b) { return liquid.faces.sums.block(b, FaceFields::kMass + a); });
        if (!(mass > 0.0)) return;
        forBlocksAtWall([&](int b) { forDeepFaces(b, [&](int face) { liquid.faces.velocity.block(b, a)[face] -= gravityStep[a] * held / mass; }); });
    });
}

}  // namespace sim
