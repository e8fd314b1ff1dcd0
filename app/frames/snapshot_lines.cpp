#include "app/frames/snapshot_lines.h"

#include <algorithm>

namespace app {

namespace {

const Eigen::Vector3f kBlockColor = {0.55f, 0.62f, 0.70f}, kArrowColor = {0.10f, 0.11f, 0.13f}, kContactColor = {0.90f, 0.12f, 0.10f};

/// Edge of a block from the corner at these block coordinates along this axis.
struct BlockEdge {
    int axis;
    std::array<int, 3> corner;

    auto operator<=>(const BlockEdge&) const = default;
};

std::vector<BlockEdge> edgesOf(const sim::BlockGrid& grid)
{
    std::vector<BlockEdge> edges;
    edges.reserve(12 * static_cast<std::size_t>(grid.count()));
    for (const sim::Vec3i& c : grid.coords())
        for (int axis = 0; axis < 3; ++axis)
            for (int side = 0; side < 4; ++side) {
                std::array corner = {c.x(), c.y(), c.z()};
                corner[(axis + 1) % 3] += side & 1;
                corner[(axis + 2) % 3] += side >> 1;
                edges.push_back({axis, corner});
            }
    std::ranges::sort(edges);
    edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
    return edges;
}

/// Largest radius of yarns, or half thickness of cloth [cm].
double largestRadius(const sim::Fabric& fabric)
{
    double radius = 0.0;
    for (const auto& [a, b] : fabric.strands.radius) radius = std::max({radius, a, b});
    for (const double thickness : fabric.faces.thickness) radius = std::max(radius, 0.5 * thickness);
    return radius;
}

}  // namespace

FrameSnapshot::Lines blockEdges(const sim::BlockGrid& grid)
{
    FrameSnapshot::Lines lines{.points = {}, .color = kBlockColor, .width = 1.0f};
    const double length = grid.dx * sim::kBlockEdge;
    for (const BlockEdge& edge : edgesOf(grid)) {
        const sim::Vec3 begin = grid.origin + length * sim::Vec3(edge.corner[0], edge.corner[1], edge.corner[2]);
        lines.points.push_back(begin.cast<float>());
        lines.points.push_back((begin + length * sim::Vec3::Unit(edge.axis)).cast<float>());
    }
    return lines;
}

Arrows velocityArrows(const sim::LiquidParticles& liquid, double time, float lift)
{
    constexpr double kHead = 0.35;  // of the length
    Arrows arrows;
    arrows.shafts = {.points = {}, .color = kArrowColor, .width = 1.5f, .rim = 1.0f, .lift = lift};
    arrows.heads = {.points = {}, .color = kArrowColor, .width = 7.0f, .isTapered = true, .rim = 1.0f, .lift = lift};
    const std::size_t every = std::max<std::size_t>(1, (liquid.count + kMostArrows - 1) / kMostArrows);
    for (std::size_t p = 0; p < liquid.count; ++p) {
        if (liquid.id[p] % every != 0) continue;
        const sim::Vec3 begin = liquid.position(p), way = time * liquid.velocity(p);
        const Eigen::Vector3f neck = (begin + (1.0 - kHead) * way).cast<float>();
        arrows.shafts.points.push_back(begin.cast<float>());
        arrows.shafts.points.push_back(neck);
        arrows.heads.points.push_back(neck);
        arrows.heads.points.push_back((begin + way).cast<float>());
    }
    return arrows;
}

FrameSnapshot::Lines contactLines(const sim::ActiveContacts& contacts, const sim::Fabric& fabric, std::span<const sim::Vec3> x)
{
    constexpr double kLift = 1.5;  // radii of the fabric
    FrameSnapshot::Lines lines{
        .points = {}, .color = kContactColor, .width = 3.0f, .isTapered = false, .lift = static_cast<float>(kLift * largestRadius(fabric))};
    for (std::size_t i = 0; i < contacts.size(); ++i) {
        std::array<sim::Vec3, 2> ends = {sim::Vec3::Zero(), sim::Vec3::Zero()};
        for (int k = 0; k < 4; ++k) {
            const bool isFirst = k < contacts.firstSide[i];
            ends[isFirst ? 0 : 1] += std::abs(contacts.weights[i][k]) * x[contacts.vertices[i][k]];
        }
        for (const sim::Vec3& end : ends) lines.points.push_back(end.cast<float>());
    }
    return lines;
}

void takeLines(const sim::State& state, const sim::Fabric& fabric, const sim::ActiveContacts* contacts, const SnapshotExtras& extras, float radius,
               std::vector<FrameSnapshot::Lines>& out)
{
    out.clear();
    if (extras.blocks) out.push_back(blockEdges(state.grid));
    if (extras.arrows) {
        const Arrows arrows = velocityArrows(state.liquid, extras.arrowTime, 2.0f * radius);
        out.push_back(arrows.shafts);
        out.push_back(arrows.heads);
    }
    if (extras.contacts && contacts != nullptr) out.push_back(contactLines(*contacts, fabric, state.fabric.x));
}

}  // namespace app
