#include "sim/liquid/strain_correction.h"

#include "sim/core/parallel.h"
#include "sim/grid/rows.h"
#include "sim/particles/velocity_modes.h"

namespace sim {

namespace {

/// 1/m̂ of faces that have no part in the correction [-]: means with it are 0 for any number that matters.
constexpr double kNoMass = 1.0e200;

/// Masses of the faces of a row as the pressure has them, relative to a full one [-].
[[gnu::always_inline]] inline Pack massOf(const CutGrid& cut, const PressureFaces& faces, int block, int axis, int row)
{
    const Pack open = loadPack(cut.field.open(block, axis) + row), room = loadPack(cut.field.room(block, axis) + row);
    return faces.ofFull() * open * room / loadPack(faces.coefficient().block(block, axis) + row);
}

/// Impulses and masses of the faces. Those between deep cells count as full, for with the noise of what P2G put there amid liquid the correction of a
/// gradient would be none, and take energy from vortices; where the pressure has them otherwise what counts is its impulse.
void findImpulses(const CutGrid& cut, const BlockArray<double, 3>& before, const PressureFaces& faces, StrainWorkspace& work)
{
    const LiquidGrid& liquid = faces.liquid();
    parallelFor(cut.grid.count(), 4, [&](std::size_t n) {
        const int b = static_cast<int>(n);
        const BitAccess access(cut.grid, b);
        for (int a = 0; a < kAxes; ++a)
            for (int k = 0; k < kBlockEdge; ++k) {
                const std::uint64_t deepFaces = liquid.deep.block(b)[k] & access.below(liquid.deep, 0, a, k);
                for (int j = 0; j < kBlockEdge; ++j) {
                    const int row = cellInBlock(0, j, k);
                    const PackMask known = (loadPack(faces.coefficient().block(b, a) + row) > 0.0) & rowBits(work.acts.block(b, a), j, k);
                    const PackMask closed = loadPack(cut.field.open(b, a) + row) == 0.0;
                    Pack inverse = select(closed, broadcast(0.0), broadcast(kNoMass)), impulse = broadcast(0.0);
                    if (maskBits(known) != 0) {
                        const Pack own = massOf(cut, faces, b, a, row), room = loadPack(cut.field.room(b, a) + row);
                        const Pack mass = select(rowBits(deepFaces, j), room, own);
                        const Pack now = loadPack(liquid.faces.velocity.block(b, a) + row), change = now - loadPack(before.block(b, a) + row);
                        const Pack pressed = now - loadPack(liquid.unpressed.block(b, a) + row);
                        inverse = select(known, 1.0 / mass, inverse);
                        impulse = select(known, change + (own / mass - 1.0) * pressed, impulse);
                    }
                    storePack(work.inverseMass.block(b, a) + row, inverse);
                    storePack(work.impulse.block(b, a) + row, impulse);
                }
            }
    });
}

/// Harmonic mean of the masses of the two faces of a row's cells along an axis; closed ones have none and are left out.
[[gnu::always_inline]] inline Pack meanAcross(Pack below, Pack above)
{
    const Pack one = broadcast(1.0), zero = broadcast(0.0);
    const Pack count = select(below > 0.0, one, zero) + select(above > 0.0, one, zero), sum = below + above;
    return select(sum > 0.0, count / sum, zero);
}

/// What strains of the impulses in each cell and around each edge give to the faces there.
void findStrains(const BlockGrid& grid, StrainWorkspace& work)
{
    parallelFor(grid.count(), 2, [&](std::size_t n) {
        const int b = static_cast<int>(n);
        const RowAccess rows(grid, b);
        for (int k = 0; k < kBlockEdge; ++k)
            for (int j = 0; j < kBlockEdge; ++j) {
                const int row = cellInBlock(0, j, k);
                unroll<3>([&](auto a) {
                    const Pack mean = meanAcross(rows.row(work.inverseMass, a, j, k), rows.above(work.inverseMass, a, a, j, k));
                    const Pack step = rows.above(work.impulse, a, a, j, k) - rows.row(work.impulse, a, j, k);
                    storePack(work.stretch.block(b, a) + row, kSplineVariance * mean * step);
                    constexpr int c = (a + 1) % 3, d = (a + 2) % 3;
                    const Pack m[] = {rows.row(work.inverseMass, c, j, k), rows.below(work.inverseMass, c, d, j, k),
                                      rows.row(work.inverseMass, d, j, k), rows.below(work.inverseMass, d, c, j, k)};
                    const PackMask all = (m[0] > 0.0) & (m[1] > 0.0) & (m[2] > 0.0) & (m[3] > 0.0);
                    const Pack turn = rows.row(work.impulse, c, j, k) - rows.below(work.impulse, c, d, j, k) + rows.row(work.impulse, d, j, k) -
                                      rows.below(work.impulse, d, c, j, k);
                    const Pack shear = (0.5 * kSplineVariance * 4.0) / ((m[0] + m[1]) + (m[2] + m[3])) * turn;
                    storePack(work.shear.block(b, a) + row, select(all, shear, broadcast(0.0)));
                });
            }
    });
}

void applyStrains(const CutGrid& cut, const PressureFaces& faces, const StrainWorkspace& work, LiquidGrid& liquid)
{
    parallelFor(cut.grid.count(), 2, [&](std::size_t n) {
        const int b = static_cast<int>(n);
        const RowAccess rows(cut.grid, b);
        for (int k = 0; k < kBlockEdge; ++k)
            for (int j = 0; j < kBlockEdge; ++j) {
                const int row = cellInBlock(0, j, k);
                unroll<3>([&](auto a) {
                    const PackMask known = (loadPack(faces.coefficient().block(b, a) + row) > 0.0) & rowBits(work.acts.block(b, a), j, k);
                    if (maskBits(known) == 0) return;
                    constexpr int c = (a + 1) % 3, d = (a + 2) % 3;
                    Pack sum = rows.below(work.stretch, a, a, j, k) - rows.row(work.stretch, a, j, k);
                    sum += rows.row(work.shear, d, j, k) - rows.above(work.shear, d, c, j, k);
                    sum += rows.row(work.shear, c, j, k) - rows.above(work.shear, c, d, j, k);
                    double* velocity = liquid.faces.velocity.block(b, a) + row;
                    const Pack change = sum / massOf(cut, faces, b, a, row);
                    storePack(velocity, loadPack(velocity) + select(known, change, broadcast(0.0)));
                });
            }
    });
}

/// The empty block stands for air.
void resize(int blocks, StrainWorkspace& work)
{
    for (BlockArray<double, 3>* field : {&work.inverseMass, &work.impulse, &work.stretch, &work.shear}) field->resize(blocks);
    std::fill_n(work.inverseMass.block(blocks), BlockArray<double, 3>::kStride, kNoMass);
}

}  // namespace

void correctStrain(const CutGrid& cut, const BlockArray<double, 3>& before, const PressureFaces& faces, StrainWorkspace& work, LiquidGrid& liquid)
{
    resize(cut.grid.count(), work);
    findImpulses(cut, before, faces, work);
    findStrains(cut.grid, work);
    applyStrains(cut, faces, work, liquid);
}

}  // namespace sim
