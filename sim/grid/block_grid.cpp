#include "sim/grid/block_grid.h"

#include "sim/core/check.h"
#include "sim/core/parallel.h"

#include <bit>

namespace sim {

namespace {

constexpr std::uint64_t kEmptyKey = ~std::uint64_t{0};

std::uint64_t keyOf(const Vec3i& c)
{
    const auto bits = [](int v) { return static_cast<std::uint64_t>(v + BlockGrid::kMaxCoordinate) & 0x1fffff; };
    return bits(c.z()) << 42 | bits(c.y()) << 21 | bits(c.x());
}

std::size_t slotOf(std::uint64_t key, std::size_t tableSize)
{
    key = (key ^ (key >> 31)) * 0x9e3779b97f4a7c15u;  // multiplicative hashing by the golden ratio
    return (key >> 20) & (tableSize - 1);
}

}  // namespace

int BlockGrid::find(const Vec3i& coords) const
{
    if (keys_.empty()) return kNone;
    const std::uint64_t key = keyOf(coords);
    for (std::size_t s = slotOf(key, keys_.size());; s = (s + 1) & (keys_.size() - 1)) {
        if (keys_[s] == key) return values_[s];
        if (keys_[s] == kEmptyKey) return kNone;
    }
}

void BlockGrid::setBlocks(std::span<const Vec3i> coords)
{
    coords_.assign(coords.begin(), coords.end());
    std::sort(coords_.begin(), coords_.end(), [](const Vec3i& a, const Vec3i& b) { return keyOf(a) < keyOf(b); });

    const std::size_t tableSize = std::bit_ceil(2 * coords_.size() + 2);
    keys_.assign(tableSize, kEmptyKey);
    values_.resize(tableSize);
    for (int b = 0; b < count(); ++b) {
        const std::uint64_t key = keyOf(coords_[b]);
        std::size_t s = slotOf(key, tableSize);
        while (keys_[s] != kEmptyKey) {
            SIM_CHECK(keys_[s] != key);
            s = (s + 1) & (tableSize - 1);
        }
        keys_[s] = key;
        values_[s] = b;
    }

    neighbours_.resize(coords_.size());
    parallelFor(coords_.size(), 16, [&](std::size_t b) {
        for (int n = 0; n < 27; ++n) {
            const int found = find(coords_[b] + Vec3i(n % 3 - 1, n / 3 % 3 - 1, n / 9 - 1));
            neighbours_[b][n] = found == kNone ? count() : found;
        }
    });
}

}  // namespace sim
