#include "sim/liquid/viscous_multigrid.h"

#include "sim/core/parallel.h"
#include "sim/grid/rows.h"
#include "sim/solvers/block_rows.h"

#include <algorithm>
#include <cmath>

namespace sim {

namespace {

/// No eigenvalue of the matrix over its diagonal is larger: a strain has at most four velocities.
constexpr double kLargest = 4.0;
constexpr double kSmoothed = 0.4;  ///< the smallest that smoothing takes care of where there is a coarser level
constexpr int kSmoothingSteps = 3;
constexpr double kStiff = 0.5;      ///< levels stiffer than this get a coarser one
constexpr double kSmallest = 0.04;  ///< that the coarsest level takes care of at most

}  // namespace

/// Each level to its grid: levels may have been moved or copied.
void ViscousMultigrid::point(const BlockGrid& grid)
{
    for (Level& level : levels_) level.grid = &level == &levels_[0] ? &grid : &level.ownGrid;
}

void ViscousMultigrid::buildShape(const BlockGrid& grid)
{
    coords_ = grid.coords();
    if (levels_.empty()) levels_.resize(1);
    std::vector<Vec3i> coords = coords_;
    std::size_t l = 0;
    // Blocks on either side of a coordinate plane never share a parent.
    const auto isLast = [](const Vec3i& c) { return c.minCoeff() >= -1 && c.maxCoeff() <= 0; };
    for (; coords.size() > 1 && !std::ranges::all_of(coords, isLast); ++l) {
        for (Vec3i& c : coords) c = parentBlock(c);
        const auto before = [](const Vec3i& a, const Vec3i& b) {
            return std::lexicographical_compare(a.data(), a.data() + 3, b.data(), b.data() + 3);
        };
        std::sort(coords.begin(), coords.end(), before);
        coords.erase(std::unique(coords.begin(), coords.end()), coords.end());
        if (l + 1 == levels_.size()) levels_.emplace_back();
        levels_[l + 1].ownGrid.setBlocks(coords);
    }
    levels_.resize(l + 1);
    point(grid);
    for (std::size_t n = 1; n < levels_.size(); ++n) levels_[n - 1].toCoarser.connect(*levels_[n - 1].grid, *levels_[n].grid);
}

void ViscousMultigrid::build(const BlockGrid& grid, const ViscousSystem& system, double stiffness)
{
    if (levels_.empty() || coords_ != grid.coords()) buildShape(grid);
    point(grid);
    levels_[0].system = &system;
    stiffness_ = stiffness;
    count_ = 1;
    for (double s = stiffness; s > kStiff && count_ < static_cast<int>(levels_.size()); s *= 0.25) ++count_;
    for (int l = 0; l < count_; ++l) {
        Level& level = levels_[l];
        const int blocks = level.grid->count();
        for (BlockArray<double, 3>* v : {&level.solution, &level.residual, &level.direction, &level.applied}) v->resize(blocks);
        if (l + 1 == count_) break;
        Level& coarse = levels_[l + 1];
        coarse.rhs.resize(coarse.grid->count());
        coarse.system = &coarse.ownSystem;
        level.toCoarser.coarsen(*level.grid, *level.system, level.residual, *coarse.grid, coarse.ownSystem);
    }
    for (int l = 0; l < count_; ++l)
        for (BlockArray<double, 3>* v : {&levels_[l].solution, &levels_[l].residual, &levels_[l].direction})
            forEachBlock(levels_[l].grid->count(), [&](int b) { std::fill_n(v->block(b), BlockArray<double, 3>::kStride, 0.0); });
}

/// Chebyshev's iteration for eigenvalues from `lowest` to kLargest (Saad 2003, algorithm 12.1). Leaves the residual
/// behind.
void ViscousMultigrid::smooth(Level& level, const BlockArray<double, 3>& rhs, double lowest, int steps, bool fromZero)
{
    const BlockGrid& grid = *level.grid;
    const ViscousSystem& system = *level.system;
    const double middle = 0.5 * (kLargest + lowest), half = 0.5 * (kLargest - lowest);
    if (!fromZero) forEachBlock(grid.count(), [&](int b) { system.multiply(grid, level.solution, b, level.applied); });
    double ratio = half / middle;
    for (int step = 0; step <= steps; ++step) {
        const double next = 1.0 / (2.0 * middle / half - ratio);
        const double keep = step == 0 ? 0.0 : next * ratio, take = step == 0 ? 1.0 / middle : 2.0 * next / half;
        if (step > 0) {
            forEachBlock(grid.count(), [&](int b) { system.multiply(grid, level.direction, b, level.applied); });
            ratio = next;
        }
        forEachBlock(grid.count(), [&](int b) {
            system.forEachUnknownRow(b, [&](int a, int row) {
                double *x = level.solution.block(b, a) + row, *r = level.residual.block(b, a) + row;
                double* d = level.direction.block(b, a) + row;
                const bool isFresh = step == 0;
                Pack residual = loadPack(isFresh ? rhs.block(b, a) + row : r);
                if (!isFresh || !fromZero) residual -= loadPack(level.applied.block(b, a) + row);
                storePack(r, residual);
                if (step == steps) return;
                const Pack diagonal = loadPack(system.diagonal.block(b, a) + row);
                Pack move = take * select(diagonal > 0.0, residual / diagonal, broadcast(0.0));
                if (!isFresh) move += keep * loadPack(d);
                storePack(d, move);
                storePack(x, isFresh && fromZero ? move : loadPack(x) + move);
            });
        });
    }
}

void ViscousMultigrid::cycle(int l, const BlockArray<double, 3>& rhs)
{
    Level& level = levels_[l];
    if (l + 1 == count_) {
        // Without a coarser level the smallest eigenvalue is inertia's share of the diagonal.
        const double lowest = std::max(kSmallest, 1.0 / (1.0 + 8.0 * stiffness_ * std::pow(0.25, l)));
        smooth(level, rhs, lowest, static_cast<int>(std::ceil(std::sqrt(kLargest / lowest))), true);
        return;
    }
    Level& coarse = levels_[l + 1];
    smooth(level, rhs, kSmoothed, kSmoothingSteps, true);
    level.toCoarser.restrict(level.residual, *coarse.system, coarse.rhs);
    cycle(l + 1, coarse.rhs);
    level.toCoarser.prolong(*coarse.grid, coarse.solution, *level.grid, *level.system, level.solution);
    smooth(level, rhs, kSmoothed, kSmoothingSteps, false);
}

}  // namespace sim
