#pragma once

#include <array>
#include <cstdint>

namespace sim {

/// Corner c of a cube lies at (c & 1, c >> 1 & 1, c >> 2).
struct CubeEdge {
    int axis;    ///< axis that it runs along
    int corner;  ///< lower end
};

/// The four edges along x, then y, then z.
inline constexpr std::array<CubeEdge, 12> kCubeEdges = [] {
    std::array<CubeEdge, 12> edges{};
    int n = 0;
    for (int axis = 0; axis < 3; ++axis)
        for (int corner = 0; corner < 8; ++corner)
            if ((corner >> axis & 1) == 0) edges[n++] = {axis, corner};
    return edges;
}();

/// How a surface passes through one cube: triangles of places on cut edges, counter-clockwise seen from outside.
struct CubeCase {
    static constexpr int kMostTriangles = 10;
    std::uint8_t count = 0;
    std::array<std::array<std::uint8_t, 3>, kMostTriangles> triangles{};  ///< numbers of edges
};

/// The cases of marching cubes (Lorensen & Cline 1987) by which corners are inside, bit c for corner c; derived, not
/// listed. On each face the inside corners are cut off run by run, so that two that meet across a diagonal stay apart:
/// a rule that the cubes on both sides of the face agree on. The segments join to loops, and loops are cut into
/// triangles by chords that lie in no face: each segment then has one triangle in each of two cubes and each chord two
/// in its own, so that the whole surface is a closed manifold.
const std::array<CubeCase, 256>& cubeCases();

}  // namespace sim
