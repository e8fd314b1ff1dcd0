#pragma once

namespace sim {

/// Width of the vector instructions that this program was compiled for [bits]. Packs have 512 bits whatever it is.
#if defined(__AVX512F__)
inline constexpr int kVectorBits = 512;
#elif defined(__AVX__)
inline constexpr int kVectorBits = 256;
#else
inline constexpr int kVectorBits = 128;
#endif

}  // namespace sim
