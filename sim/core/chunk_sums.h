#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace sim {

/// Sums over a parallel loop for each of several things: each chunk of the loop (Chunks) adds to numbers of its own, which are then added up in the
/// order of the chunks, the same bits for any number of threads. Keeps its memory.
template <class T>
class ChunkSums {
 public:
    void begin(std::size_t chunks, std::size_t things)
    {
        chunks_ = chunks;
        things_ = things;
        sums_.assign(chunks * things, T{});
    }
    /// The sums that a chunk adds to.
    std::span<T> of(std::size_t chunk) { return {sums_.data() + chunk * things_, things_}; }
    T sum(std::size_t thing) const
    {
        T sum{};
        for (std::size_t c = 0; c < chunks_; ++c) sum += sums_[c * things_ + thing];
        return sum;
    }

 private:
    std::size_t chunks_ = 0, things_ = 0;
    std::vector<T> sums_;
};

}  // namespace sim
