#pragma once

#include "sim/fabric/fabric.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <span>
#include <stdexcept>
#include <string>
#include <unordered_map>
#include <vector>

// Has fabric passed through itself? An independent look at positions alone: nothing of the solver's contact is used.

namespace sim::test {

/// Closest points of the segments a0-a1 and b0-b1, as parameters in [0, 1] (Ericson 2005, 5.1.9).
struct SegmentPair {
    double s = 0.0, t = 0.0, distance = 0.0;
};
inline SegmentPair closestOfSegments(const Vec3& a0, const Vec3& a1, const Vec3& b0, const Vec3& b1)
{
    const Vec3 d1 = a1 - a0, d2 = b1 - b0, r = a0 - b0;
    const double a = d1.squaredNorm(), e = d2.squaredNorm(), f = d2.dot(r), b = d1.dot(d2), c = d1.dot(r), denominator = a * e - b * b;
    SegmentPair p;
    p.s = denominator > 1.0e-12 * a * e ? std::clamp((b * f - c * e) / denominator, 0.0, 1.0) : 0.0;
    p.t = (b * p.s + f) / e;
    if (p.t < 0.0 || p.t > 1.0) {
        p.t = std::clamp(p.t, 0.0, 1.0);
        p.s = std::clamp((b * p.t - c) / a, 0.0, 1.0);
    }
    p.distance = (a0 + p.s * d1 - b0 - p.t * d2).norm();
    return p;
}

inline constexpr int kLargestBox = 50;  ///< cells

/// Boxes of elements in a hash grid: body(i, j), i < j, for every two whose boxes, grown by half of `reach`, overlap.
/// `cell` should be about the size of an element. Throws std::runtime_error for a box of more than kLargestBox cells.
template <class Box, class Body>
void forEachNearPair(int count, double cell, double reach, Box&& box, Body&& body)
{
    const auto key = [](int i, int j, int k) {
        return (std::uint64_t(i + (1 << 20)) << 42) ^ (std::uint64_t(j + (1 << 20)) << 21) ^ std::uint64_t(k + (1 << 20));
    };
    std::unordered_map<std::uint64_t, std::vector<int>> cells;
    std::vector<int> seen(count, -1);
    for (int j = 0; j < count; ++j) {
        const auto [low, high] = box(j);
        if (!((high - low).maxCoeff() < kLargestBox * cell))
            throw std::runtime_error("fabric has burst: an element reaches across " + std::to_string(kLargestBox) + " of its length");
        std::array<int, 3> from, to;
        for (int a = 0; a < 3; ++a) {
            from[a] = static_cast<int>(std::floor((low[a] - 0.5 * reach) / cell));
            to[a] = static_cast<int>(std::floor((high[a] + 0.5 * reach) / cell));
        }
        for (int x = from[0]; x <= to[0]; ++x)
            for (int y = from[1]; y <= to[1]; ++y)
                for (int z = from[2]; z <= to[2]; ++z) {
                    std::vector<int>& here = cells[key(x, y, z)];
                    for (int i : here) {
                        if (seen[i] == j) continue;
                        seen[i] = j;
                        body(i, j);
                    }
                    here.push_back(j);
                }
    }
}

/// Places where a yarn passes over another at rest, and which of the two is above.
class Crossings {
 public:
    /// @param up  across the fabric at rest
    Crossings(const Fabric& fabric, const Vec3& up) : fabric_(fabric)
    {
        const double reach = 3.0 * largestRadius();
        forEachEdgePair(fabric.rest, reach, [&](int i, int j) {
            if (joined(i, j)) return;
            // Where their shadows on the middle plane cut each other.
            const auto flat = [&](int v) -> Vec3 { return fabric.rest[v] - up.dot(fabric.rest[v]) * up; };
            const Vec2i &a = fabric.edges.vertices[i], &b = fabric.edges.vertices[j];
            const SegmentPair p = closestOfSegments(flat(a[0]), flat(a[1]), flat(b[0]), flat(b[1]));
            if (p.distance > 1.0e-9) return;
            // Once only where the shadows meet in vertices of both.
            if (p.s > 1.0 - 1.0e-9 || p.t > 1.0 - 1.0e-9) return;
            all_.push_back({i, j, sideOf(i, j, p, fabric.rest), false});
        });
    }

    struct Count {
        int flipped = 0;    ///< the yarn above has come below
        int undecided = 0;  ///< the yarns run nearly alongside each other there: no sign
    };
    /// Over and under at every crossing: within a few edges of where it was, where the two yarns come nearest, by the
    /// sign of their distance along the normal of both. Yarns that turn past each other while they run alongside change that sign without
    /// crossing: it is taken anew after a look at which they did (nearness tells whether they came through each other meanwhile).
    Count count(std::span<const Vec3> x)
    {
        Count n;
        for (Crossing& c : all_) {
            double nearest = std::numeric_limits<double>::infinity(), side = 0.0, sine = 1.0;
            constexpr int kAround = 3;  // edges that a crossing may slip along
            for (int i = around(c.first, -kAround); i <= around(c.first, kAround); ++i)
                for (int j = around(c.second, -kAround); j <= around(c.second, kAround); ++j) {
                    const Vec2i &a = fabric_.edges.vertices[i], &b = fabric_.edges.vertices[j];
                    const SegmentPair p = closestOfSegments(x[a[0]], x[a[1]], x[b[0]], x[b[1]]);
                    if (p.distance >= nearest) continue;
                    nearest = p.distance;
                    side = sideOf(i, j, p, x);
                    sine = sineBetween(i, j, x);
                }
            if (std::abs(side) < kUndecided) {
                ++n.undecided;
                c.ranAlongside = c.ranAlongside || sine < kUndecided;
                continue;
            }
            if (c.ranAlongside) c.side = side, c.ranAlongside = false;
            if (side * c.side < 0.0) ++n.flipped;
        }
        return n;
    }
    std::size_t size() const { return all_.size(); }

    /// The least of d − allowed over all pairs of yarn edges that are no neighbours (fabric/contact/README.md, Pairs): allowed is half
    /// the thickness, or 0.6 of the distance at rest for pairs that are nearer then [cm]. The smallest d / (r_A + r_B)
    /// too.
    struct Nearness {
        double spare = std::numeric_limits<double>::infinity(), relative = std::numeric_limits<double>::infinity();
    };
    Nearness nearness(std::span<const Vec3> x) const
    {
        Nearness least;
        forEachEdgePair(x, 2.0 * largestRadius(), [&](int i, int j) {
            if (joined(i, j)) return;
            const Vec2i &a = fabric_.edges.vertices[i], &b = fabric_.edges.vertices[j];
            const double d = closestOfSegments(x[a[0]], x[a[1]], x[b[0]], x[b[1]]).distance;
            const double touching = fabric_.radius[a[0]] + fabric_.radius[b[0]];
            if (d > touching) return;
            const std::vector<Vec3>& rest = fabric_.rest;
            const double atRest = closestOfSegments(rest[a[0]], rest[a[1]], rest[b[0]], rest[b[1]]).distance;
            least.spare = std::min(least.spare, d - std::min(0.5 * touching, 0.6 * atRest));
            least.relative = std::min(least.relative, d / touching);
        });
        return least;
    }

 private:
    struct Crossing {
        int first, second;  ///< yarn edges
        double side;
        bool ranAlongside;  ///< since the side was last seen
    };
    static constexpr double kUndecided = 0.1;  ///< sine of the angle between yarns below which over and under mean nothing [-]

    double largestRadius() const { return *std::ranges::max_element(fabric_.radius); }
    /// The edge some way along the same yarn, or its end.
    int around(int edge, int by) const
    {
        const int s = fabric_.edges.strand[edge], begin = fabric_.strands.edgeBegin(s);
        return std::clamp(edge + by, begin, begin + fabric_.strands.size(s) - 2);
    }
    /// They share a vertex, or are neighbours on one yarn.
    bool joined(int i, int j) const
    {
        if (fabric_.edges.strand[i] == fabric_.edges.strand[j] && std::abs(i - j) <= 2) return true;
        const Vec2i &a = fabric_.edges.vertices[i], &b = fabric_.edges.vertices[j];
        return a[0] == b[0] || a[0] == b[1] || a[1] == b[0] || a[1] == b[1];
    }
    double sineBetween(int i, int j, std::span<const Vec3> x) const
    {
        const Vec2i &a = fabric_.edges.vertices[i], &b = fabric_.edges.vertices[j];
        const Vec3 da = x[a[1]] - x[a[0]], db = x[b[1]] - x[b[0]];
        return da.cross(db).norm() / (da.norm() * db.norm());
    }
    /// Distance of the first above the second along the normal of both directions, in parts of their distance and times
    /// the sine between them: small where they are parallel.
    double sideOf(int i, int j, const SegmentPair& p, std::span<const Vec3> x) const
    {
        const Vec2i &a = fabric_.edges.vertices[i], &b = fabric_.edges.vertices[j];
        const Vec3 da = x[a[1]] - x[a[0]], db = x[b[1]] - x[b[0]];
        const Vec3 apart = x[a[0]] + p.s * da - x[b[0]] - p.t * db, normal = da.cross(db) / (da.norm() * db.norm());
        return normal.dot(apart) / std::max(apart.norm(), 1.0e-300);
    }
    template <class Body>
    void forEachEdgePair(std::span<const Vec3> x, double reach, Body&& body) const
    {
        double longest = 0.0;
        for (double l : fabric_.edges.restLength) longest = std::max(longest, l);
        const auto box = [&](int e) {
            const Vec3 &a = x[fabric_.edges.vertices[e][0]], &b = x[fabric_.edges.vertices[e][1]];
            return std::pair<Vec3, Vec3>(a.cwiseMin(b), a.cwiseMax(b));
        };
        forEachNearPair(static_cast<int>(fabric_.edges.size()), longest, reach, box, body);
    }

    const Fabric& fabric_;
    std::vector<Crossing> all_;
};

/// Edges of cloth that pierce faces of cloth with which they share no vertex.
inline int piercedFaces(const Fabric& fabric, std::span<const Vec3> x)
{
    const int faces = static_cast<int>(fabric.faces.size());
    double size = 0.0;
    for (const Vec3i& f : fabric.faces.vertices) size = std::max(size, (fabric.rest[f[1]] - fabric.rest[f[0]]).norm());
    const double roundOff = 1.0e-10 * size * size * size;  // of held faces, which lie in one plane
    const auto corner = [&](int f, int k) -> const Vec3& { return x[fabric.faces.vertices[f][k % 3]]; };
    const auto box = [&](int f) {
        return std::pair<Vec3, Vec3>(corner(f, 0).cwiseMin(corner(f, 1)).cwiseMin(corner(f, 2)),
                                     corner(f, 0).cwiseMax(corner(f, 1)).cwiseMax(corner(f, 2)));
    };
    const auto volume = [](const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) { return (b - a).cross(c - a).dot(d - a); };
    const auto pierces = [&](const Vec3& p, const Vec3& q, int f) {
        const Vec3 &a = corner(f, 0), &b = corner(f, 1), &c = corner(f, 2);
        const double above = volume(a, b, c, p), below = volume(a, b, c, q);
        if (above * below >= 0.0 || std::min(std::abs(above), std::abs(below)) < roundOff) return false;
        const double u = volume(p, q, a, b), v = volume(p, q, b, c), w = volume(p, q, c, a);
        return (u > 0.0 && v > 0.0 && w > 0.0) || (u < 0.0 && v < 0.0 && w < 0.0);
    };
    int count = 0;
    forEachNearPair(faces, size, 0.0, box, [&](int f, int g) {
        for (const auto& [edgesOf, other] : {std::pair(f, g), std::pair(g, f)})
            for (int k = 0; k < 3; ++k) {
                const int v = fabric.faces.vertices[edgesOf][k], w = fabric.faces.vertices[edgesOf][(k + 1) % 3];
                const Vec3i& t = fabric.faces.vertices[other];
                if ((t.array() == v).any() || (t.array() == w).any()) continue;
                count += pierces(x[v], x[w], other);
            }
    });
    return count;
}

}  // namespace sim::test
