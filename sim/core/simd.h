#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <utility>

#ifdef __AVX512F__
#include <immintrin.h>
#endif

// The only door to SIMD: packs of 8 doubles or 16 floats. Arithmetic and comparisons are the compiler's own vector operators; what has
// none (masked access, rounding) is here, once for AVX-512 and once in plain C++.

namespace sim {

inline constexpr int kLanes = 8;

using Pack = double __attribute__((vector_size(64)));
using PackMask = long long __attribute__((vector_size(64)));                      ///< all bits of a lane set, or none
using HalfPack = double __attribute__((vector_size(32), aligned(8), may_alias));  ///< 4 doubles anywhere in memory

inline constexpr int kFloatLanes = 16;
using FloatPack = float __attribute__((vector_size(64)));
using FloatMask = int __attribute__((vector_size(64)));

/// f(integral_constant<int, 0>) … f(integral_constant<int, N − 1>): a loop that leaves no loop behind, so that arrays indexed in it
/// live in registers.
template <int N, class F>
[[gnu::always_inline]] inline void unroll(F&& f)
{
    // clang-format off
    [&]<int... I>(std::integer_sequence<int, I...>) __attribute__((always_inline)) {
        (f(std::integral_constant<int, I>{}), ...);
    }(std::make_integer_sequence<int, N>{});
    // clang-format on
}

[[gnu::always_inline]] inline Pack broadcast(double v) { return Pack{v, v, v, v, v, v, v, v}; }

/// Aligned numbers, a multiple of kLanes, as packs.
inline std::span<Pack> packsOf(std::span<double> v) { return {reinterpret_cast<Pack*>(v.data()), v.size() / kLanes}; }

[[gnu::always_inline]] inline Pack loadPack(const double* p)
{
    Pack v;
    std::memcpy(&v, p, sizeof v);
    return v;
}

[[gnu::always_inline]] inline FloatPack loadFloats(const float* p)
{
    FloatPack v;
    std::memcpy(&v, p, sizeof v);
    return v;
}

/// The lanes 0 … n − 1.
[[gnu::always_inline]] inline FloatMask firstFloatLanes(int n)
{
    const FloatMask lane = {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15};
    return lane < n;
}

/// 1/√v to a relative 1e-4; something finite or infinite where v is 0.
[[gnu::always_inline]] inline FloatPack roughInverseSqrt(FloatPack v)
{
#ifdef __AVX512F__
    return (FloatPack)_mm512_maskz_rsqrt14_ps(0xffff, (__m512)v);
#else
    const FloatMask guess = 0x5f375a86 - ((FloatMask)v >> 1);  // an integer guess and two Newton steps
    FloatPack y = (FloatPack)guess;
    y = y * (1.5f - (0.5f * v) * y * y);
    return y * (1.5f - (0.5f * v) * y * y);
#endif
}

/// Lane i is lane from[i] of v; the mask is a constant.
template <class V, class Mask>
[[gnu::always_inline]] inline V permuteLanes(V v, Mask from)
{
#ifdef __clang__  // has no such function for masks of variables
    V permuted = v;
    for (std::size_t i = 0; i < sizeof(V) / sizeof(v[0]); ++i) permuted[i] = v[from[i]];
    return permuted;
#else
    return __builtin_shuffle(v, from);
#endif
}

/// Lanes added in a fixed order, halves first. V is FloatPack or FloatMask.
template <class V>
[[gnu::always_inline]] inline auto sumFloatLanes(V v)
{
    v += permuteLanes(v, FloatMask{8, 9, 10, 11, 12, 13, 14, 15, 0, 1, 2, 3, 4, 5, 6, 7});
    v += permuteLanes(v, FloatMask{4, 5, 6, 7, 0, 1, 2, 3, 12, 13, 14, 15, 8, 9, 10, 11});
    v += permuteLanes(v, FloatMask{2, 3, 0, 1, 6, 7, 4, 5, 10, 11, 8, 9, 14, 15, 12, 13});
    return v[0] + v[1];
}

/// a where the mask is set, else b.
[[gnu::always_inline]] inline Pack select(PackMask mask, Pack a, Pack b) { return mask ? a : b; }

/// The lanes 0 … n − 1.
[[gnu::always_inline]] inline PackMask firstLanes(int n)
{
    const PackMask lane = {0, 1, 2, 3, 4, 5, 6, 7};
    return lane < static_cast<long long>(n);
}

[[gnu::always_inline]] inline Pack floorPack(Pack v)
{
#ifdef __AVX512F__
    return (Pack)_mm512_maskz_roundscale_pd(0xff, (__m512d)v, _MM_FROUND_TO_NEG_INF | _MM_FROUND_NO_EXC);
#else
    for (int l = 0; l < kLanes; ++l) v[l] = std::floor(v[l]);
    return v;
#endif
}

[[gnu::always_inline]] inline Pack sqrtPack(Pack v)
{
#ifdef __AVX512F__
    return (Pack)_mm512_maskz_sqrt_pd(0xff, (__m512d)v);
#else
    for (int l = 0; l < kLanes; ++l) v[l] = std::sqrt(v[l]);
    return v;
#endif
}

[[gnu::always_inline]] inline FloatPack sqrtFloats(FloatPack v)
{
#ifdef __AVX512F__
    return (FloatPack)_mm512_maskz_sqrt_ps(0xffff, (__m512)v);
#else
    for (int l = 0; l < kFloatLanes; ++l) v[l] = std::sqrt(v[l]);
    return v;
#endif
}

[[gnu::always_inline]] inline Pack absPack(Pack v) { return v < 0.0 ? -v : v; }
[[gnu::always_inline]] inline Pack maxPack(Pack a, Pack b) { return b > a ? b : a; }

[[gnu::always_inline]] inline void storePack(double* p, Pack v) { std::memcpy(p, &v, sizeof v); }

/// Store past the caches, to an address that is a multiple of 64 bytes. Other threads see it after streamFence().
[[gnu::always_inline]] inline void streamPack(double* p, Pack v)
{
#ifdef __AVX512F__
    _mm512_stream_pd(p, (__m512d)v);
#else
    storePack(p, v);
#endif
}
inline void streamFence()
{
#ifdef __AVX512F__
    _mm_sfence();
#endif
}

/// Store the first n lanes.
[[gnu::always_inline]] inline void storeFirst(double* p, Pack v, int n)
{
#ifdef __AVX512F__
    _mm512_mask_storeu_pd(p, static_cast<__mmask8>((1u << n) - 1), (__m512d)v);
#else
    for (int l = 0; l < n; ++l) p[l] = v[l];
#endif
}

/// Bit l of the result: is lane l set?
[[gnu::always_inline]] inline unsigned maskBits(PackMask mask)
{
#ifdef __AVX512DQ__
    return _mm512_movepi64_mask((__m512i)mask);
#else
    unsigned bits = 0;
    for (int l = 0; l < kLanes; ++l) bits |= (mask[l] != 0 ? 1u : 0u) << l;
    return bits;
#endif
}

[[gnu::always_inline]] inline unsigned floatMaskBits(FloatMask mask)
{
#ifdef __AVX512DQ__
    return _mm512_movepi32_mask((__m512i)mask);
#else
    unsigned bits = 0;
    for (int l = 0; l < kFloatLanes; ++l) bits |= (mask[l] != 0 ? 1u : 0u) << l;
    return bits;
#endif
}

/// The inverse: lane l is set where bit l of the low 8 is.
[[gnu::always_inline]] inline PackMask maskOfBits(std::uint64_t bits)
{
    const PackMask lane = {1, 2, 4, 8, 16, 32, 64, 128};
    return (lane & static_cast<long long>(bits)) != 0;
}

/// Lane i is lane from[i] of the 16 lanes of a and b.
[[gnu::always_inline]] inline Pack pickLanes(Pack a, Pack b, PackMask from)
{
#ifdef __clang__  // knows g++'s function for constants only
    Pack picked = a;
    for (int i = 0; i < kLanes; ++i) picked[i] = from[i] < kLanes ? a[from[i]] : b[from[i] - kLanes];
    return picked;
#else
    return __builtin_shuffle(a, b, from);
#endif
}

/// The lanes of a, then those of b; and the two from both again.
[[gnu::always_inline]] inline Pack joinHalves(HalfPack a, HalfPack b) { return __builtin_shufflevector(a, b, 0, 1, 2, 3, 4, 5, 6, 7); }
[[gnu::always_inline]] inline HalfPack lowerHalf(Pack v) { return __builtin_shufflevector(v, v, 0, 1, 2, 3); }
[[gnu::always_inline]] inline HalfPack upperHalf(Pack v) { return __builtin_shufflevector(v, v, 4, 5, 6, 7); }

/// v[i][j] becomes v[j][i].
[[gnu::always_inline]] inline void transposeLanes(Pack (&v)[kLanes])
{
    // clang-format off
    const auto exchange = [](Pack& a, Pack& b, PackMask first, PackMask second) __attribute__((always_inline)) {
        const Pack left = pickLanes(a, b, first);
        b = pickLanes(a, b, second);
        a = left;
    };
    // clang-format on
    for (int i = 0; i < kLanes; i += 2) exchange(v[i], v[i + 1], PackMask{0, 8, 2, 10, 4, 12, 6, 14}, PackMask{1, 9, 3, 11, 5, 13, 7, 15});
    for (int i : {0, 1, 4, 5}) exchange(v[i], v[i + 2], PackMask{0, 1, 8, 9, 4, 5, 12, 13}, PackMask{2, 3, 10, 11, 6, 7, 14, 15});
    for (int i = 0; i < 4; ++i) exchange(v[i], v[i + 4], PackMask{0, 1, 2, 3, 8, 9, 10, 11}, PackMask{4, 5, 6, 7, 12, 13, 14, 15});
}

/// {before[7], row[0] … row[6]}: a row of cells seen from one cell further right, before being the row to its left.
[[gnu::always_inline]] inline Pack shiftRight(Pack before, Pack row) { return pickLanes(before, row, PackMask{7, 8, 9, 10, 11, 12, 13, 14}); }

/// {row[1] … row[7], after[0]}.
[[gnu::always_inline]] inline Pack shiftLeft(Pack row, Pack after) { return pickLanes(row, after, PackMask{1, 2, 3, 4, 5, 6, 7, 8}); }

/// Lanes added in a fixed order.
[[gnu::always_inline]] inline double sumLanes(Pack v) { return ((v[0] + v[1]) + (v[2] + v[3])) + ((v[4] + v[5]) + (v[6] + v[7])); }

}  // namespace sim
