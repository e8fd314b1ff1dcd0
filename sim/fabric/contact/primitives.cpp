#include "sim/fabric/contact/primitives.h"

#include "sim/fabric/groups.h"

#include <algorithm>
#include <cmath>
#include <tuple>

namespace sim::contact {

namespace {

/// Pairs nearer at rest than this share of their radii are one body: sewn on, or meant to cross [-].
constexpr double kJoined = 0.25;

double effectiveYoung(const FabricMaterial& m) { return m.young * m.packing(); }

}  // namespace

Primitives::Primitives(const Fabric& fabric) : pinned(fabric.pinned)
{
    addYarns(fabric);
    addClothEdges(fabric);
    edgeCount = static_cast<int>(edges.size());
    vertexCount = static_cast<int>(fabric.vertexCount());
    const FabricGroups groups(fabric);
    for (int v = 0; v < vertexCount; ++v) {
        const FabricMaterial& m = fabric.materials[fabric.vertexMaterial[v]];
        radius.push_back(fabric.radius[v]);
        young.push_back(effectiveYoung(m));
        friction.push_back(std::tan(m.frictionAngle));
        piece.push_back(groups.pieceOf(v));
    }
    faceCount = static_cast<int>(fabric.faces.size());
    for (int f = 0; f < faceCount; ++f) {
        const FabricMaterial& m = fabric.materials[fabric.faces.material[f]];
        const Vec3i& v = fabric.faces.vertices[f];
        faces.push_back({v[0], v[1], v[2]});
        radius.push_back(0.5 * fabric.faces.thickness[f]);
        young.push_back(effectiveYoung(m));
        friction.push_back(std::tan(m.frictionAngle));
    }
}

void Primitives::addYarns(const Fabric& fabric)
{
    for (std::size_t e = 0; e < fabric.edges.size(); ++e) {
        const int s = fabric.edges.strand[e];
        const FabricMaterial& m = fabric.materials[fabric.strands.material[s]];
        edges.push_back({fabric.edges.vertices[e][0], fabric.edges.vertices[e][1]});
        radius.push_back(std::sqrt(fabric.strands.radius[s][0] * fabric.strands.radius[s][1]));
        young.push_back(effectiveYoung(m));
        friction.push_back(std::tan(m.frictionAngle));
        strand.push_back(s);
    }
    for (int s = 0; s < fabric.strands.count(); ++s) {
        const int begin = fabric.strands.edgeBegin(s), count = fabric.strands.size(s) - 1;
        double length = 0.0;
        for (int e = begin; e < begin + count; ++e) length += fabric.edges.restLength[e] / count;
        const double r = std::sqrt(fabric.strands.radius[s][0] * fabric.strands.radius[s][1]);
        strandReach.push_back(static_cast<int>(std::ceil((2.0 * r + kBand * r) / length)) + 1);
    }
}

void Primitives::addClothEdges(const Fabric& fabric)
{
    using Side = std::tuple<int, int, int>;  // smaller vertex, larger vertex, face; −1 − yarn edge where there is one
    std::vector<Side> sides;
    for (std::size_t e = 0; e < edges.size() && fabric.faces.size() > 0; ++e)
        sides.emplace_back(std::min(edges[e][0], edges[e][1]), std::max(edges[e][0], edges[e][1]), -1 - static_cast<int>(e));
    for (std::size_t f = 0; f < fabric.faces.size(); ++f)
        for (int c = 0; c < 3; ++c) {
            const int v = fabric.faces.vertices[f][c], w = fabric.faces.vertices[f][(c + 1) % 3];
            sides.emplace_back(std::min(v, w), std::max(v, w), static_cast<int>(f));
        }
    std::ranges::sort(sides);

    int edge = -1;  // to which these vertices belong
    for (std::size_t i = 0; i < sides.size(); ++i) {
        const auto [v, w, face] = sides[i];
        const bool known = i > 0 && std::get<0>(sides[i - 1]) == v && std::get<1>(sides[i - 1]) == w;
        if (face < 0) {
            edge = -1 - face;
            continue;
        }
        const FabricMaterial& m = fabric.materials[fabric.faces.material[face]];
        const double r = 0.5 * fabric.faces.thickness[face];
        if (known) {
            radius[edge] = std::max(radius[edge], r);
            continue;
        }
        edge = static_cast<int>(edges.size());
        edges.push_back({v, w});
        radius.push_back(r);
        young.push_back(effectiveYoung(m));
        friction.push_back(std::tan(m.frictionAngle));
        strand.push_back(-1);
    }
}

bool Primitives::canTouch(int a, int b) const
{
    const std::array<int, 4> v = vertices(a, b);
    if (kind(a) == PairKind::VertexFace) {
        if (v[0] == v[1] || v[0] == v[2] || v[0] == v[3]) return false;
    } else {
        if (v[0] == v[2] || v[0] == v[3] || v[1] == v[2] || v[1] == v[3]) return false;
        if (strand[a] >= 0 && strand[a] == strand[b] && b - a <= strandReach[strand[a]]) return false;
    }
    return !(pinned[v[0]] && pinned[v[1]] && pinned[v[2]] && pinned[v[3]]);
}

ContactDistances Primitives::range(int a, int b, double restDistance) const
{
    const double touching = radius[a] + radius[b];
    if (restDistance < kJoined * touching) return {};
    const double d0 = std::min(restDistance, touching + band(a, b));
    return {d0, std::min(kCore * touching, kCoreAtRest * restDistance)};
}

}  // namespace sim::contact
