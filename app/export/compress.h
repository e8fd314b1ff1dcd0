#pragma once

#include <cstddef>
#include <span>
#include <string>

namespace app {

/// Append bytes compressed by zlib as VTK's XML files have them: number of blocks, their length, length of the last
/// where it is shorter, else 0, the compressed length of each (all as 64 bits), and the blocks. The same bytes for any
/// number of threads.
/// @param repeats  look for what has been there before, as in whole numbers that count up. Numbers of a flow have
/// nothing
///                 of that: without, they become as short in a third of the time.
void appendCompressed(std::span<const std::byte> bytes, bool repeats, std::string& out);

}  // namespace app
