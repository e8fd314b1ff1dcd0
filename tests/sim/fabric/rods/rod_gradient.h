#pragma once

#include "sim/fabric/rods/rods.h"

#include <vector>

namespace sim::testing {

/// Gradient at the start of a step, by vertex and edge instead of by packed rows.
inline std::vector<double> gradientOf(Rods& rods, const FabricState& state, StrandMatrix* matrix = nullptr, double h = 1.0)
{
    const StrandLayout& layout = rods.layout();
    std::vector<Pack> packed(layout.rows, Pack{});
    rods.startStep(state).forces(state, h, packed, matrix);
    std::vector<double> gradient(3 * state.x.size() + state.theta.size(), 0.0);
    for (const StrandLayout::Group& group : layout.groups)
        for (int j = 0; j < group.vertices; ++j)
            for (int l = 0; l < kLanes; ++l) {
                const int v = layout.vertex[group.firstVertex + j][l], row = group.firstRow + 4 * j;
                if (v < 0) continue;
                for (int a = 0; a < 3; ++a) gradient[3 * v + a] += packed[row + a][l];
                const int e = j < group.edges() ? layout.edge[group.firstEdge + j][l] : -1;
                if (e >= 0) gradient[3 * state.x.size() + e] = packed[row + 3][l];
            }
    return gradient;
}

}  // namespace sim::testing
