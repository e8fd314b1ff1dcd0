#pragma once

#include "sim/core/parallel.h"
#include "sim/grid/block_grid.h"

#include <array>
#include <vector>

namespace sim {

/// Some blocks of a grid, in eight colours of which none has two blocks that touch.
struct ColoredBlocks {
    std::vector<int> blocks;                 ///< numbers of the blocks
    std::vector<int> place;                  ///< place of each block of the grid among them, or BlockGrid::kNone
    std::array<std::vector<int>, 8> colors;  ///< places

    void set(const BlockGrid& grid, const std::vector<int>& some)
    {
        blocks = some;
        place.assign(grid.count() + 1, BlockGrid::kNone);
        for (auto& color : colors) color.clear();
        for (std::size_t n = 0; n < blocks.size(); ++n) {
            const Vec3i& at = grid.coords(blocks[n]);
            place[blocks[n]] = static_cast<int>(n);
            colors[(at.x() & 1) + 2 * (at.y() & 1) + 4 * (at.z() & 1)].push_back(static_cast<int>(n));
        }
    }

    /// Call f(place, block) for all, at the same time only for such that do not touch each other: f may write one cell far into the neighbours, in an
    /// order that does not depend on the threads.
    template <class F>
    void inColors(F&& f) const
    {
        for (const std::vector<int>& color : colors) parallelFor(color.size(), [&](std::size_t n) { f(color[n], blocks[color[n]]); });
    }
};

}  // namespace sim
