#include "sim/shapes/triangle_tree.h"

#include "sim/core/units.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace sim {

namespace {

constexpr int kLeafTriangles = 4;
constexpr int kMostDepth = 64;  ///< depth of a tree of halves with 2^31 triangles, and some more
constexpr double kFar = 2.0;    ///< a group of triangles acts as one at this many radii

Vec3 areaVector(const std::array<Vec3, 3>& t) { return 0.5 * (t[1] - t[0]).cross(t[2] - t[0]); }

/// Thinner triangles are lines, for which rounding would decide where they face.
bool hasArea(const std::array<Vec3, 3>& t)
{
    const double edge = std::max({(t[1] - t[0]).squaredNorm(), (t[2] - t[1]).squaredNorm(), (t[0] - t[2]).squaredNorm()});
    return areaVector(t).norm() > 1.0e-12 * edge;
}

double squaredDistanceToSegment(const Vec3& x, const Vec3& a, const Vec3& b)
{
    const Vec3 along = b - a;
    const double s = std::clamp((x - a).dot(along) / along.squaredNorm(), 0.0, 1.0);
    return (x - a - s * along).squaredNorm();
}

double squaredDistance(const Vec3& x, const std::array<Vec3, 3>& t)
{
    const Vec3 n = (t[1] - t[0]).cross(t[2] - t[0]);
    bool above = true;  // the triangle itself, not beyond one of its edges
    for (int c = 0; c < 3 && above; ++c) above = n.cross(t[(c + 1) % 3] - t[c]).dot(x - t[c]) >= 0.0;
    if (above) return std::pow(n.dot(x - t[0]), 2) / n.squaredNorm();
    return std::min({squaredDistanceToSegment(x, t[0], t[1]), squaredDistanceToSegment(x, t[1], t[2]), squaredDistanceToSegment(x, t[2], t[0])});
}

/// Solid angle of a triangle seen from x, positive from behind. Source: Van Oosterom and Strackee 1983.
double solidAngle(const Vec3& x, const std::array<Vec3, 3>& t)
{
    const Vec3 a = t[0] - x, b = t[1] - x, c = t[2] - x;
    const double la = a.norm(), lb = b.norm(), lc = c.norm();
    return 2.0 * std::atan2(a.dot(b.cross(c)), la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb);
}

}  // namespace

TriangleTree::TriangleTree(const TriangleMesh& mesh)
{
    for (const Vec3i& t : mesh.triangles) {
        const Corners corners = {mesh.vertices[t[0]], mesh.vertices[t[1]], mesh.vertices[t[2]]};
        if (hasArea(corners)) corners_.push_back(corners);
    }
    if (!corners_.empty()) build(0, static_cast<int>(corners_.size()));
}

int TriangleTree::build(int first, int last)
{
    Node node;
    node.first = first;
    node.last = last;
    double area = 0.0;
    for (int i = first; i < last; ++i) {
        for (const Vec3& corner : corners_[i]) node.box.extend(corner);
        const Vec3 vector = areaVector(corners_[i]);
        node.areaNormal += vector;
        node.middle += vector.norm() * (corners_[i][0] + corners_[i][1] + corners_[i][2]) / 3.0;
        area += vector.norm();
    }
    node.middle /= area;
    for (int i = first; i < last; ++i)
        for (const Vec3& corner : corners_[i]) node.radius = std::max(node.radius, (corner - node.middle).norm());
    const int number = static_cast<int>(nodes_.size());
    nodes_.push_back(node);
    if (last - first <= kLeafTriangles) return number;

    Eigen::Index axis;
    node.box.sizes().maxCoeff(&axis);
    const int middle = first + (last - first) / 2;
    std::nth_element(corners_.begin() + first, corners_.begin() + middle, corners_.begin() + last, [axis](const Corners& a, const Corners& b) {
        return a[0][axis] + a[1][axis] + a[2][axis] < b[0][axis] + b[1][axis] + b[2][axis];
    });
    build(first, middle);
    const int right = build(middle, last);
    nodes_[number].right = right;
    return number;
}

TriangleTree::Nearest TriangleTree::nearest(const Vec3& x, int guess) const
{
    double best = squaredDistance(x, corners_[guess]);
    struct Waiting {
        double squaredDistance;
        int node;
    };
    std::array<Waiting, kMostDepth> waiting;
    int count = 0;
    waiting[count++] = {0.0, 0};
    while (count > 0) {
        const Waiting next = waiting[--count];
        if (next.squaredDistance >= best) continue;
        const Node& node = nodes_[next.node];
        if (node.right == 0) {
            for (int i = node.first; i < node.last; ++i)
                if (const double d = squaredDistance(x, corners_[i]); d < best) best = d, guess = i;
            continue;
        }
        // The nearer child is looked at first: it leaves less to do in the other.
        Waiting near = {nodes_[next.node + 1].box.squaredExteriorDistance(x), next.node + 1};
        Waiting far = {nodes_[node.right].box.squaredExteriorDistance(x), node.right};
        if (far.squaredDistance < near.squaredDistance) std::swap(near, far);
        if (far.squaredDistance < best) waiting[count++] = far;
        if (near.squaredDistance < best) waiting[count++] = near;
    }
    return {std::sqrt(best), guess};
}

double TriangleTree::windingNumber(const Vec3& x) const
{
    double angle = 0.0;
    std::array<int, kMostDepth> waiting;
    int count = 0;
    waiting[count++] = 0;
    while (count > 0) {
        const int number = waiting[--count];
        const Node& node = nodes_[number];
        const Vec3 way = node.middle - x;
        const double length = way.norm();
        if (length > kFar * node.radius) {
            angle += node.areaNormal.dot(way) / (length * length * length);
        } else if (node.right == 0) {
            for (int i = node.first; i < node.last; ++i) angle += solidAngle(x, corners_[i]);
        } else {
            waiting[count++] = node.right;
            waiting[count++] = number + 1;
        }
    }
    return angle / (4.0 * kPi);
}

double TriangleTree::signedVolume() const
{
    double volume = 0.0;
    const Vec3 from = nodes_.front().middle;
    for (const Corners& t : corners_) volume += (t[0] - from).dot((t[1] - from).cross(t[2] - from)) / 6.0;
    return volume;
}

}  // namespace sim
