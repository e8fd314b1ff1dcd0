#pragma once

#include "sim/core/random.h"
#include "sim/core/types.h"

#include <cmath>
#include <cstdint>
#include <initializer_list>
#include <string_view>

namespace app {

/// Random numbers, one after the other: the same for the same seed and row, on any machine. Of a call's arguments only
/// one may throw, since compilers choose their order; lists in braces go from left to right.
class RandomSource {
 public:
    RandomSource(std::uint64_t seed, std::uint64_t row) : random_(seed, row) {}

    double between(double low, double high) { return low + (high - low) * random_.uniform(thrown_++); }
    /// Even over the orders of magnitude between two numbers above 0.
    double acrossScales(double low, double high) { return low * std::pow(high / low, between(0.0, 1.0)); }
    int whole(int low, int high) { return low + static_cast<int>(between(0.0, 1.0) * (high - low + 1)); }
    bool chance(double share) { return between(0.0, 1.0) < share; }
    std::string_view oneOf(std::initializer_list<std::string_view> words) { return words.begin()[whole(0, static_cast<int>(words.size()) - 1)]; }
    /// A place in a cube around the origin.
    sim::Vec3 vector(double half) { return sim::Vec3{between(-half, half), between(-half, half), between(-half, half)}; }
    sim::Vec3 direction()
    {
        constexpr double kShortest = 0.1;
        for (;;)
            if (const sim::Vec3 v = vector(1.0); v.norm() > kShortest && v.norm() < 1.0) return v.normalized();
    }

 private:
    sim::CounterRandom random_;
    std::uint64_t thrown_ = 0;
};

}  // namespace app
