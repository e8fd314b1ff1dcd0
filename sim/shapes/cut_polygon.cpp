#include "sim/shapes/cut_polygon.h"

namespace sim {

namespace {

/// Twice its area vector, by Newell's sum.
Vec3 areaVector(const std::vector<Vec3>& vertices, std::span<const int> corners)
{
    Vec3 sum = Vec3::Zero();
    for (std::size_t n = 1; n + 1 < corners.size(); ++n)
        sum += (vertices[corners[n]] - vertices[corners[0]]).cross(vertices[corners[n + 1]] - vertices[corners[0]]);
    return sum;
}

/// Turn of a triangle seen against the normal: positive where it turns left.
double turn(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& normal) { return (b - a).cross(c - a).dot(normal); }

bool isConvexFan(const std::vector<Vec3>& vertices, std::span<const int> corners, const Vec3& normal)
{
    const std::size_t count = corners.size();
    for (std::size_t n = 0; n < count; ++n)
        if (turn(vertices[corners[n]], vertices[corners[(n + 1) % count]], vertices[corners[(n + 2) % count]], normal) < 0.0) return false;
    return true;
}

bool isEar(const std::vector<Vec3>& vertices, const std::vector<int>& left, std::size_t n, const Vec3& normal)
{
    const std::size_t count = left.size();
    const int ia = left[(n + count - 1) % count], ib = left[n], ic = left[(n + 1) % count];
    const Vec3 &a = vertices[ia], &b = vertices[ib], &c = vertices[ic];
    if (!(turn(a, b, c, normal) > 0.0)) return false;
    for (const int other : left) {
        if (other == ia || other == ib || other == ic) continue;
        const Vec3& x = vertices[other];
        if (turn(a, b, x, normal) >= 0.0 && turn(b, c, x, normal) >= 0.0 && turn(c, a, x, normal) >= 0.0) return false;
    }
    return true;
}

}  // namespace

void cutPolygon(const std::vector<Vec3>& vertices, std::span<const int> corners, std::vector<Vec3i>& triangles)
{
    const Vec3 normal = areaVector(vertices, corners);
    if (isConvexFan(vertices, corners, normal)) {
        for (std::size_t n = 1; n + 1 < corners.size(); ++n) triangles.emplace_back(corners[0], corners[n], corners[n + 1]);
        return;
    }
    std::vector<int> left(corners.begin(), corners.end());
    while (left.size() > 3) {
        std::size_t n = 0;
        while (n < left.size() && !isEar(vertices, left, n, normal)) ++n;
        n %= left.size();  // a polygon that crosses itself has none: its corners go in their order
        triangles.emplace_back(left[(n + left.size() - 1) % left.size()], left[n], left[(n + 1) % left.size()]);
        left.erase(left.begin() + static_cast<std::ptrdiff_t>(n));
    }
    triangles.emplace_back(left[0], left[1], left[2]);
}

}  // namespace sim
