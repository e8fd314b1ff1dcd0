#include "app/lab/precision/precision_table.h"

#include "app/system/atomic_files.h"

#include <algorithm>
#include <utility>

namespace app {

const PrecisionRow* PrecisionTable::find(const PrecisionRun& run, int threads, int repeats) const
{
    const auto row = std::ranges::find_if(rows_, [&](const PrecisionRow& of) { return of.scene == run.scene && of.names == run.names; });
    if (row == rows_.end()) return nullptr;
    const bool isEnough = row->settings == run.settings && row->threads == threads && row->repeats >= repeats;
    return isEnough ? &*row : nullptr;
}

void PrecisionTable::add(const PrecisionRow& row)
{
    std::erase_if(rows_, [&](const PrecisionRow& of) { return of.scene == row.scene && of.names == row.names; });
    rows_.push_back(row);
    writeWhole(file_, precisionCsv(rows_));
}

}  // namespace app
