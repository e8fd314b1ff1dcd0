#include "sim/fabric/rods/strand_matrix.h"

#include "sim/core/parallel.h"

#include <algorithm>
#include <numeric>

namespace sim {

StrandLayout::StrandLayout(const Fabric::Strands& strands)
{
    std::vector<int> byLength(strands.count());
    std::iota(byLength.begin(), byLength.end(), 0);
    std::ranges::stable_sort(byLength, std::ranges::greater{}, [&](int s) { return strands.size(s); });
    for (std::size_t begin = 0; begin < byLength.size(); begin += kLanes) {
        Group group{strands.size(byLength[begin]), static_cast<int>(vertex.size()), static_cast<int>(edge.size()), rows};
        Lanes lanes;
        lanes.fill(-1);
        for (int l = 0; l < kLanes && begin + l < byLength.size(); ++l) lanes[l] = byLength[begin + l];
        const auto pack = [&](int count, auto&& of) {
            Lanes all;
            for (int l = 0; l < kLanes; ++l) all[l] = lanes[l] >= 0 && count < strands.size(lanes[l]) ? of(lanes[l]) : -1;
            return all;
        };
        for (int j = 0; j < group.vertices; ++j) vertex.push_back(pack(j, [&](int s) { return strands.vertex(s, j); }));
        for (int j = 0; j < group.edges(); ++j) edge.push_back(pack(j + 1, [&](int s) { return strands.edgeBegin(s) + j; }));
        groups.push_back(group);
        strand.push_back(lanes);
        rows += group.rows();
    }
}

void StrandMatrix::resize(const StrandLayout& layout)
{
    const std::size_t entries = static_cast<std::size_t>(layout.rows) * kBand * kLanes;
    band_.resize(entries);
    lower_.resize(layout.vertex.size() * kLowerPerVertex * kLanes);
    lower_.fill(0.0);  // also where the first rows have nothing before them
    inverse_.resize(static_cast<std::size_t>(layout.rows) * kLanes);
    definite_.resize(layout.groups.size());
}

bool StrandMatrix::factor(const StrandLayout& layout)
{
    parallelFor(layout.groups.size(), [&](std::size_t g) {
        const StrandLayout::Group& group = layout.groups[g];
        const Pack* band = packs(band_, group.firstRow * kBand);
        Pack* lower = packs(lower_, group.firstVertex * kLowerPerVertex);
        Pack* inverse = packs(inverse_, group.firstRow);
        Pack definite = broadcast(1.0);
        for (int r = 0; r < group.rows(); ++r) {
            const Pack* row = band + r * kBand;
            const int reach = std::min(r, kReach[r % 4]);
            Pack scaled[kBand];  // L D of this row
            Pack* own = lowerRow(lower, r);
            Pack diagonal = row[0];
            for (int k = reach; k >= 1; --k) {
                const Pack* other = lowerRow(lower, r - k);
                Pack v = row[k];
                for (int m = std::min(reach, k + kReach[(r - k) % 4]); m > k; --m) v -= scaled[m] * other[m - k - 1];
                scaled[k] = v;
            }
            for (int k = 1; k <= reach; ++k) {
                own[k - 1] = scaled[k] * inverse[r - k];
                diagonal -= own[k - 1] * scaled[k];
            }
            definite = select(diagonal > 0.0, definite, broadcast(0.0));
            inverse[r] = broadcast(1.0) / diagonal;
        }
        definite_[g] = definite;
    });
    return std::ranges::all_of(definite_, [](const Pack& lanes) { return sumLanes(lanes) == kLanes; });
}

void StrandMatrix::solve(const StrandLayout::Group& group, const Pack* b, Pack* z) const
{
    const Pack* lower = packs(lower_, group.firstVertex * kLowerPerVertex);
    const Pack* inverse = packs(inverse_, group.firstRow);
    // Vertex by vertex, with its four rows and the eight before, beyond which none has entries, in registers; the last has no angle.
    constexpr int kBefore = 8, kOwn = 4;
    Pack near[kBefore + kOwn] = {};
    const auto forward = [&](int j, auto row) __attribute__((always_inline))
    {
        const Pack* own = lowerRow(lower, kOwn * j + row);
        Pack v = b[kOwn * j + row];
        unroll<kReach[row]>([&](auto i) __attribute__((always_inline)) { v -= own[kReach[row] - 1 - i] * near[kBefore + row - kReach[row] + i]; });
        near[kBefore + row] = v;
        z[kOwn * j + row] = v * inverse[kOwn * j + row];
    };
    for (int j = 0; j < group.vertices; ++j) {
        unroll<kOwn - 1>([&](auto row) __attribute__((always_inline)) { forward(j, row); });
        if (j + 1 < group.vertices) forward(j, std::integral_constant<int, kOwn - 1>{});
        unroll<kBefore>([&](auto i) __attribute__((always_inline)) { near[i] = near[i + kOwn]; });
    }
    const auto rowAt = [&](int r) { return r >= 0 ? z[r] : Pack{}; };
    const int last = kOwn * (group.vertices - 1);
    unroll<kBefore + kOwn - 1>([&](auto i) __attribute__((always_inline)) { near[i] = rowAt(last - kBefore + i); });
    near[kBefore + kOwn - 1] = Pack{};
    for (int j = group.vertices - 1; j >= 0; --j) {
        unroll<kOwn>([&](auto i) __attribute__((always_inline)) {
            constexpr int kRow = kOwn - 1 - i;
            if (kRow == kOwn - 1 && j + 1 == group.vertices) return;
            const Pack* own = lowerRow(lower, kOwn * j + kRow);
            const Pack v = near[kBefore + kRow];
            z[kOwn * j + kRow] = v;
            unroll<kReach[kRow]>([&](auto k) __attribute__((always_inline)) { near[kBefore + kRow - 1 - k] -= own[k] * v; });
        });
        unroll<kBefore>([&](auto i) __attribute__((always_inline)) { near[kBefore + kOwn - 1 - i] = near[kBefore - 1 - i]; });
        unroll<kOwn>([&](auto i) __attribute__((always_inline)) { near[i] = rowAt(kOwn * (j - 1) - kBefore + i); });
    }
}

void StrandMatrix::multiply(const StrandLayout::Group& group, const Pack* x, Pack* y) const
{
    const Pack* band = packs(band_, group.firstRow * kBand);
    const int n = group.rows();
    constexpr int kFarthest = kBand - 1;  // column that a row has, counted from its diagonal
    // A row has its lower part itself; its upper part is in the rows that follow.
    const auto row = [&](int r, int before, int after) __attribute__((always_inline))
    {
        Pack lower = band[r * kBand] * x[r], upper{};
        for (int k = 1; k <= before; ++k) lower += band[r * kBand + k] * x[r - k];
        for (int k = 1; k <= after; ++k) upper += band[(r + k) * kBand + k] * x[r + k];
        y[r] = lower + upper;
    };
    const int middleEnd = std::max(kFarthest, n - kFarthest);
    for (int r = 0; r < std::min(n, kFarthest); ++r) row(r, r, std::min(n - 1 - r, kFarthest));
    for (int r = kFarthest; r < middleEnd; ++r) row(r, kFarthest, kFarthest);
    for (int r = middleEnd; r < n; ++r) row(r, kFarthest, n - 1 - r);
}

}  // namespace sim
