#pragma once

#include "sim/core/simd.h"

#include <numbers>

// Angles and their sines and cosines for a whole pack, where the library's functions take one number after the other. Polynomials through
// Chebyshev points; errors are those of the last rounding or two.

namespace sim {

namespace pack_math {

/// Σ cₙ zⁿ, by Horner's rule.
template <int N>
[[gnu::always_inline]] inline Pack polynomial(const double (&c)[N], Pack z)
{
    Pack sum = broadcast(c[N - 1]);
    for (int n = N - 2; n >= 0; --n) sum = sum * z + c[n];
    return sum;
}

/// (arctan x / x − 1) / x² by x², for |x| ≤ tan(π/8); error 5e-18.
inline constexpr double kArctan[] = {-0.33333333333333326,  0.19999999999994239,  -0.14285714284548473,  0.11111111009767771,
                                     -0.090909044298333325, 0.076921806928619316, -0.066644843855851982, 0.05857960242448465,
                                     -0.050846315279362307, 0.039211574671738088, -0.019155571078037174};
/// (sin x / x − 1) / x² and (cos x − 1 + x²/2) / x⁴ by x², for |x| ≤ π/4; errors 1.3e-17 and 5e-19.
inline constexpr double kSine[] = {-0.16666666666666666,   0.0083333333333309462,   -0.00019841269836756015,
                                   2.7557316101335308e-06, -2.5051131607790919e-08, 1.591811303660623e-10};
inline constexpr double kCosine[] = {0.041666666666666664,    -0.0013888888888887395, 2.480158729876247e-05,
                                     -2.7557317270134221e-07, 2.0876145961004065e-09, -1.1382612062696419e-11};

}  // namespace pack_math

/// Angle of (cosine, sine) from the first axis, of any length, in (−π, π]; 0 for (0, 0) [rad].
inline Pack angleOf(Pack sine, Pack cosine)
{
    constexpr double kTanEighth = std::numbers::sqrt2 - 1.0, kSmallest = 1.0e-300;
    const Pack height = absPack(sine), width = absPack(cosine);
    const PackMask isSteep = height > width;
    const Pack low = select(isSteep, width, height), high = maxPack(select(isSteep, height, width), broadcast(kSmallest));
    const PackMask isWide = low > kTanEighth * high;  // beyond π/8: what is left of π/4
    const Pack x = select(isWide, low - high, low) / select(isWide, low + high, high), z = x * x;
    const Pack rest = x + x * z * pack_math::polynomial(pack_math::kArctan, z);
    Pack angle = select(isWide, 0.25 * std::numbers::pi + rest, rest);
    angle = select(isSteep, 0.5 * std::numbers::pi - angle, angle);
    angle = select(cosine < 0.0, std::numbers::pi - angle, angle);
    return select(sine < 0.0, -angle, angle);
}

/// Cosine and sine of an angle [rad].
struct PackDirection {
    Pack cosine, sine;
};

inline PackDirection directionOf(Pack angle)
{
    // π/2 in two parts, of which the first has 33 bits: turns up to 2^20 are taken off exactly.
    constexpr double kQuarterHigh = 1.5707963267341256, kQuarterLow = 6.0771005065061922e-11, kMostTurns = 1.0e6;
    const Pack turns = floorPack(angle * (2.0 / std::numbers::pi) + 0.5);
    if (maskBits(absPack(turns) > kMostTurns) != 0) {  // or not finite
        PackDirection d;
        for (int l = 0; l < kLanes; ++l) d.cosine[l] = std::cos(angle[l]), d.sine[l] = std::sin(angle[l]);
        return d;
    }
    const Pack x = (angle - turns * kQuarterHigh) - turns * kQuarterLow, z = x * x;
    const Pack s = x + x * z * pack_math::polynomial(pack_math::kSine, z);
    const Pack c = 1.0 - 0.5 * z + z * z * pack_math::polynomial(pack_math::kCosine, z);
    const Pack quarter = turns - 4.0 * floorPack(0.25 * turns);  // 0, 1, 2 or 3
    const PackMask isOdd = (quarter == 1.0) | (quarter == 3.0);
    const Pack cosine = select(isOdd, s, c), sine = select(isOdd, c, s);
    return {select((quarter == 1.0) | (quarter == 2.0), -cosine, cosine), select(quarter >= 2.0, -sine, sine)};
}

}  // namespace sim
