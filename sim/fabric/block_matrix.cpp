#include "sim/fabric/block_matrix.h"

#include "sim/core/check.h"

#include <algorithm>

namespace sim {

BlockMatrix::BlockMatrix(const std::vector<std::vector<int>>& columns)
{
    for (std::size_t row = 0; row < columns.size(); ++row) {
        const auto own = std::ranges::lower_bound(columns[row], static_cast<int>(row));
        SIM_CHECK(own != columns[row].end() && *own == static_cast<int>(row));
        column_.insert(column_.end(), own, columns[row].end());
        begin_.push_back(static_cast<int>(column_.size()));
        for (auto column = columns[row].begin(); column != own; ++column) mirrors_.push_back({*column, find(*column, static_cast<int>(row))});
        mirrorBegin_.push_back(static_cast<int>(mirrors_.size()));
    }
    values_.resize(9 * column_.size() + 1);
}

int BlockMatrix::find(int row, int column) const
{
    const auto first = column_.begin() + begin_[row], last = column_.begin() + begin_[row + 1];
    const auto at = std::lower_bound(first, last, column);
    SIM_CHECK(at != last && *at == column);
    return static_cast<int>(at - column_.begin());
}

}  // namespace sim
