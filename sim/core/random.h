#pragma once

#include <cstdint>

namespace sim {

/// Random numbers without a state: each is a function of (seed, stream, step, index, draw) alone, so that it does not
/// matter which thread asks, or when. Bits are mixed by the finaliser of splitmix64 (Steele et al. 2014), once per part
/// of the key.
class CounterRandom {
 public:
    CounterRandom(std::uint64_t seed, std::uint64_t stream, std::uint64_t step = 0) : key_(mix(mix(mix(seed) ^ stream) ^ step)) {}

    std::uint64_t bits(std::uint64_t index, std::uint64_t draw = 0) const { return mix(mix(key_ ^ index) ^ draw); }

    /// Uniform in [0, 1).
    double uniform(std::uint64_t index, std::uint64_t draw = 0) const
    {
        constexpr double kUnit = 1.0 / 9007199254740992.0;  // 2^-53
        return static_cast<double>(bits(index, draw) >> 11) * kUnit;
    }

    /// One number for a place on a lattice, each coordinate in [−2^20, 2^20): an index for the functions above.
    static constexpr std::uint64_t placeIndex(int i, int j, int k)
    {
        constexpr std::uint64_t kMask = (std::uint64_t{1} << 21) - 1;
        return ((static_cast<std::uint64_t>(i) & kMask) << 42) | ((static_cast<std::uint64_t>(j) & kMask) << 21) |
               (static_cast<std::uint64_t>(k) & kMask);
    }

 private:
    static constexpr std::uint64_t mix(std::uint64_t x)
    {
        x += 0x9e3779b97f4a7c15u;
        x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9u;
        x = (x ^ (x >> 27)) * 0x94d049bb133111ebu;
        return x ^ (x >> 31);
    }
    std::uint64_t key_;
};

}  // namespace sim
