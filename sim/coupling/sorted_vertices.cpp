#include "sim/coupling/sorted_vertices.h"

#include "sim/core/parallel.h"

#include <Eigen/Geometry>

#include <algorithm>

namespace sim {

void SortedVertices::sort(const BlockGrid& liquid, const FabricState& state)
{
    grid.dx = liquid.dx;
    grid.origin = liquid.origin;
    particles.modeCount = 1;
    particles.resize(state.x.size());
    parallelFor(state.x.size(), 4096, [&](std::size_t v) {
        particles.id[v] = static_cast<std::uint32_t>(v);
        for (int a = 0; a < kAxes; ++a) particles.x[a][v] = state.x[v][a];
    });
    sortParticles(particles, grid, nullptr, order, ledger_);
}

bool reachesLiquid(const BlockGrid& liquid, const FabricState& state)
{
    if (liquid.count() == 0) return false;
    Eigen::AlignedBox3d box;
    for (int b = 0; b < liquid.count(); ++b) {
        box.extend(liquid.lowerCorner(b));
        box.extend(liquid.lowerCorner(b) + Vec3::Constant(kBlockEdge * liquid.dx));
    }
    const Vec3 reach = Vec3::Constant(2.0 * liquid.dx);  // of a vertex' stencil
    box.min() -= reach;
    box.max() += reach;
    return std::ranges::any_of(state.x, [&](const Vec3& x) { return box.contains(x); });
}

}  // namespace sim
