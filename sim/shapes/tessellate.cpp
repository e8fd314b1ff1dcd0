#include "sim/shapes/tessellate.h"

#include "sim/core/check.h"
#include "sim/core/parallel.h"
#include "sim/core/units.h"

#include <array>
#include <cmath>
#include <unordered_map>

namespace sim {

namespace {

TriangleMesh boxMesh(const Eigen::AlignedBox3d& box)
{
    TriangleMesh mesh;
    for (int corner = 0; corner < 8; ++corner) mesh.vertices.push_back(box.corner(static_cast<Eigen::AlignedBox3d::CornerType>(corner)));
    for (int axis = 0; axis < kAxes; ++axis) {
        const int u = 1 << (axis + 1) % 3, v = 1 << (axis + 2) % 3, w = 1 << axis;
        mesh.triangles.emplace_back(0, u + v, u);
        mesh.triangles.emplace_back(0, v, u + v);
        mesh.triangles.emplace_back(w, w + u, w + u + v);
        mesh.triangles.emplace_back(w, w + u + v, w + v);
    }
    return mesh;
}

/// A box with round edges: the nodes of a cubical lattice's surface, taken as directions, each put on the eighth of a ball in its corner.
/// The two middle nodes of each edge stand almost together in direction, but as far apart as the flat sides are long.
TriangleMesh roundedBoxMesh(const Shape::AxisBox& shape)
{
    constexpr int kNodes = 10;
    constexpr double kHalfGap = 1.0e-3, kQuarter = 0.25 * kPi;
    const auto tangent = [](int n) {
        const int fromMiddle = n >= kNodes / 2 ? n - kNodes / 2 : kNodes / 2 - 1 - n;
        const double angle = kHalfGap + (kQuarter - kHalfGap) * fromMiddle / (kNodes / 2 - 1);
        return n >= kNodes / 2 ? std::tan(angle) : -std::tan(angle);
    };
    const Vec3 center = shape.box.center(), core = 0.5 * shape.box.sizes() - Vec3::Constant(shape.round);
    TriangleMesh mesh;
    std::array<int, kNodes * kNodes * kNodes> number;
    number.fill(-1);
    const auto vertex = [&](const Vec3i& node) {
        int& n = number[(node.z() * kNodes + node.y()) * kNodes + node.x()];
        if (n >= 0) return n;
        const Vec3 direction = Vec3(tangent(node.x()), tangent(node.y()), tangent(node.z())).normalized();
        mesh.vertices.push_back(center + core.cwiseProduct(direction.cwiseSign()) + shape.round * direction);
        return n = static_cast<int>(mesh.vertices.size()) - 1;
    };
    for (int axis = 0; axis < kAxes; ++axis)
        for (int side = 0; side < 2; ++side)
            for (int v = 0; v + 1 < kNodes; ++v)
                for (int u = 0; u + 1 < kNodes; ++u) {
                    const auto corner = [&](int du, int dv) {
                        Vec3i node;
                        node[axis] = side * (kNodes - 1);
                        node[(axis + 1) % 3] = u + du;
                        node[(axis + 2) % 3] = v + dv;
                        return vertex(node);
                    };
                    const int a = corner(0, 0), b = corner(1, 0), c = corner(1, 1), d = corner(0, 1);
                    mesh.triangles.push_back(side ? Vec3i(a, b, c) : Vec3i(a, c, b));
                    mesh.triangles.push_back(side ? Vec3i(a, c, d) : Vec3i(a, d, c));
                }
    return mesh;
}

/// Marches through the tetrahedra of a lattice: each cube is cut into the six that share its diagonal, so that the cuts
/// of neighbouring cubes match and the mesh is closed.
class Marcher {
 public:
    Marcher(const Shape& shape, double cell) : shape_(shape), cell_(cell)
    {
        const Eigen::AlignedBox3d box = shape.bounds();
        const Vec3 cells = (box.sizes() / cell).array().ceil() + 2.0;
        constexpr double kMostCells = 2.0e8;
        if (!(cells.prod() <= kMostCells)) throw InputError("a shape is unbounded or too large to be drawn with such cells");
        for (int a = 0; a < kAxes; ++a) nodes_[a] = static_cast<std::size_t>(cells[a]) + 1;
        lower_ = box.center() - 0.5 * cell * cells;
    }

    TriangleMesh march()
    {
        sample();
        for (std::size_t k = 0; k + 1 < nodes_[2]; ++k)
            for (std::size_t j = 0; j + 1 < nodes_[1]; ++j)
                for (std::size_t i = 0; i + 1 < nodes_[0]; ++i) marchCube((k * nodes_[1] + j) * nodes_[0] + i);
        return std::move(mesh_);
    }

 private:
    Vec3 position(std::size_t node) const
    {
        const std::size_t row = node / nodes_[0];
        return lower_ +
               cell_ * Vec3(static_cast<double>(node % nodes_[0]), static_cast<double>(row % nodes_[1]), static_cast<double>(row / nodes_[1]));
    }

    void sample()
    {
        // No node lies on the surface itself: triangles keep an area.
        const double least = 1.0e-3 * cell_;
        values_.resize(nodes_[0] * nodes_[1] * nodes_[2]);
        parallelFor(nodes_[1] * nodes_[2], [&](std::size_t row) {
            for (std::size_t n = row * nodes_[0]; n < (row + 1) * nodes_[0]; ++n) {
                const double d = shape_.distance(position(n));
                values_[n] = std::abs(d) < least ? least : d;
            }
        });
    }

    std::size_t offset(int corner) const { return ((corner >> 2) * nodes_[1] + (corner >> 1 & 1)) * nodes_[0] + (corner & 1); }

    void marchCube(std::size_t base)
    {
        int insideCount = 0;
        for (int corner = 0; corner < 8; ++corner) insideCount += values_[base + offset(corner)] < 0.0;
        if (insideCount == 0 || insideCount == 8) return;
        // Ways from corner 0 to corner 7, one axis at a time; every other way turns left.
        constexpr std::array<std::array<int, 2>, 6> kWays = {{{1, 3}, {2, 3}, {2, 6}, {4, 6}, {4, 5}, {1, 5}}};
        for (int w = 0; w < 6; ++w) {
            std::array<std::size_t, 4> t = {base, base + offset(kWays[w][0]), base + offset(kWays[w][1]), base + offset(7)};
            if (w % 2 == 1) std::swap(t[1], t[2]);
            marchTetrahedron(t);
        }
    }

    /// Corners are given so that (t1 − t0) · (t2 − t0) × (t3 − t0) > 0.
    void marchTetrahedron(std::array<std::size_t, 4> t)
    {
        // Inside corners to the front; every swap mirrors the tetrahedron.
        bool mirrored = false;
        int inside = 0;
        for (int c = 0; c < 4; ++c)
            if (values_[t[c]] < 0.0) {
                if (c != inside) std::swap(t[c], t[inside]), mirrored = !mirrored;
                ++inside;
            }
        if (inside == 1) {
            addTriangle(crossing(t[0], t[1]), crossing(t[0], t[2]), crossing(t[0], t[3]), mirrored);
        } else if (inside == 2) {
            const int a = crossing(t[0], t[2]), b = crossing(t[0], t[3]), c = crossing(t[1], t[3]), d = crossing(t[1], t[2]);
            addTriangle(a, b, c, mirrored);
            addTriangle(a, c, d, mirrored);
        } else if (inside == 3) {
            addTriangle(crossing(t[3], t[0]), crossing(t[3], t[1]), crossing(t[3], t[2]), mirrored);
        }
    }

    void addTriangle(int a, int b, int c, bool mirrored) { mesh_.triangles.push_back(mirrored ? Vec3i(a, c, b) : Vec3i(a, b, c)); }

    /// Number of the vertex on an edge of the lattice.
    int crossing(std::size_t a, std::size_t b)
    {
        if (a > b) std::swap(a, b);
        const auto [entry, isNew] = crossings_.try_emplace(a * kEdgeKinds + edgeKind(b - a), static_cast<int>(mesh_.vertices.size()));
        if (isNew) {
            const double t = values_[a] / (values_[a] - values_[b]);
            mesh_.vertices.push_back((1.0 - t) * position(a) + t * position(b));
        }
        return entry->second;
    }
    std::size_t edgeKind(std::size_t difference) const
    {
        std::size_t kind = 1;
        while (offset(static_cast<int>(kind)) != difference) ++kind;
        return kind;
    }

    static constexpr std::size_t kEdgeKinds = 8;
    const Shape& shape_;
    double cell_;
    Vec3 lower_;
    std::array<std::size_t, 3> nodes_{};
    std::vector<double> values_;
    std::unordered_map<std::size_t, int> crossings_;  ///< vertex on each edge that crosses the surface
    TriangleMesh mesh_;
};

}  // namespace

TriangleMesh tessellate(const Shape& shape, double cell)
{
    if (!(cell > 0.0)) throw InputError("cells to draw a shape with must be larger than 0");
    if (shape.bounds().isEmpty()) return {};
    if (shape.isInverted()) throw InputError("an unbounded shape cannot be drawn");
    if (const auto box = shape.axisBox()) return box->round > 0.0 ? roundedBoxMesh(*box) : boxMesh(box->box);
    return Marcher(shape, cell).march();
}

}  // namespace sim
