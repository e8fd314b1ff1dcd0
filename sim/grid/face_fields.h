#pragma once

#include "sim/grid/block_grid.h"

#include <cstdint>

namespace sim {

/// One bit per cell (or lower face) of each block, per kind: 8 words of 64, word k is plane k, bit 8 j + i.
/// Like BlockArray there is an empty block at the end.
template <int kKinds = 1>
class BlockBits {
 public:
    static constexpr int kWords = kBlockEdge;

    void resize(int blocks)
    {
        words_.resize((static_cast<std::size_t>(blocks) + 1) * kKinds * kWords);
        std::fill_n(block(blocks), kKinds * kWords, 0);
    }
    std::uint64_t* block(int b, int kind = 0) { return words_.data() + (static_cast<std::size_t>(b) * kKinds + kind) * kWords; }
    const std::uint64_t* block(int b, int kind = 0) const { return words_.data() + (static_cast<std::size_t>(b) * kKinds + kind) * kWords; }
    bool test(int b, int cell, int kind = 0) const { return (block(b, kind)[cell >> 6] >> (cell & 63) & 1) != 0; }
    void set(int b, int cell, int kind = 0) { block(b, kind)[cell >> 6] |= std::uint64_t{1} << (cell & 63); }

 private:
    AlignedArray<std::uint64_t> words_;
};

/// The liquid on the MAC grid. Kind a of a face quantity is the face normal to axis a at the lower side of the cell.
struct FaceFields {
    static constexpr int kMass = 0, kMomentum = 3;  ///< kinds of `sums`

    BlockArray<double, 6> sums;      ///< mass [g] and momentum [g cm/s] of each face
    BlockArray<double, 3> velocity;  ///< [cm/s]
    BlockBits<3> valid;              ///< faces whose velocity means something
};

}  // namespace sim
