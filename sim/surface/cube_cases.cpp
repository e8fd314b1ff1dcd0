#include "sim/surface/cube_cases.h"

namespace sim {

namespace {

constexpr int kNone = -1;

constexpr int edgeBetween(int a, int b)
{
    for (int e = 0; e < 12; ++e)
        if ((kCubeEdges[e].corner == a || kCubeEdges[e].corner == b) && (kCubeEdges[e].corner | 1 << kCubeEdges[e].axis) == (a | b) &&
            (a ^ b) == 1 << kCubeEdges[e].axis)
            return e;
    return kNone;
}

/// Corners of a face in the order in which they are met counter-clockwise seen from outside the cube.
constexpr std::array<int, 4> cornersOfFace(int axis, int side)
{
    const int u = 1 << (axis + 1) % 3, v = 1 << (axis + 2) % 3, base = side << axis;
    return side == 1 ? std::array{base, base | u, base | u | v, base | v} : std::array{base, base | v, base | u | v, base | u};
}

constexpr bool shareFace(int edge, int other)
{
    for (int axis = 0; axis < 3; ++axis) {
        const bool bothLieAcross = kCubeEdges[edge].axis != axis && kCubeEdges[other].axis != axis;
        if (bothLieAcross && (kCubeEdges[edge].corner >> axis & 1) == (kCubeEdges[other].corner >> axis & 1)) return true;
    }
    return false;
}

/// next[e]: the cut edge that follows e on the loop through it, or kNone where e is not cut.
constexpr std::array<int, 12> followers(int inside)
{
    std::array<int, 12> next{};
    next.fill(kNone);
    const auto isInside = [&](int corner) { return (inside >> corner & 1) == 1; };
    for (int face = 0; face < 6; ++face) {
        const std::array<int, 4> q = cornersOfFace(face / 2, face % 2);
        for (int first = 0; first < 4; ++first) {
            if (!isInside(q[first]) || isInside(q[(first + 3) % 4])) continue;  // not where a run of them begins
            int last = first;
            while (isInside(q[(last + 1) % 4])) ++last;
            next[edgeBetween(q[(first + 3) % 4], q[first])] = edgeBetween(q[last % 4], q[(last + 1) % 4]);
        }
    }
    return next;
}

struct Loop {
    int size = 0;
    std::array<int, 12> edges{};
};

/// Cut the part of a loop from place `first` to place `last`, whose chord is there already, into triangles. False, and
/// nothing is added, if that takes a chord in a face.
constexpr bool triangulate(const Loop& loop, int first, int last, CubeCase& out)
{
    if (last - first < 2) return true;
    const auto isAllowed = [&](int a, int b) { return b - a == 1 || !shareFace(loop.edges[a], loop.edges[b]); };
    for (int middle = first + 1; middle < last; ++middle) {
        if (!isAllowed(first, middle) || !isAllowed(middle, last)) continue;
        const std::uint8_t before = out.count;
        if (triangulate(loop, first, middle, out) && triangulate(loop, middle, last, out)) {
            out.triangles[out.count++] = {static_cast<std::uint8_t>(loop.edges[first]), static_cast<std::uint8_t>(loop.edges[middle]),
                                          static_cast<std::uint8_t>(loop.edges[last])};
            return true;
        }
        out.count = before;
    }
    return false;
}

constexpr CubeCase makeCase(int inside)
{
    CubeCase out;
    std::array<int, 12> next = followers(inside);
    for (int start = 0; start < 12; ++start) {
        Loop loop;
        for (int e = start; next[e] != kNone;) {
            loop.edges[loop.size++] = e;
            const int following = next[e];
            next[e] = kNone;
            e = following;
        }
        if (!triangulate(loop, 0, loop.size - 1, out)) throw "a loop that only chords in faces can cut";
    }
    return out;
}

constexpr std::array<CubeCase, 256> kCases = [] {
    std::array<CubeCase, 256> cases;
    for (int inside = 0; inside < 256; ++inside) cases[inside] = makeCase(inside);
    return cases;
}();

}  // namespace

const std::array<CubeCase, 256>& cubeCases() { return kCases; }

}  // namespace sim
