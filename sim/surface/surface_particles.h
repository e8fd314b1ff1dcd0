#pragma once

#include "sim/core/aligned_array.h"
#include "sim/core/simd.h"
#include "sim/grid/block_grid.h"
#include "sim/particles/liquid_particles.h"

#include <array>
#include <cstdint>
#include <vector>

namespace sim {

/// Liquid particles as their surface needs them: sorted by the blocks of its own grid and, in each, by 2³ bins. Lengths
/// are in cells of that grid and relative to the lower corner of the particle's block, where floats are exact enough.
struct SurfaceParticles {
    static constexpr int kBinEdge = 4, kBins = 8;  ///< cells along the edge of a bin; bins per block, x fastest

    std::array<AlignedArray<float>, kAxes> x;         ///< [cells]
    std::array<AlignedArray<float>, kAxes> velocity;  ///< [cm/s]
    AlignedArray<float> radius;                       ///< radius of a ball of the particle's volume [cells]
    std::vector<int> binStart;                        ///< first particle of bin i of block b at kBins b + i, and the end of all
    double volume = 0.0;                              ///< volume of all particles [cm^3]

    int begin(int block) const { return binStart[kBins * block]; }
    int end(int block) const { return binStart[kBins * (block + 1)]; }
    Eigen::Vector3f place(int s) const { return {x[0][s], x[1][s], x[2][s]}; }

    // Scratch of the sort, per particle of the liquid.
    std::vector<Vec3i> blockOf;
    std::vector<Eigen::Vector3f> inside;  ///< place in the block [cells]
    std::vector<int> binOf, slot;
    std::vector<Vec3i> coords, missing;
    std::vector<std::uint32_t> reached;
    std::vector<int> next;
};

/// Pitch of a lattice of the particles in which an average piece of the liquid is: cube root of the mean of particle
/// volumes weighted by volume, which many small drops do not change [cm]. 0 without liquid.
double surfaceSpacing(const LiquidParticles& liquid, double density);

/// Sort the particles that have mass, and make the blocks of `grid` - whose dx and origin are given - those that lie
/// within `reach` cells of one, measured along each axis; reach ≤ 8. The same bits for any number of threads.
/// Throws RunError if a particle is out of the range of block numbers.
void sortForSurface(const LiquidParticles& liquid, double density, double reach, BlockGrid& grid, SurfaceParticles& particles);

}  // namespace sim
