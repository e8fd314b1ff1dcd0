#include "app/export/compress.h"

#include "app/export/binary.h"
#include "sim/core/parallel.h"

#include <fmt/format.h>
#include <zlib.h>

#include <cstdint>
#include <stdexcept>
#include <vector>

namespace app {

namespace {

constexpr std::size_t kBlock = std::size_t{1} << 18;

/// The fastest: numbers of a flow are nearly random below their first digits, more effort saves next to nothing.
constexpr int kLevel = 1;

std::string compressed(std::span<const std::byte> block)
{
    uLongf length = compressBound(static_cast<uLong>(block.size()));
    std::string out(length, '\0');
    const int result =
        compress2(reinterpret_cast<Bytef*>(out.data()), &length, reinterpret_cast<const Bytef*>(block.data()),
                  static_cast<uLong>(block.size()), kLevel);
    if (result != Z_OK)
        throw std::runtime_error(fmt::format("zlib cannot compress {} bytes: {}", block.size(), zError(result)));
    out.resize(length);
    return out;
}

}  // namespace

void appendCompressed(std::span<const std::byte> bytes, std::string& out)
{
    const std::size_t count = (bytes.size() + kBlock - 1) / kBlock;
    std::vector<std::string> blocks(count);
    sim::parallelFor(count, [&](std::size_t b) {
        blocks[b] = compressed(bytes.subspan(b * kBlock, std::min(kBlock, bytes.size() - b * kBlock)));
    });
    for (const std::size_t number : {count, kBlock, bytes.size() % kBlock}) appendBinary(std::uint64_t{number}, out);
    for (const std::string& block : blocks) appendBinary(std::uint64_t{block.size()}, out);
    for (const std::string& block : blocks) out += block;
}

}  // namespace app
