#pragma once

#include "sim/particles/velocity_modes.h"

namespace sim {

/// A prefix of the canonical modes, at compile time: the kernels are instantiated for 1, 4, 8, 11 and 27.
template <int kModes>
struct ModeSet {
    static constexpr int kDegree = highestDegree(kModes);
    static constexpr int kFactors = kDegree + 1;  ///< 1-D factors per axis: 1, z, z²

    /// The mode of degrees (a, b, c), or −1 if the set does not hold it.
    template <int a, int b, int c>
    static constexpr int kMode = modeOfDegrees(a, b, c) < kModes ? modeOfDegrees(a, b, c) : -1;

    static constexpr bool has(int a, int b, int c)
    {
        const int r = modeOfDegrees(a, b, c);
        return r >= 0 && r < kModes;
    }
    // Degrees are present from 0 upwards without gaps in each of these sets.
    static constexpr int countX(int b, int c) { return has(2, b, c) ? 3 : has(1, b, c) ? 2 : has(0, b, c) ? 1 : 0; }
    static constexpr int countY(int c) { return has(0, 2, c) ? 3 : has(0, 1, c) ? 2 : has(0, 0, c) ? 1 : 0; }
};

/// Call f(ModeSet<n>) for the set that holds `storedModes` rows.
template <class F>
void withModeSet(int storedModes, F&& f)
{
    switch (storedModes) {
        case 1: return f(ModeSet<1>{});
        case 4: return f(ModeSet<4>{});
        case 8: return f(ModeSet<8>{});
        case 11: return f(ModeSet<11>{});
        default: return f(ModeSet<27>{});
    }
}

}  // namespace sim
