#pragma once

#include "sim/core/aligned_array.h"
#include "sim/grid/block_grid.h"
#include "sim/particles/ledger.h"
#include "sim/particles/liquid_particles.h"
#include "sim/shapes/shape.h"

#include <array>
#include <vector>

namespace sim {

/// Rank of cell (i, j, k) of a block among its particles: z fastest, so that a column of 8 cells is one run.
constexpr int cellRank(int i, int j, int k) { return (i * kBlockEdge + j) * kBlockEdge + k; }

/// The particles of each cell of each block, after sortParticles.
struct ParticleOrder {
    static constexpr int kColors = 8;

    /// Particles of cell (i, j, k) of block b: [start, next start) at index b * 512 + cellRank(i, j, k).
    AlignedArray<int> cellStart;

    /// Row that holds the modes of particle s until the next G2P rewrites row s. Moving x and mass alone is a third of the work
    /// of moving everything (sim/README.md, Memory).
    AlignedArray<int> source;

    std::vector<int> occupied;                      ///< blocks with particles, ascending
    std::array<std::vector<int>, kColors> byColor;  ///< blocks with particles by parity of their coordinates, fullest first
    std::vector<int> previous;                      ///< number a block had before this sort, or BlockGrid::kNone
    bool blocksChanged = true;                      ///< previous is not simply 0, 1, 2 …
    std::size_t maxParticlesPerBlock = 0;

    int begin(int block) const { return cellStart[static_cast<std::size_t>(block) * kBlockCells]; }
    int end(int block) const { return cellStart[static_cast<std::size_t>(block + 1) * kBlockCells]; }
    int size(int block) const { return end(block) - begin(block); }
    const int* cells(int block) const { return cellStart.data() + static_cast<std::size_t>(block) * kBlockCells; }

    // Scratch of the sort.
    AlignedArray<std::uint32_t> key;
    AlignedArray<int> binned, histogram;
    AlignedArray<std::uint16_t> binnedCell;
    std::array<AlignedArray<double>, kAxes> x;
    AlignedArray<double> mass;
    AlignedArray<std::uint32_t> id;
    AlignedArray<std::uint32_t> touched;     ///< per block: planes of cells with particles, 8 bits per axis
    std::vector<std::vector<Vec3i>> strays;  ///< per chunk: blocks that do not exist yet
    std::vector<std::vector<int>> dead;      ///< per chunk: particles outside the domain
    std::vector<std::uint8_t> needed;        ///< per block: must it exist?
    std::vector<Vec3i> before, missing;      ///< blocks before the sort; blocks to be added
    std::vector<int> renumbered;             ///< per block before fitBlocks: its number now; empty if unchanged
};

/// Particles in the order of the last sort, with the grid whose blocks it goes by.
struct SortedParticles {
    const Particles& particles;
    const ParticleOrder& order;
    const BlockGrid& grid;
};

/// Half sizes of the neighbourhood of a particle's cell in which blocks must exist [cells]: what its stencils, the cells that can be
/// liquid because of it (its own and those around) and their faces reach.
inline constexpr int kReachBelow = 1, kReachAbove = 2;

/// Sort the particles by cell, drop those outside the domain, and make the grid's blocks those that the particles need.
/// x, mass and id are moved; the modes stay where they are (see source).
/// Throws RunError if a position is not finite or out of the range of block numbers.
/// @param domain  null: all of space
/// @param ledger  books mass and momentum of the particles that were dropped; null only without a domain
void sortParticles(Particles& particles, BlockGrid& grid, const Shape* domain, ParticleOrder& order, Ledger* ledger);

}  // namespace sim
