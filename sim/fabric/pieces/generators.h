#pragma once

#include "sim/core/types.h"

#include <array>
#include <span>
#include <vector>

// The shapes of fabric that scenes ask for by a few numbers.

namespace sim {

/// Points, and the yarns and faces between them.
struct FabricGeometry {
    std::vector<Vec3> points;               ///< [cm]
    std::vector<std::vector<int>> strands;  ///< points in order
    std::vector<Vec3i> faces;
    std::vector<Vec2i> lattice;         ///< column and row of each point; empty where there are none
    Vec2i latticeSize = Vec2i::Zero();  ///< number of columns and rows; a strand has one row
    std::vector<int> ofFile{};          ///< point of each vertex of a file, or −1; empty where vertices and points are the same
};

/// First vertex of the file at each point; empty where vertices and points are the same.
std::vector<int> firstInFile(const FabricGeometry& geometry);

/// A sheet of nodes[0] × nodes[1] vertices; vertex (i, j) has the number j nodes[0] + i.
/// Each quad (a, a+1, a+n, a+n+1) is cut along one diagonal: (a, a+1, a+n), (a+1, a+n+1, a+n).
struct ClothGrid {
    Vec2i nodes = Vec2i(2, 2);                  ///< along u and v, at least 2 each
    std::array<double, 2> spacing{};            ///< along u and v [cm]
    Vec3 origin = Vec3::Zero();                 ///< vertex (0, 0) [cm]
    Vec3 u = Vec3::UnitX(), v = Vec3::UnitZ();  ///< unit vectors
};
FabricGeometry clothGrid(const ClothGrid& grid);

enum class Weave { Plain, Twill, Herringbone };

/// Yarns along u and v on lines one spacing apart, above and below each other: one vertex per crossing and yarn.
/// The first and last line of each direction are the border: it has no crossings; with `borders` four yarns run along
/// it through the ends of all the others and the corners, sharing their vertices. Yarns along u come first, then those
/// along v, then the border (fabric/README.md, Weaves).
struct WovenYarns {
    Vec2i yarns = Vec2i(3, 3);                  ///< along u, along v, the border included, at least 3 each
    double spacing = 0.0;                       ///< [cm]
    double amplitude = 0.0;                     ///< height of a centre line over the middle plane [cm]
    Vec3 origin = Vec3::Zero();                 ///< the corner [cm]
    Vec3 u = Vec3::UnitX(), v = Vec3::UnitZ();  ///< unit vectors
    Weave weave = Weave::Plain;
    bool borders = true;
};
FabricGeometry wovenYarns(const WovenYarns& cloth);

/// Whether the yarn along u on line k lies above the yarn along v on line j. Twill: over two, under two, one further on
/// every line; herringbone: its direction turns every four lines.
bool isAbove(Weave weave, int j, int k);

/// One yarn through the points in order.
FabricGeometry strand(std::span<const Vec3> points);
/// The straight yarn between two points.
FabricGeometry strand(const Vec3& from, const Vec3& to, int segments);

/// Number of points that the generators would make.
double pointCount(const ClothGrid& grid);
double pointCount(const WovenYarns& cloth);

}  // namespace sim
