#pragma once

#include "sim/core/pack_math.h"
#include "sim/fabric/rods/rod_kernel.h"
#include "sim/fabric/rods/rods.h"

// Strands of yarn, eight at a time, from one end to the other.

namespace sim {

inline PackVec3 gathered(const std::vector<Vec3>& values, const StrandLayout::Lanes& index)
{
    PackVec3 v{};
    for (int l = 0; l < kLanes; ++l)
        if (index[l] >= 0) setLane(v, l, values[index[l]]);
    return v;
}

inline Pack gathered(const std::vector<double>& values, const StrandLayout::Lanes& index)
{
    Pack v{};
    for (int l = 0; l < kLanes; ++l)
        if (index[l] >= 0) v[l] = values[index[l]];
    return v;
}

/// The edge between two gathered vertices; unused lanes get an edge of length 1.
inline RodEdge<Pack> edgeBetween(const PackVec3& from, const PackVec3& to, const StrandLayout::Lanes& edges)
{
    RodEdge<Pack> e;
    PackVec3 along = to - from;
    for (int l = 0; l < kLanes; ++l)
        if (edges[l] < 0) setLane(along, l, Vec3::UnitX());
    e.length = norm(along);
    e.tangent = (broadcast(1.0) / e.length) * along;
    return e;
}

/// Turns the reference frame by θ.
inline void setMaterialFrame(const FabricState& state, const StrandLayout::Lanes& edges, RodEdge<Pack>& e)
{
    e.reference = gathered(state.reference, edges);
    const Pack theta = gathered(state.theta, edges);
    const auto [c, s] = directionOf(theta);
    const PackVec3 second = cross(e.tangent, e.reference);
    e.m1 = c * e.reference + s * second;
    e.m2 = c * second - s * e.reference;
}

/// A vertex with an edge on either side, as forEachInnerVertex meets it.
struct Rods::InnerVertex {
    int j;  ///< the vertex within the strands; edge j − 1 ends and edge j begins here
    const RodEdge<Pack>&before, &after;
    RodStrain<Pack> strain;
    Pack twist;  ///< m [rad]
};

/// Calls visit(InnerVertex) for every vertex between two edges, from the first to the last.
template <class Visit>
void Rods::forEachInnerVertex(int g, const FabricState& state, Visit&& visit) const
{
    const StrandLayout::Group& group = layout_.groups[g];
    PackVec3 from = gathered(state.x, layout_.vertex[group.firstVertex]);
    RodEdge<Pack> before;
    Pack thetaBefore{};
    for (int j = 0; j < group.edges(); ++j) {
        const StrandLayout::Lanes& edges = layout_.edge[group.firstEdge + j];
        const PackVec3 to = gathered(state.x, layout_.vertex[group.firstVertex + j + 1]);
        RodEdge<Pack> edge = edgeBetween(from, to, edges);
        setMaterialFrame(state, edges, edge);
        const Pack theta = gathered(state.theta, edges);
        if (j > 0) {
            InnerVertex at{j, before, edge, rodStrain(before, edge), gathered(state.referenceTwist, edges) + theta - thetaBefore};
            visit(at);
        }
        before = edge;
        thetaBefore = theta;
        from = to;
    }
}

}  // namespace sim
