#include "sim/liquid/deep_faces.h"

#include "sim/core/parallel.h"
#include "sim/grid/rows.h"

#include <algorithm>

namespace sim {

namespace {

/// Bits of plane k of a block's cells: those of free bodies.
std::uint64_t freeCells(const HeldBodies& held, int block, int k)
{
    const ConnectedComponents& components = held.components();
    const std::vector<FreeLiquid::Body>& bodies = held.free().bodies;
    const int one = components.ofBlock(block);
    const std::uint64_t deep = held.liquid().deep.block(block)[k];
    if (one == -1) return 0;
    if (one >= 0) return bodies[one].isHeld ? 0 : deep;
    std::uint64_t free = 0;
    for (std::uint64_t left = deep; left != 0; left &= left - 1) {
        const int body = components.of(block, 64 * k + std::countr_zero(left));
        if (body >= 0 && !bodies[body].isHeld) free |= left & -left;
    }
    return free;
}

}  // namespace

bool weighDeepFaces(const CutGrid& cut, const HeldBodies& bodies, PressureFaces& faces)
{
    if (std::ranges::all_of(bodies.free().bodies, [](const FreeLiquid::Body& body) { return body.isHeld; })) return false;
    const LiquidGrid& liquid = bodies.liquid();
    return parallelSum(cut.grid.count(), [&](std::size_t n) {
               const int b = static_cast<int>(n);
               const BitAccess access(cut.grid, b);
               double any = 0.0;
               for (int k = 0; k < kBlockEdge; ++k) {
                   const std::uint64_t cells = freeCells(bodies, b, k);
                   for (int a = 0; a < kAxes && cells != 0; ++a) {
                       const std::uint64_t deep = cells & access.below(liquid.deep, 0, a, k);
                       if (deep != 0) any = 1.0;
                       for (int j = 0; j < kBlockEdge; ++j) {
                           const int row = cellInBlock(0, j, k);
                           const Pack room = liquid.fullMass * loadPack(cut.field.room(b, a) + row);
                           const Pack mass = loadPack(liquid.faces.sums.block(b, FaceFields::kMass + a) + row);
                           double* coefficient = faces.coefficient().block(b, a) + row;
                           const Pack full = loadPack(coefficient), own = full * (room / maxPack(mass, kLeastFill * room));
                           storePack(coefficient, select(rowBits(deep, j), own, full));
                       }
                   }
               }
               return any;
           }) > 0.0;
}

}  // namespace sim
