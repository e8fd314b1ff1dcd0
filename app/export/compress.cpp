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

constexpr std::size_t kBlock = std::size_t{1} << 16;

std::string compressed(std::span<const std::byte> block, int strategy)
{
    constexpr int kFastest = 1, kWindowBits = 15, kMemory = 8;  // the last two as zlib has them by default
    z_stream stream{};
    int result = deflateInit2(&stream, kFastest, Z_DEFLATED, kWindowBits, kMemory, strategy);
    std::string out;
    if (result == Z_OK) {
        out.resize(deflateBound(&stream, static_cast<uLong>(block.size())));
        stream.next_in = reinterpret_cast<Bytef*>(const_cast<std::byte*>(block.data()));  // which zlib only reads
        stream.avail_in = static_cast<uInt>(block.size());
        stream.next_out = reinterpret_cast<Bytef*>(out.data());
        stream.avail_out = static_cast<uInt>(out.size());
        result = deflate(&stream, Z_FINISH);
        out.resize(stream.total_out);
        deflateEnd(&stream);
    }
    if (result != Z_STREAM_END) throw std::runtime_error(fmt::format("zlib cannot compress: {}", zError(result)));
    return out;
}

}  // namespace

void appendCompressed(std::span<const std::byte> bytes, bool repeats, std::string& out)
{
    const std::size_t count = (bytes.size() + kBlock - 1) / kBlock;
    std::vector<std::string> blocks(count);
    sim::parallelFor(count, [&](std::size_t b) {
        blocks[b] = compressed(bytes.subspan(b * kBlock, std::min(kBlock, bytes.size() - b * kBlock)), repeats ? Z_DEFAULT_STRATEGY : Z_HUFFMAN_ONLY);
    });
    for (const std::size_t number : {count, kBlock, bytes.size() % kBlock}) appendBinary(std::uint64_t{number}, out);
    for (const std::string& block : blocks) appendBinary(std::uint64_t{block.size()}, out);
    for (const std::string& block : blocks) out += block;
}

}  // namespace app
