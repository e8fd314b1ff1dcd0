#pragma once

#include "sim/core/aligned_array.h"
#include "sim/core/simd.h"
#include "sim/grid/block_grid.h"
#include "sim/particles/liquid_particles.h"

#include <array>
#include <cstdint>
#include <vector>

namespace sim {

/// Liquid particles as their surface needs them: sorted by the blocks of its own grid and, in each, by 2³ bins of 4³
/// cells. Lengths are in cells of that grid and relative to the lower corner of the particle's block, where floats are
/// exact enough.
struct SurfaceParticles {
    static constexpr int kBinEdge = 4, kBins = 8;  ///< cells per edge of a bin; bins per block

    std::array<AlignedArray<float>, kAxes> x;         ///< [cells]
    std::array<AlignedArray<float>, kAxes> velocity;  ///< [cm/s]
    AlignedArray<float> radius;                       ///< of a ball of the particle's volume [cells]
    std::vector<int> binStart;  ///< first particle of bin i of block b at 8 b + i; and the end of all
    double volume = 0.0;        ///< of all of them [cm^3]

    int begin(int block) const { return binStart[kBins * block]; }
    int end(int block) const { return binStart[kBins * (block + 1)]; }

    // Scratch of the sort.
    std::vector<std::array<int, kAxes>> blockOf;
    std::vector<int> binOf;
    std::vector<Vec3i> coords, missing;
    std::vector<std::uint32_t> touched;
};

/// Lattice spacing of the particle in which an average piece of the liquid is: cube root of the mean of particle
/// volumes weighted by volume, which many small drops do not change [cm]. 0 without liquid.
double surfaceSpacing(const LiquidParticles& liquid, double density);

/// Sort the particles that have mass and make the blocks of `grid` - whose dx and origin are given - those that lie
/// within `reach` cells of one, measured along each axis; reach ≤ 8. Serial but for copying; the same for any number of
/// threads. Throws RunError if a particle is out of the range of block numbers.
void sortForSurface(const LiquidParticles& liquid, double density, double reach, BlockGrid& grid,
                    SurfaceParticles& out);

}  // namespace sim
