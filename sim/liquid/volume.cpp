#include "sim/liquid/volume.h"

#include "sim/core/parallel.h"
#include "sim/liquid/cells.h"

#include <algorithm>

namespace sim {

namespace {

/// Of the solve: what is left is corrected next time; less where pressures are asked for to less than 1e-6.
double volumeTolerance(const SolverSettings& solver) { return std::min(1.0e-2, 1.0e4 * solver.pressureTolerance); }
constexpr double kFillBelowSurface = 0.8;  ///< of cells beside surface cells, at least, while the liquid is in one piece
constexpr double kLargestError = 1.0;      ///< a cell that holds more than twice its volume expands like one that holds twice

/// Does a solid close a face of the cell, if only in part, on a side that is up?
bool isUnderSolid(const CutGrid& cut, const Vec3& gravity, int b, int c)
{
    for (int a = 0; a < kAxes; ++a) {
        if (gravity[a] == 0.0) continue;
        Vec3i at(c & 7, c >> 3 & 7, c >> 6);
        if (gravity[a] < 0.0) ++at[a];
        const CellRef face = cellNear(cut.grid, b, at.x(), at.y(), at.z());
        if (cut.field.open(face.block, a)[face.cell] < 1.0) return true;
    }
    return false;
}

/// Is a cell on a side that is up under a solid, and too empty to press on it?
bool isUnderGap(const CutGrid& cut, const Vec3& gravity, const LiquidGrid& liquid, int b, int c)
{
    for (int a = 0; a < kAxes; ++a) {
        if (gravity[a] == 0.0) continue;
        Vec3i at(c & 7, c >> 3 & 7, c >> 6);
        at[a] += gravity[a] < 0.0 ? 1 : -1;
        const CellRef up = cellNear(cut.grid, b, at.x(), at.y(), at.z());
        if (up.block == cut.grid.count() || !isUnderSolid(cut, gravity, up.block, up.cell)) continue;
        if (liquid.inside.test(up.block, up.cell) && liquid.fill.block(up.block)[up.cell] < kFillBelowSurface) return true;
    }
    return false;
}

/// Least that a cell holds where there is no hole. Cells at the surface may hold as little as they like, and so may those under a solid: what falls
/// off a ceiling is not pulled back to it, for nothing would pay for that. Cells under such a gap are as those at the surface or beside it.
double leastFill(const CutGrid& cut, const Vec3& gravity, const LiquidGrid& liquid, int b, int c)
{
    if (liquid.surface.test(b, c)) return 0.0;
    const bool isDeep = liquid.deep.test(b, c);
    if (!cut.field.nearSolid(b)) return isDeep ? 1.0 : kFillBelowSurface;
    if (isUnderSolid(cut, gravity, b, c)) return 0.0;
    if (isUnderGap(cut, gravity, liquid, b, c)) return isDeep ? kFillBelowSurface : 0.0;
    return isDeep ? 1.0 : kFillBelowSurface;
}

/// Error of a cell's volume that is noise [-]. Where solids take a part of the cell's room a few particles stand for what is left.
double noiseOf(const CutGrid& cut, double pitch, int b, int c)
{
    if (!cut.field.nearSolid(b)) return kVolumeNoise;
    double room = 0.0;
    int open = 0;
    for (int a = 0; a < kAxes; ++a)
        for (int side = 0; side < 2; ++side) {
            Vec3i at(c & 7, c >> 3 & 7, c >> 6);
            at[a] += side;
            const CellRef face = cellNear(cut.grid, b, at.x(), at.y(), at.z());
            if (cut.field.open(face.block, a)[face.cell] == 0.0) continue;
            room += cut.field.room(face.block, a)[face.cell];
            ++open;
        }
    return kVolumeNoise + std::min(kMostCutOffNoise, kCutOffNoise * pitch * pitch * pitch * std::max(0.0, open / room - 1.0));
}

/// Volume that a cell lacks (negative) or has too much, beyond noise, relative to its own.
double volumeError(const CutGrid& cut, const Vec3& gravity, const LiquidGrid& liquid, int b, int c)
{
    const double fill = liquid.fill.block(b)[c];
    if (std::abs(fill - 1.0) <= kVolumeNoise) return 0.0;
    if (fill > 1.0) return std::clamp(fill - 1.0 - noiseOf(cut, liquid.pitch, b, c), 0.0, kLargestError);
    const double least = leastFill(cut, gravity, liquid, b, c);
    return fill < least ? std::min(fill + noiseOf(cut, liquid.pitch, b, c) - least, 0.0) : 0.0;
}

void findSources(const CutGrid& cut, const Vec3& gravity, const LiquidGrid& liquid, double strength, BlockArray<double>& source)
{
    source.resize(cut.grid.count());
    parallelFor(cut.grid.count(), 4, [&](std::size_t n) {
        const int b = static_cast<int>(n);
        for (int c = 0; c < kBlockCells; ++c)
            source.block(b)[c] = liquid.inside.test(b, c) ? strength * volumeError(cut, gravity, liquid, b, c) : 0.0;
    });
}

void displaceFaces(const CutGrid& cut, const PressureFaces& faces, VolumeWorkspace& work)
{
    const Pack largest = broadcast(kLargestCorrection * cut.grid.dx);
    parallelFor(cut.grid.count(), 2, [&](std::size_t n) {
        const int b = static_cast<int>(n);
        for (int a = 0; a < kAxes; ++a) {
            double* displacement = work.displacement.block(b, a);
            std::fill_n(displacement, kBlockCells, 0.0);
            forEachPressureFace(cut, faces, work.potential, b, a, [&](int row, PackMask, Pack change) {
                const Pack bounded = maxPack(-largest, -maxPack(-largest, -change));
                std::memcpy(displacement + row, &bounded, sizeof bounded);
            });
        }
    });
}

}  // namespace

SolveReport correctVolume(const CutGrid& cut, const Settings& settings, double strength, const PressureSystem& system, VolumeWorkspace& work)
{
    const SolverSettings& solver = settings.solver;
    work.potential.resize(cut.grid.count());
    work.displacement.resize(cut.grid.count());
    parallelFor(cut.grid.count(), 8, [&](std::size_t b) { std::fill_n(work.potential.block(static_cast<int>(b)), kBlockCells, 0.0); });
    findSources(cut, settings.gravity, system.liquid(), strength, system.rightHandSide());
    const SolveReport report = system.solve(cut.grid, volumeTolerance(solver), solver.maxIterations, work.potential);
    displaceFaces(cut, system, work);
    return report;
}

}  // namespace sim
