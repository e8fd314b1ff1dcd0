#pragma once

#include <bit>
#include <span>
#include <string>

namespace app {

static_assert(std::endian::native == std::endian::little, "binary files are written as memory has them: low byte first");

/// Append numbers as they are in memory.
template <class T>
void appendBinary(std::span<const T> values, std::string& out)
{
    out.append(reinterpret_cast<const char*>(values.data()), values.size_bytes());
}

template <class T>
void appendBinary(const T& value, std::string& out)
{
    appendBinary(std::span<const T>(&value, 1), out);
}

}  // namespace app
