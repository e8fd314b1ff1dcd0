#include "sim/liquid/wall_faces.h"

#include "sim/core/parallel.h"
#include "sim/grid/rows.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <functional>

namespace sim {

namespace {

/// Call f(face) for each bit of one kind of a block.
template <class F>
void forEachBit(const std::uint64_t* words, F&& f)
{
    for (int k = 0; k < kBlockEdge; ++k)
        for (std::uint64_t bits = words[k]; bits != 0; bits &= bits - 1) f(k * 64 + std::countr_zero(bits));
}

/// Call f(face) for those of the six neighbours of a face that are known.
template <class F>
void forEachKnownBeside(const BlockGrid& grid, int block, int axis, int face, const BlockBits<3>& known, F&& f)
{
    const Vec3i cell(face & 7, face >> 3 & 7, face >> 6);
    for (int a = 0; a < kAxes; ++a)
        for (int side = -1; side <= 1; side += 2) {
            Vec3i at = cell;
            at[a] += side;
            const CellRef ref = cellNear(grid, block, at.x(), at.y(), at.z());
            if (known.test(ref.block, ref.cell, axis)) f(ref);
        }
}

/// Faces that are known after a sweep and were not before.
std::array<std::uint64_t, kBlockEdge> freshBits(const BlockBits<3>& known, const BlockBits<3>& before, int block, int axis)
{
    std::array<std::uint64_t, kBlockEdge> fresh;
    for (int k = 0; k < kBlockEdge; ++k) fresh[k] = known.block(block, axis)[k] & ~before.block(block, axis)[k];
    return fresh;
}

/// Is a face in a plane wall that is normal to its axis? Other solids may reach behind that, but nothing gets through it.
bool isInPlaneWall(const Obstacles& obstacles, const Vec3& x, int axis, double dx)
{
    constexpr double kInPlane = 1.0e-6;  // [cells]
    return std::ranges::any_of(obstacles.planeWalls(),
                               [&](const Obstacles::Wall& wall) { return wall.axis == axis && std::abs(x[axis] - wall.at) < kInPlane * dx; });
}

}  // namespace

void WallFaces::findLayers(const CutGrid& cut, const FaceFields& faces)
{
    for (BlockBits<3>& known : known_) {
        known.resize(cut.grid.count());
        std::fill_n(known.block(0), (static_cast<std::size_t>(cut.grid.count()) + 1) * kAxes * BlockBits<3>::kWords, 0);
    }
    const std::vector<int>& blocks = cut.field.blocksNearSolid();
    const auto hasMass = [&](int b, int a, int k) {
        const double* mass = faces.sums.block(b, FaceFields::kMass + a) + k * 64;
        std::uint64_t bits = 0;
        for (int c = 0; c < 64; ++c) bits |= std::uint64_t{mass[c] > 0.0} << c;
        return bits;
    };
    // Only blocks near solids are looked at, and those have no closed neighbour outside of them.
    parallelFor(blocks.size(), [&](std::size_t n) {
        const int b = blocks[n];
        for (int a = 0; a < kAxes; ++a)
            for (int k = 0; k < kBlockEdge; ++k) known_[0].block(b, a)[k] = hasMass(b, a, k) & ~cut.field.closed(b, a)[k];
    });
    for (int layer = 1; layer <= kLayers; ++layer)
        parallelFor(blocks.size(), [&](std::size_t n) {
            const int b = blocks[n];
            const BitAccess bits(cut.grid, b);
            const BlockBits<3>& known = known_[layer - 1];
            for (int a = 0; a < kAxes; ++a)
                for (int k = 0; k < kBlockEdge; ++k) {
                    std::uint64_t beside = 0;
                    for (int axis = 0; axis < kAxes; ++axis) beside |= bits.below(known, a, axis, k) | bits.above(known, a, axis, k);
                    const std::uint64_t fresh = beside & cut.field.closed(b, a)[k] & ~known.block(b, a)[k];
                    known_[layer].block(b, a)[k] = known.block(b, a)[k] | fresh;
                }
        });
}

void WallFaces::findFollowers(const BlockGrid& grid, const Obstacles& obstacles, double friction, const FaceFields& faces)
{
    constexpr double kAlong = 1.0 - 1.0e-6;  ///< cosine from which a wall's normal is along the grid [-]
    parallelFor(near_.blocks.size(), [&](std::size_t n) {
        const int b = near_.blocks[n];
        followers_[n].clear();
        for (int a = 0; a < kAxes; ++a)
            forEachBit(freshBits(known_[kLayers], known_[0], b, a).data(), [&](int face) {
                if (!(faces.sums.block(b, FaceFields::kMass + a)[face] > 0.0)) return;
                Vec3 x = grid.lowerCorner(b) + grid.dx * Vec3((face & 7) + 0.5, (face >> 3 & 7) + 0.5, (face >> 6) + 0.5);
                x[a] -= 0.5 * grid.dx;
                const bool isAcross = std::abs(obstacles.normal(x)[a]) > kAlong || isInPlaneWall(obstacles, x, a, grid.dx);
                const double share = isAcross ? 0.0 : 1.0 - friction;
                followers_[n].push_back({static_cast<std::uint16_t>(face), static_cast<std::uint8_t>(a), share});
            });
    });
    count_ = 0;
    for (std::size_t n = 0; n < near_.blocks.size(); ++n) count_ += followers_[n].size();
}

void WallFaces::find(const CutGrid& cut, double friction, const FaceFields& faces)
{
    near_.set(cut.grid, cut.field.blocksNearSolid());
    if (followers_.size() < near_.blocks.size()) followers_.resize(near_.blocks.size());
    slanted_.begin(near_);
    mirrored.resize(cut.grid.count());
    if (near_.blocks.empty()) {
        count_ = 0;
        return;
    }
    findLayers(cut, faces);
    findFollowers(cut.grid, cut.obstacles, friction, faces);
}

WallFaces::WallDriven WallFaces::drivenByWalls(const ObstacleField& field, const FaceFields& faces, const BlockArray<double, 3>& weightless) const
{
    const auto ofBlock = [&](std::size_t n) {
        const int b = near_.blocks[n];
        WallDriven sum;
        for (const Follower& f : followers_[n]) {
            if (f.share == 0.0) continue;
            const double mass = faces.sums.block(b, FaceFields::kMass + f.axis)[f.face],
                         momentum = faces.sums.block(b, FaceFields::kMomentum + f.axis)[f.face], weighs = mass - weightless.block(b, f.axis)[f.face],
                         wall = field.wallVelocity(b, f.axis)[f.face];
            sum.work += (1.0 - f.share) * (mass * wall - momentum) * wall;
            sum.heavy[f.axis] += (1.0 - f.share) * weighs * wall;
        }
        return sum;
    };
    return parallelReduce(near_.blocks.size(), WallDriven{}, ofBlock, std::plus<>());
}

void WallFaces::fold(const CutGrid& cut, ObstacleField& field, FaceFields& faces, BlockArray<double, 3>& weightless)
{
    field.foldRoom(!empty());
    if (empty()) return;
    folded_.resize(static_cast<int>(near_.blocks.size()));
    parallelFor(near_.blocks.size(), 8,
                [&](std::size_t n) { std::fill_n(folded_.block(static_cast<int>(n)), BlockArray<double, kFolded>::kStride, 0.0); });
    constexpr std::array kKinds = {kMass, kMomentum, kRoom, kWeightless};
    const auto give = [&](CellRef to, int component, double share, const std::array<double, kKinds.size()>& what) {
        double* target = folded_.block(near_.place[to.block]) + to.cell;
        for (std::size_t n = 0; n < kKinds.size(); ++n) target[(kKinds[n] + component) * kBlockCells] += share * what[n];
    };
    // First each closed face's share …
    parallelFor(near_.blocks.size(), 4, [&](std::size_t n) {
        const int b = near_.blocks[n];
        for (const Follower& f : followers_[n]) {
            if (f.share == 0.0) continue;
            double &mass = faces.sums.block(b, FaceFields::kMass + f.axis)[f.face],
                   &momentum = faces.sums.block(b, FaceFields::kMomentum + f.axis)[f.face], &held = weightless.block(b, f.axis)[f.face];
            give({b, f.face}, f.axis, f.share, {mass, momentum, field.room(b, f.axis)[f.face], held});
            mass = momentum = held = 0.0;
        }
    });
    // … and then forwards, sweep by sweep.
    for (int layer = kLayers; layer >= 1; --layer)
        near_.inColors([&](int place, int b) {
            for (int a = 0; a < kAxes; ++a) {
                forEachBit(freshBits(known_[layer], known_[layer - 1], b, a).data(), [&](int face) {
                    const double* from = folded_.block(place) + face;
                    int count = 0;
                    forEachKnownBeside(cut.grid, b, a, face, known_[layer - 1], [&](CellRef) { ++count; });
                    std::array<double, kKinds.size()> what;
                    for (std::size_t n = 0; n < kKinds.size(); ++n) what[n] = from[(kKinds[n] + a) * kBlockCells];
                    forEachKnownBeside(cut.grid, b, a, face, known_[layer - 1], [&](CellRef to) { give(to, a, 1.0 / count, what); });
                });
            }
        });
    parallelFor(near_.blocks.size(), [&](std::size_t n) {
        const int b = near_.blocks[n];
        for (int a = 0; a < kAxes; ++a)
            forEachBit(known_[0].block(b, a), [&](int face) {
                const double* from = folded_.block(static_cast<int>(n)) + face;
                faces.sums.block(b, FaceFields::kMass + a)[face] += from[(kMass + a) * kBlockCells];
                faces.sums.block(b, FaceFields::kMomentum + a)[face] += from[(kMomentum + a) * kBlockCells];
                field.addRoom(b, a, face, from[(kRoom + a) * kBlockCells]);
                weightless.block(b, a)[face] += from[(kWeightless + a) * kBlockCells];
            });
    });
    slanted_.pass(cut, near_, known_[0], field, faces, weightless);
}

void WallFaces::extend(const CutGrid& cut, BlockBits<3>& valid, BlockArray<double, 3>& velocity)
{
    if (!empty()) slanted_.read(cut.grid, near_, velocity);
    for (int layer = 1; layer <= kLayers && !empty(); ++layer)
        parallelFor(near_.blocks.size(), [&](std::size_t n) {
            const int b = near_.blocks[n];
            for (int a = 0; a < kAxes; ++a) {
                forEachBit(freshBits(known_[layer], known_[layer - 1], b, a).data(), [&](int face) {
                    double sum = 0.0;
                    int count = 0;
                    forEachKnownBeside(cut.grid, b, a, face, known_[layer - 1], [&](CellRef from) {
                        sum += velocity.block(from.block, a)[from.cell];
                        ++count;
                    });
                    velocity.block(b, a)[face] = sum / count;
                });
            }
        });
    parallelFor(near_.blocks.size(), [&](std::size_t n) {
        const int b = near_.blocks[n];
        for (int a = 0; a < kAxes; ++a)
            forEachBit(cut.field.closed(b, a), [&](int face) {
                if (known_[kLayers].test(b, face, a)) valid.set(b, face, a);
                else velocity.block(b, a)[face] = cut.field.wallVelocity(b, a)[face];
            });
        for (const Follower& f : followers_[n]) {
            double& u = velocity.block(b, f.axis)[f.face];
            u = f.share * u + (1.0 - f.share) * cut.field.wallVelocity(b, f.axis)[f.face];
        }
    });
}

}  // namespace sim
