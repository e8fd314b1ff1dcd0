#include "sim/liquid/free_liquid.h"

#include "sim/core/parallel.h"
#include "sim/grid/rows.h"

#include <algorithm>
#include <bit>
#include <limits>

namespace sim {

namespace {

using Body = FreeLiquid::Body;

constexpr int kBlocksPerTask = 4;

/// The fields that bodies are made of.
struct Fields {
    const BlockGrid& grid;
    const PressureComponents& system;
    const BlockArray<double, 3>& others;
    const FreeLiquid& work;
    BlockArray<double, 3>& values;

    const ConnectedComponents& components() const { return system.components(); }
    const LiquidGrid& liquid() const { return system.liquid(); }
    PackMask moving(int b, int a, int row) const { return loadPack(system.coefficient().block(b, a) + row) > 0.0; }

    /// The one body that the lower faces of a block's cells belong to; kSeveral, or −1 if none.
    int bodyOf(int b) const
    {
        int body = components().ofBlock(b);
        for (int below : {neighbourIndex(-1, 0, 0), neighbourIndex(0, -1, 0), neighbourIndex(0, 0, -1)}) {
            const int n = grid.neighbours(b)[below], other = n == grid.count() ? -1 : components().ofBlock(n);
            if (body == -1) body = other;
            else if (other != -1 && other != body) body = ConnectedComponents::kSeveral;
        }
        return body;
    }
    /// The bodies of the cells above and below the lower face of a cell; −1 for none.
    std::array<int, 2> bodiesOf(int b, int a, int c) const
    {
        Vec3i below(c & 7, c >> 3 & 7, c >> 6);
        --below[a];
        const CellRef other = cellNear(grid, b, below.x(), below.y(), below.z());
        return {components().of(b, c), other.block == grid.count() ? -1 : components().of(other.block, other.cell)};
    }
};

/// Is there anything on a lower face of a block's cells that has a cell with a pressure beside it?
bool isHeld(const Fields& fields, int b)
{
    const BitAccess access(fields.grid, b);
    for (int a = 0; a < kAxes; ++a)
        for (int k = 0; k < kBlockEdge; ++k) {
            const std::uint64_t inside = fields.liquid().inside.block(b)[k] | access.below(fields.liquid().inside, 0, a, k);
            if ((inside & ~fields.work.unheld.block(b, a)[k]) != 0) return true;
        }
    return false;
}

/// Marks the bodies that something holds on a lower face of a cell of a block that several belong to.
void holdByFaces(const Fields& fields, int b, std::vector<Body>& bodies)
{
    const BitAccess access(fields.grid, b);
    for (int a = 0; a < kAxes; ++a)
        for (int k = 0; k < kBlockEdge; ++k) {
            const std::uint64_t inside = fields.liquid().inside.block(b)[k] | access.below(fields.liquid().inside, 0, a, k);
            for (std::uint64_t held = inside & ~fields.work.unheld.block(b, a)[k]; held != 0; held &= held - 1)
                for (int body : fields.bodiesOf(b, a, 64 * k + std::countr_zero(held)))
                    if (body >= 0) bodies[body].isHeld = true;
        }
}

void findHeld(const Fields& fields, std::vector<Body>& ofBlock, std::vector<Body>& bodies)
{
    const int blocks = fields.grid.count();
    ofBlock.resize(blocks);
    parallelFor(blocks, kBlocksPerTask, [&](std::size_t b) {
        ofBlock[b] = {};
        if (fields.bodyOf(static_cast<int>(b)) >= 0) ofBlock[b].isHeld = isHeld(fields, static_cast<int>(b));
    });
    bodies.assign(fields.components().count(), {});
    for (int b = 0; b < blocks; ++b) {
        const int body = fields.bodyOf(b);
        if (body >= 0) bodies[body].isHeld = bodies[body].isHeld || ofBlock[b].isHeld;
        else if (body == ConnectedComponents::kSeveral) holdByFaces(fields, b, bodies);
    }
}

/// Sums over the lower faces of a block that belongs to one body.
void sumOverBlock(const Fields& fields, int b, Body& sum)
{
    for (int a = 0; a < kAxes; ++a) {
        const double *mass = fields.liquid().faces.sums.block(b, FaceFields::kMass + a), *value = fields.others.block(b, a);
        Pack masses = broadcast(0.0), values = masses;
        for (int row = 0; row < kBlockCells; row += kLanes) {
            const PackMask moving = fields.moving(b, a, row);
            const Pack m = select(moving, loadPack(mass + row), broadcast(0.0));
            masses += m;
            values += select(moving, m * loadPack(value + row), broadcast(0.0));
        }
        sum.mass[a] = sumLanes(masses);
        sum.sum[a] = sumLanes(values);
    }
}

/// Add the lower faces of a block's cells to the several bodies that they belong to.
void addByFaces(const Fields& fields, int b, std::vector<Body>& bodies)
{
    for (int a = 0; a < kAxes; ++a)
        for (int c = 0; c < kBlockCells; ++c) {
            if (!(fields.system.coefficient().block(b, a)[c] > 0.0)) continue;
            const std::array<int, 2> both = fields.bodiesOf(b, a, c);
            const int body = std::max(both[0], both[1]);  // the same, where both are, as the face moves
            if (body < 0 || bodies[body].isHeld) continue;
            const double mass = fields.liquid().faces.sums.block(b, FaceFields::kMass + a)[c];
            bodies[body].mass[a] += mass;
            bodies[body].sum[a] += mass * fields.others.block(b, a)[c];
        }
}

/// Of the free bodies.
void findSums(const Fields& fields, std::vector<Body>& ofBlock, std::vector<Body>& bodies)
{
    const int blocks = fields.grid.count();
    parallelFor(blocks, kBlocksPerTask, [&](std::size_t b) {
        const int body = fields.bodyOf(static_cast<int>(b));
        if (body >= 0 && !bodies[body].isHeld) sumOverBlock(fields, static_cast<int>(b), ofBlock[b]);
    });
    for (int b = 0; b < blocks; ++b) {
        const int body = fields.bodyOf(b);
        if (body == ConnectedComponents::kSeveral) addByFaces(fields, b, bodies);
        if (body < 0 || bodies[body].isHeld) continue;
        bodies[body].mass += ofBlock[b].mass;
        bodies[body].sum += ofBlock[b].sum;
    }
}

/// Of a body that nothing holds; 0 of others.
Vec3 meanOf(const Body& body)
{
    if (body.isHeld) return Vec3::Zero();
    return body.sum.cwiseQuotient(body.mass.cwiseMax(std::numeric_limits<double>::min()));
}

/// Add the velocity of the solids on the lower faces of a block's cells to what holds the bodies there.
void addHolders(const Fields& fields, const ObstacleField& obstacles, int b, std::vector<FreeLiquid::Holder>& holders)
{
    const BitAccess access(fields.grid, b);
    for (int a = 0; a < kAxes; ++a)
        for (int k = 0; k < kBlockEdge; ++k) {
            const std::uint64_t inside = fields.liquid().inside.block(b)[k] | access.below(fields.liquid().inside, 0, a, k);
            for (std::uint64_t left = inside & ~fields.work.unheld.block(b, a)[k]; left != 0; left &= left - 1) {
                const int c = 64 * k + std::countr_zero(left);
                if (obstacles.open(b, a)[c] >= 1.0) continue;
                const Vec3 velocity(obstacles.wallVelocity(b, 0)[c], obstacles.wallVelocity(b, 1)[c], obstacles.wallVelocity(b, 2)[c]);
                for (int body : fields.bodiesOf(b, a, c)) {
                    if (body < 0) continue;
                    holders[body].velocity += velocity;
                    ++holders[body].faces;
                }
            }
        }
}

/// Mean of what holds the bodies in a block, by their cells, and the number of these cells.
FreeLiquid::Holder holderIn(const Fields& fields, int b)
{
    FreeLiquid::Holder sum;
    const int one = fields.components().ofBlock(b);
    if (one >= 0) return {fields.work.holders[one].velocity, 1};
    if (one == -1) return sum;
    for (int c = 0; c < kBlockCells; ++c) {
        const int body = fields.components().of(b, c);
        if (body < 0 || !fields.work.bodies[body].isHeld) continue;
        sum.velocity += fields.work.holders[body].velocity;
        ++sum.faces;
    }
    if (sum.faces > 0) sum.velocity /= sum.faces;
    return sum;
}

void shiftBlock(const Fields& fields, int b)
{
    const int one = fields.bodyOf(b);
    if (one == -1) return;
    const Vec3 mean = one >= 0 ? meanOf(fields.work.bodies[one]) : Vec3::Zero();
    if (one >= 0 && mean.isZero(0.0)) return;
    for (int a = 0; a < kAxes; ++a) {
        double* values = fields.values.block(b, a);
        for (int row = 0; row < kBlockCells; row += kLanes) {
            Pack shift = broadcast(mean[a]);
            const unsigned moving = maskBits(fields.moving(b, a, row));
            if (one < 0)
                for (int i = 0; i < kLanes; ++i) {
                    const std::array<int, 2> both = (moving >> i & 1) != 0 ? fields.bodiesOf(b, a, row + i) : std::array{-1, -1};
                    const int body = std::max(both[0], both[1]);
                    shift[i] = body >= 0 ? meanOf(fields.work.bodies[body])[a] : 0.0;
                }
            storePack(values + row, loadPack(values + row) - select(maskOfBits(moving), shift, broadcast(0.0)));
        }
    }
}

}  // namespace

UnheldFaces findUnheldFaces(const CutGrid& cut, FreeLiquid& work)
{
    work.unheld.resize(cut.grid.count());
    parallelFor(cut.grid.count(), kBlocksPerTask, [&](std::size_t n) {
        const int b = static_cast<int>(n);
        for (int a = 0; a < kAxes; ++a) std::copy_n(cut.field.whole(b, a), BlockBits<3>::kWords, work.unheld.block(b, a));
    });
    return UnheldFaces(work);
}

HeldBodies::HeldBodies(const BlockGrid& grid, const PressureComponents& system, const UnheldFaces& unheld)
    : PressureComponents(system), work_(unheld.work_)
{
    FreeLiquid& work = *unheld.work_;
    findHeld({grid, system, system.liquid().faces.velocity, work, work.change}, work.ofBlock, work.bodies);
}

HeldBodies findHeldBodies(const BlockGrid& grid, const PressureComponents& system, const UnheldFaces& unheld)
{
    return HeldBodies(grid, system, unheld);
}

void takeMeans(const BlockGrid& grid, const HeldBodies& bodies, const BlockArray<double, 3>& others, FreeLiquid& work, BlockArray<double, 3>& values)
{
    const Fields fields{grid, bodies, others, work, values};
    for (Body& body : work.bodies) body = {.isHeld = body.isHeld};
    if (std::ranges::all_of(work.bodies, [](const Body& body) { return body.isHeld; })) return;
    findSums(fields, work.ofBlock, work.bodies);
    parallelFor(grid.count(), kBlocksPerTask, [&](std::size_t b) { shiftBlock(fields, static_cast<int>(b)); });
}

void findFrames(const CutGrid& cut, const HeldBodies& bodies, const Vec3& otherwise, FreeLiquid& work)
{
    const Fields fields{cut.grid, bodies, bodies.liquid().faces.velocity, work, work.change};
    work.holders.assign(fields.components().count(), {});
    for (int b : cut.field.blocksNearSolid()) addHolders(fields, cut.field, b, work.holders);
    for (FreeLiquid::Holder& holder : work.holders) holder.velocity = holder.faces > 0 ? Vec3(holder.velocity / holder.faces) : otherwise;
    work.frames.resize(cut.grid.count());
    parallelFor(cut.grid.count(), kBlocksPerTask, [&](std::size_t n) {
        FreeLiquid::Holder sum = holderIn(fields, static_cast<int>(n));
        if (sum.faces == 0)
            for (int neighbour : cut.grid.neighbours(static_cast<int>(n))) {
                const FreeLiquid::Holder beside = neighbour == cut.grid.count() ? FreeLiquid::Holder{} : holderIn(fields, neighbour);
                if (beside.faces == 0) continue;
                sum.velocity += (beside.velocity - sum.velocity) / ++sum.faces;
            }
        work.frames[n] = sum.velocity;
    });
}

void findHeldCells(const BlockGrid& grid, const HeldBodies& bodies, FreeLiquid& work)
{
    const ConnectedComponents& components = bodies.components();
    const BlockBits<>& insideLiquid = bodies.liquid().inside;
    for (BlockBits<>* bits : {&work.inHeld, &work.inFree, &work.held}) bits->resize(grid.count());
    parallelFor(grid.count(), kBlocksPerTask, [&](std::size_t n) {
        const int b = static_cast<int>(n), one = components.ofBlock(b);
        for (int k = 0; k < kBlockEdge; ++k) {
            std::uint64_t inside = one == -1 ? 0 : insideLiquid.block(b)[k], held = one >= 0 && work.bodies[one].isHeld ? inside : 0;
            for (std::uint64_t left = one == ConnectedComponents::kSeveral ? inside : 0; left != 0; left &= left - 1) {
                const int body = components.of(b, 64 * k + std::countr_zero(left));
                if (body >= 0 && work.bodies[body].isHeld) held |= left & -left;
            }
            work.inHeld.block(b)[k] = held;
            work.inFree.block(b)[k] = inside & ~held;
        }
    });
    parallelFor(grid.count(), kBlocksPerTask, [&](std::size_t n) {
        const int b = static_cast<int>(n);
        const BitAccess access(grid, b);
        for (int k = 0; k < kBlockEdge; ++k) {
            std::uint64_t near = work.inHeld.block(b)[k];
            for (int a = 0; a < kAxes; ++a) near |= access.below(work.inHeld, 0, a, k) | access.above(work.inHeld, 0, a, k);
            work.held.block(b)[k] = near & ~work.inFree.block(b)[k];
        }
    });
}

}  // namespace sim
