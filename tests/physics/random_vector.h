#pragma once

#include "sim/core/types.h"

#include <random>

namespace sim::test {

using Random = std::mt19937;

inline double between(double low, double high, Random& random) { return std::uniform_real_distribution(low, high)(random); }

/// Each component between −size and size.
inline Vec3 anywhere(double size, Random& random)
{
    const double x = between(-size, size, random), y = between(-size, size, random), z = between(-size, size, random);
    return {x, y, z};
}

}  // namespace sim::test
