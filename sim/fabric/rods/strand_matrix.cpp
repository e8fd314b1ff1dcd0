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
    const int n = group.rows();
    for (int r = 0; r < n; ++r) {
        const Pack* own = lowerRow(lower, r);
        Pack v = b[r];
        for (int k = std::min(r, kReach[r % 4]); k >= 1; --k) v -= own[k - 1] * z[r - k];
        z[r] = v;
    }
    for (int r = 0; r < n; ++r) z[r] *= inverse[r];
    for (int r = n - 1; r >= 0; --r) {
        const Pack* own = lowerRow(lower, r);
        const Pack v = z[r];
        for (int k = 1; k <= std::min(r, kReach[r % 4]); ++k) z[r - k] -= own[k - 1] * v;
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
