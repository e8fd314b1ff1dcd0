#pragma once

#include "sim/fabric/cohesion.h"
#include "sim/fabric/contact/closest_points.h"
#include "sim/fabric/contact/distances.h"
#include "sim/fabric/fabric.h"

#include <array>
#include <vector>

namespace sim::contact {

/// Distances of one pair at which something happens [cm] (fabric/contact/README.md, Pairs).
struct ContactDistances {
    double reach = 0.0;  ///< R: it acts below
    double core = 0.0;   ///< distance below which it never comes; 0: the two are one body at rest and make no pair

    /// Below it the spring becomes a wall.
    double wall() const { return core + kWall * (reach - core); }
};

/// What can touch: the edges, the vertices and the faces of a fabric, numbered in this order in one row. Pairs (a, b), a < b, are two edges
/// or a vertex and a face. Edges are those of the yarns, then those of the faces that are not along a yarn.
struct Primitives {
    explicit Primitives(const Fabric& fabric);

    int edgeCount = 0, vertexCount = 0, faceCount = 0;
    std::vector<std::array<int, 2>> edges;
    std::vector<std::array<int, 3>> faces;
    std::vector<char> pinned;      ///< whether each vertex is pinned
    std::vector<int> piece;        ///< each vertex's mesh or strand (FabricGroups)
    std::vector<double> radius;    ///< radius of each primitive: that of a yarn, half the thickness of cloth [cm]
    std::vector<double> young;     ///< E χ [dyn/cm^2]
    std::vector<double> friction;  ///< tan of the friction angle [-]
    std::vector<int> strand;       ///< strand of each edge; −1 for edges of cloth
    std::vector<int> strandReach;  ///< number of edges along each strand within which two don't touch

    int firstVertex() const { return edgeCount; }
    int firstFace() const { return edgeCount + vertexCount; }
    int count() const { return edgeCount + vertexCount + faceCount; }
    PairKind kind(int a) const { return a < edgeCount ? PairKind::EdgeEdge : PairKind::VertexFace; }
    std::array<int, 4> vertices(int a, int b) const
    {
        if (kind(a) == PairKind::EdgeEdge) return {edges[a][0], edges[a][1], edges[b][0], edges[b][1]};
        const std::array<int, 3>& f = faces[b - firstFace()];
        return {a - firstVertex(), f[0], f[1], f[2]};
    }

    /// The distance over which a pair acts before it is pressed to its offset, d̂ [cm].
    double band(int a, int b) const { return kBand * std::min(radius[a], radius[b]); }
    double friction2(int a, int b) const { return std::sqrt(friction[a] * friction[b]); }

    /// Neither share a vertex nor are neighbours on a strand, nor are all four vertices held: then nothing could be done.
    bool canTouch(int a, int b) const;
    /// How long a liquid bridge between the two may be beyond their reach [cm].
    double bridge(int a, int b) const { return kBridgeLength * std::min(radius[a], radius[b]); }
    bool areOfOnePiece(int a, int b) const
    {
        const std::array<int, 4> v = vertices(a, b);
        return piece[v[0]] == piece[v[3]];
    }
    /// @param restDistance  of the two [cm]; anything large for pairs far apart
    ContactDistances range(int a, int b, double restDistance) const;

 private:
    void addYarns(const Fabric& fabric);
    void addClothEdges(const Fabric& fabric);
};

}  // namespace sim::contact
