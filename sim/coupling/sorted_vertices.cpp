#include "sim/coupling/sorted_vertices.h"

#include "sim/core/parallel.h"

#include <Eigen/Geometry>

#include <algorithm>

namespace sim {

namespace {

/// How far faces of a vertex' stencil are, in cells.
constexpr double kStencilReach = 2.0;

/// The first and the last block, by axis, that a vertex reaches.
struct ReachedBlocks {
    Vec3i first, last;

    bool operator==(const ReachedBlocks&) const = default;
    bool anyOf(const BlockGrid& liquid) const
    {
        for (int z = first.z(); z <= last.z(); ++z)
            for (int y = first.y(); y <= last.y(); ++y)
                for (int x = first.x(); x <= last.x(); ++x)
                    if (liquid.find(Vec3i(x, y, z)) != BlockGrid::kNone) return true;
        return false;
    }
};

ReachedBlocks reachedBlocks(const BlockGrid& grid, const Vec3& x)
{
    const auto blockAt = [&](double cells) -> Vec3i {
        return (((x - grid.origin) / grid.dx).array() + cells).cwiseQuotient(Eigen::Array3d::Constant(kBlockEdge)).floor().cast<int>();
    };
    return {blockAt(-kStencilReach), blockAt(kStencilReach)};
}

}  // namespace

SortedVertices& VertexSorter::sort(const BlockGrid& liquid, const FabricState& state)
{
    Particles& particles = sorted_.particles;
    BlockGrid& grid = sorted_.grid;
    grid.dx = liquid.dx;
    grid.origin = liquid.origin;
    particles.modeCount = 1;
    const std::size_t n = state.x.size();
    isNear_.resize(n);
    parallelFor((n + kGrain - 1) / kGrain, [&](std::size_t chunk) {
        ReachedBlocks before{Vec3i::Zero(), Vec3i::Constant(-1)};  // none; the next vertex mostly reaches the same ones
        bool isNear = false;
        for (std::size_t v = chunk * kGrain; v < std::min(n, (chunk + 1) * kGrain); ++v) {
            const ReachedBlocks blocks = reachedBlocks(liquid, state.x[v]);
            if (!(blocks == before)) isNear = blocks.anyOf(liquid);
            isNear_[v] = isNear;
            before = blocks;
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
    sortParticles(particles, grid, nullptr, sorted_.order, nullptr);
    return sorted_;
}

bool reachesLiquid(const BlockGrid& liquid, const FabricState& state)
{
    if (liquid.count() == 0) return false;
    Eigen::AlignedBox3d box;
    for (int b = 0; b < liquid.count(); ++b) {
        box.extend(liquid.lowerCorner(b));
        box.extend(liquid.lowerCorner(b) + Vec3::Constant(kBlockEdge * liquid.dx));
    }
    const Vec3 reach = Vec3::Constant(kStencilReach * liquid.dx);
    box.min() -= reach;
    box.max() += reach;
    return std::ranges::any_of(state.x, [&](const Vec3& x) { return box.contains(x); });
}

}  // namespace sim
