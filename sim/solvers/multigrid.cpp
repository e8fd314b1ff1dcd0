#include "sim/solvers/multigrid.h"

#include "sim/core/parallel.h"
#include "sim/solvers/multigrid_level.h"

#include <algorithm>

namespace sim {

namespace {

int childIndex(const Vec3i& coords) { return (coords.z() & 1) * 4 + (coords.y() & 1) * 2 + (coords.x() & 1); }

Vec3i parentCoords(const Vec3i& coords) { return {coords.x() >> 1, coords.y() >> 1, coords.z() >> 1}; }

bool isBefore(const Vec3i& a, const Vec3i& b) { return std::array{a.z(), a.y(), a.x()} < std::array{b.z(), b.y(), b.x()}; }

/// Everything of a level that follows from its blocks alone.
void finishShape(MultigridLevel& level)
{
    const int n = level.blocks();
    level.neighbours.resize(n + 1);
    level.neighbours[n].fill(n);
    for (auto& list : level.colour) list.clear();
    for (int b = 0; b < n; ++b) {
        level.neighbours[b] = level.grid.neighboursAtSides(b);
        level.colour[level.grid.coords(b).sum() & 1].push_back(b);
    }
    level.rows.resize(n + 1);
    level.rows[n] = 0;
    level.matrix.resize(n);
    level.faces.resize((n + std::size_t{1}) * kAxes * kBlockRows);
    std::fill_n(level.face(0, n), kAxes * kBlockRows, 0.0f);
    level.dirichlet.resize(n);
    level.x.resize(n);
    level.r.resize(n);
}

void connect(MultigridLevel& fine, MultigridLevel& coarse)
{
    std::array<int, 8> none;
    none.fill(BlockGrid::kNone);
    coarse.children.assign(coarse.blocks(), none);
    fine.parent.resize(fine.blocks());
    for (int b = 0; b < fine.blocks(); ++b) {
        const Vec3i& coords = fine.grid.coords(b);
        fine.parent[b] = coarse.grid.find(parentCoords(coords));
        coarse.children[fine.parent[b]][childIndex(coords)] = b;
    }
}

}  // namespace

void Multigrid::buildShape(const BlockGrid& grid)
{
    if (count_ > 0 && coords_ == grid.coords()) return;
    coords_ = grid.coords();

    // Counted from the lowest corner, the hierarchy depends on the shape alone, and ends in a single block.
    Vec3i lowest = coords_.empty() ? Vec3i(0, 0, 0) : coords_[0];
    for (const Vec3i& c : coords_) lowest = lowest.cwiseMin(c);
    scratch_.assign(coords_.begin(), coords_.end());
    for (Vec3i& c : scratch_) c -= lowest;

    constexpr int kLevelsInABlock = 3;  // 8 cells, 4, 2, 1
    int below = 0;
    for (count_ = 0;; ++count_) {
        if (count_ == static_cast<int>(levels_.size())) levels_.emplace_back();
        MultigridLevel& level = levels_[count_];
        level.grid.setBlocks(scratch_);
        finishShape(level);
        if (count_ > 0) connect(levels_[count_ - 1], level);
        if (level.blocks() <= 1 && below++ == kLevelsInABlock) break;

        for (Vec3i& c : scratch_) c = parentCoords(c);
        std::sort(scratch_.begin(), scratch_.end(), isBefore);
        scratch_.erase(std::unique(scratch_.begin(), scratch_.end()), scratch_.end());
    }
    ++count_;
    levels_[0].dot.resize(levels_[0].blocks());
}

void Multigrid::build(const BlockGrid& grid, const PoissonMatrix& matrix)
{
    buildShape(grid);
    multigrid::takeFinest(grid, matrix, levels_[0]);
    for (int l = 1; l < count_; ++l) multigrid::gatherCoarse(levels_[l - 1], levels_[l]);
}

void Multigrid::cycle(int l, bool fromZero)
{
    using namespace multigrid;
    MultigridLevel& level = levels_[l];
    const int sweeps = level.blocks() > 1 ? options.sweeps : options.coarseSweeps;

    smooth(level, {.colour = 0, .sweeps = sweeps, .fromZero = fromZero, .alone = fromZero});
    smooth(level, {.colour = 1, .sweeps = sweeps, .fromZero = fromZero});

    const MultigridLevel* coarse = nullptr;
    if (l + 1 < count_) {
        coarse = &levels_[l + 1];
        restrictResidual(level, levels_[l + 1]);
        cycle(l + 1, true);
        if (l >= options.firstTwice && level.blocks() > 1) cycle(l + 1, false);
        prolong(*coarse, level, 0);
    }

    const bool isFinest = l == 0;
    smooth(level, {.colour = 1, .sweeps = sweeps, .order = Order::Backward, .coarse = coarse, .dots = isFinest});
    smooth(level, {.colour = 0, .sweeps = sweeps, .order = Order::Backward, .dots = isFinest});
}

double Multigrid::cycle()
{
    cycle(0, true);
    double sum = 0.0;
    for (double d : levels_[0].dot) sum += d;
    return sum;
}

}  // namespace sim
