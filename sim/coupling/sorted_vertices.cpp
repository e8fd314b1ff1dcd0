#include "sim/coupling/sorted_vertices.h"

#include "sim/core/parallel.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <limits>

namespace sim {

namespace {

bool isAtLiquid(const BlockGrid& liquid, const Vec3i& block)
{
    for (int z = -1; z <= 1; ++z)
        for (int y = -1; y <= 1; ++y)
            for (int x = -1; x <= 1; ++x)
                if (liquid.find(block + Vec3i(x, y, z)) != BlockGrid::kNone) return true;
    return false;
}

}  // namespace

void SortedVertices::sort(const BlockGrid& liquid, const FabricState& state)
{
    grid.dx = liquid.dx;
    grid.origin = liquid.origin;
    particles.modeCount = 1;
    const std::size_t n = state.x.size();
    isNear_.resize(n);
    const double edge = kBlockEdge * liquid.dx;
    parallelFor((n + kGrain - 1) / kGrain, [&](std::size_t chunk) {
        Vec3i last = Vec3i::Constant(std::numeric_limits<int>::max());  // the next vertex is mostly in the same block
        bool isNear = false;
        for (std::size_t v = chunk * kGrain; v < std::min(n, (chunk + 1) * kGrain); ++v) {
            const Vec3i block = ((state.x[v] - liquid.origin) / edge).array().floor().matrix().cast<int>();
            if (block != last) isNear = isAtLiquid(liquid, last = block);
            isNear_[v] = isNear;
        }
    });
    particles.resize(static_cast<std::size_t>(std::count(isNear_.begin(), isNear_.end(), 1)));
    std::size_t p = 0;
    for (std::size_t v = 0; v < n; ++v) {
        if (!isNear_[v]) continue;
        particles.id[p] = static_cast<std::uint32_t>(v);
        for (int a = 0; a < kAxes; ++a) particles.x[a][p] = state.x[v][a];
        ++p;
    }
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
