#include "sim/fabric/grid/twist_elimination.h"

#include "sim/core/parallel.h"

namespace sim {

namespace {

/// A twist angle among the rows of its strand; vertices are at 4 j, and at distances 1 to 3 and 5 to 7.
constexpr int rowOf(int edge) { return 4 * edge + 3; }

}  // namespace

void TwistElimination::factor(const StrandLayout& layout, const StrandMatrix& stiffness, std::span<const double> inertia,
                              std::span<const double> held, double h)
{
    layout_ = &layout;
    stiffness_ = &stiffness;
    h2_ = h * h;
    lower_.resize(layout.edge.size());
    inverse_.resize(layout.edge.size());
    parallelFor(layout.groups.size(), [&](std::size_t g) {
        const StrandLayout::Group& group = layout.groups[g];
        for (int j = 0; j < group.edges(); ++j) {
            const int n = group.firstEdge + j, row = group.firstRow + rowOf(j);
            Pack diagonal = h2_ * loadPack(stiffness.lanes(row, 0));
            for (int l = 0; l < kLanes; ++l) {
                const int e = layout.edge[n][l];
                diagonal[l] += e >= 0 ? inertia[e] + h2_ * held[e] : 1.0;
            }
            lower_[n] = Pack{};
            if (j > 0) {
                const Pack beside = h2_ * loadPack(stiffness.lanes(row, 4));
                lower_[n] = beside * inverse_[n - 1];
                diagonal -= lower_[n] * beside;
            }
            inverse_[n] = 1.0 / diagonal;
        }
    });
}

void TwistElimination::backSubstitute(std::size_t g, Pack* rows) const
{
    const StrandLayout::Group& group = layout_->groups[g];
    for (int j = 0; j < group.edges(); ++j) {
        const int row = rowOf(j);
        const auto lower = [&](int r, int k) { return loadPack(stiffness_->lanes(group.firstRow + r, k)); };
        Pack torque{};
        for (int k = 1; k < 4; ++k) torque += lower(row, k) * rows[row - k] + lower(row + k, k) * rows[row + k];
        for (int k = 5; k < 8; ++k) {
            if (j > 0) torque += lower(row, k) * rows[row - k];
            if (j + 1 < group.edges()) torque += lower(row + k, k) * rows[row + k];
        }
        rows[row] = -h2_ * torque;
    }
    solve(g, rows);
}

void TwistElimination::solve(std::size_t g, Pack* rows) const
{
    const StrandLayout::Group& group = layout_->groups[g];
    const Pack *lower = lower_.data() + group.firstEdge, *inverse = inverse_.data() + group.firstEdge;
    for (int j = 1; j < group.edges(); ++j) rows[rowOf(j)] -= lower[j] * rows[rowOf(j - 1)];
    for (int j = group.edges() - 1; j >= 0; --j) {
        rows[rowOf(j)] *= inverse[j];
        if (j + 1 < group.edges()) rows[rowOf(j)] -= lower[j + 1] * rows[rowOf(j + 1)];
    }
}

}  // namespace sim
