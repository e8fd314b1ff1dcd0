#include "sim/core/aligned_array.h"
#include "sim/core/check.h"
#include "sim/core/parallel.h"
#include "sim/shapes/body.h"
#include "sim/shapes/mend_solid.h"
#include "sim/shapes/triangle_tree.h"

#include <array>
#include <cmath>

namespace sim {

namespace {

constexpr int kPadCells = 3;
constexpr double kSteepest = 2.0;     ///< slope of its distance: along each axis at most 1 on the lattice, and 1 outside of it [-]
constexpr double kMostNodes = 5.0e8;  ///< 2 GB of distances

/// Distances on a lattice, trilinear in between.
struct SampledBody final : Shape::Body {
    Vec3 lower;  ///< first node
    double cell = 0.0;
    std::array<std::size_t, 3> size;  ///< nodes
    AlignedArray<float> values;
    Eigen::AlignedBox3d body;  ///< bounds of the mesh itself

    Eigen::AlignedBox3d lattice() const
    {
        const Vec3 reach(static_cast<double>(size[0] - 1), static_cast<double>(size[1] - 1), static_cast<double>(size[2] - 1));
        return {lower, lower + cell * reach};
    }

    /// The eight values around a point of the lattice, and how far between them it is, 0..1.
    struct Corner {
        const float* v;
        Vec3 t;
    };
    Corner cornerAt(const Vec3& x) const
    {
        Corner c;
        std::size_t index[3];
        for (int a = 0; a < kAxes; ++a) {
            // In this order, what is not a number becomes 0, not an index.
            const double q = std::max(0.0, std::min((x[a] - lower[a]) / cell, static_cast<double>(size[a] - 1)));
            index[a] = std::min(static_cast<std::size_t>(q), size[a] - 2);
            c.t[a] = q - static_cast<double>(index[a]);
        }
        c.v = values.data() + (index[2] * size[1] + index[1]) * size[0] + index[0];
        return c;
    }
    double between(const Corner& c, int weightAxis) const
    {
        // The trilinear value, or its slope along weightAxis in units of the cell.
        double sum = 0.0;
        for (int corner = 0; corner < 8; ++corner) {
            double w = 1.0;
            for (int a = 0; a < kAxes; ++a) {
                const bool far = corner >> a & 1;
                w *= a == weightAxis ? (far ? 1.0 : -1.0) : (far ? c.t[a] : 1.0 - c.t[a]);
            }
            const std::size_t offset = ((corner >> 2) * size[1] + (corner >> 1 & 1)) * size[0] + (corner & 1);
            sum += w * static_cast<double>(c.v[offset]);
        }
        return sum;
    }

    double distance(const Vec3& x) const override
    {
        const Eigen::AlignedBox3d box = lattice();
        const double inside = between(cornerAt(x), -1);
        return box.contains(x) ? inside : inside + box.exteriorDistance(x);
    }
    /// A coordinate on the lattice: between node `index` and the next.
    struct Cut {
        double x;  ///< [cm]
        std::size_t index;
        double t;  ///< share of the way between them [0..1]
    };
    /// Both ends of a range within the lattice, and the nodes between them.
    /// @return how many
    int cutAlong(int axis, double first, double last, Cut* cuts) const
    {
        int count = 0;
        const auto add = [&](double x, double q) {
            const std::size_t index = std::min(static_cast<std::size_t>(std::max(0.0, q)), size[axis] - 2);
            cuts[count++] = {x, index, q - static_cast<double>(index)};
        };
        const double begin = (first - lower[axis]) / cell, end = (last - lower[axis]) / cell;
        add(first, begin);
        for (double node = std::floor(begin) + 1.0; node < end; node += 1.0) add(lower[axis] + cell * node, node);
        add(last, end);
        return count;
    }
    double valueAt(const Cut& x, const Cut& y, const Cut& z) const
    {
        const float* v = values.data() + (z.index * size[1] + y.index) * size[0] + x.index;
        const std::size_t up = size[0], far = size[0] * size[1];
        const auto along = [&](const float* p) { return (1.0 - x.t) * static_cast<double>(p[0]) + x.t * static_cast<double>(p[1]); };
        const double near = (1.0 - y.t) * along(v) + y.t * along(v + up);
        return (1.0 - z.t) * near + z.t * ((1.0 - y.t) * along(v + far) + y.t * along(v + far + up));
    }
    /// How far the distance is off the plane through its value and slope in the middle. Between the nodes both are linear along each axis, so
    /// that in a box within a cell it is nowhere further off than at the box's corners: those of the hull's box, cut by the lattice.
    /// Hulls over many cells are left to the steepest slope there is.
    struct Straying {
        double at, down, up, below, above;  ///< [cm]: in the middle, by the plane's slope, by what is off it
    };
    Straying straying(std::span<const Vec3> corners) const
    {
        constexpr int kMostCells = 3;
        const Vec3 middle = meanOf(corners);
        const double at = distance(middle);
        Eigen::AlignedBox3d hull;
        double radius = 0.0;
        for (const Vec3& x : corners) hull.extend(x), radius = std::max(radius, (x - middle).norm());
        const Straying steep{at, -kSteepest * radius, kSteepest * radius, 0.0, 0.0};
        if (!lattice().contains(hull) || (hull.sizes().array() > kMostCells * cell).any()) return steep;
        const Corner corner = cornerAt(middle);
        const Vec3 slope = Vec3(between(corner, 0), between(corner, 1), between(corner, 2)) / cell;
        Straying s{at, 0.0, 0.0, 0.0, 0.0};
        for (const Vec3& x : corners) {
            s.down = std::min(s.down, slope.dot(x - middle));
            s.up = std::max(s.up, slope.dot(x - middle));
        }
        std::array<std::array<Cut, kMostCells + 3>, kAxes> cuts;
        std::array<int, kAxes> count;
        for (int a = 0; a < kAxes; ++a) count[a] = cutAlong(a, hull.min()[a], hull.max()[a], cuts[a].data());
        for (int k = 0; k < count[2]; ++k)
            for (int j = 0; j < count[1]; ++j) {
                const double onRow = at + slope.y() * (cuts[1][j].x - middle.y()) + slope.z() * (cuts[2][k].x - middle.z());
                for (int i = 0; i < count[0]; ++i) {
                    const double off = valueAt(cuts[0][i], cuts[1][j], cuts[2][k]) - onRow - slope.x() * (cuts[0][i].x - middle.x());
                    s.below = std::min(s.below, off);
                    s.above = std::max(s.above, off);
                }
            }
        return s;
    }
    double steepest() const override { return kSteepest; }
    Shape::Look over(std::span<const Vec3> corners, double) const override
    {
        const Straying s = straying(corners);
        return {s.at + s.down + s.below, s.at};
    }
    double mostOver(std::span<const Vec3> corners) const override
    {
        const Straying s = straying(corners);
        return s.at + s.up + s.above;
    }
    Vec3 normal(const Vec3& x) const override
    {
        const Eigen::AlignedBox3d box = lattice();
        const Corner corner = cornerAt(x);
        Vec3 slope(between(corner, 0), between(corner, 1), between(corner, 2));
        slope /= cell;
        if (!box.contains(x)) {
            const Vec3 away = x - x.cwiseMax(box.min()).cwiseMin(box.max());
            for (int a = 0; a < kAxes; ++a)
                if (away[a] != 0.0) slope[a] = 0.0;  // the value there does not change along these
            slope += away.stableNormalized();
        }
        return slope.squaredNorm() > 0.0 ? Vec3(slope.stableNormalized()) : Vec3(Vec3::UnitX());
    }
    Eigen::AlignedBox3d bounds(const Eigen::Isometry3d& t) const override { return movedBounds(body, t); }
};

void requireSound(const TriangleMesh& mesh, double cell)
{
    if (!(cell > 0.0) || !std::isfinite(cell)) throw InputError("a mesh's cell must be a positive number");
    for (const Vec3& v : mesh.vertices)
        if (!v.allFinite()) throw InputError("a mesh has a vertex whose coordinates are not finite");
    for (const Vec3i& t : mesh.triangles)
        if (t.minCoeff() < 0 || t.maxCoeff() >= static_cast<int>(mesh.vertices.size()))
            throw InputError("a mesh has a triangle with a corner that does not exist");
}

/// Room for the lattice around the mesh; nothing is sampled yet.
std::shared_ptr<SampledBody> latticeAround(const TriangleMesh& mesh, double cell)
{
    auto lattice = std::make_shared<SampledBody>();
    for (const Vec3i& t : mesh.triangles)
        for (int corner : t) lattice->body.extend(mesh.vertices[corner]);
    const Vec3 cells = (lattice->body.sizes() / cell).array().ceil() + 2.0 * kPadCells;
    const double nodes = (cells + Vec3::Ones()).prod();
    if (!(nodes <= kMostNodes))
        throw InputError("a mesh of " + std::to_string(lattice->body.sizes().maxCoeff()) + " cm sampled with cells of " + std::to_string(cell) +
                         " cm takes " + std::to_string(nodes) + " nodes, more than 5e8; use larger cells");
    for (int a = 0; a < kAxes; ++a) lattice->size[a] = static_cast<std::size_t>(cells[a]) + 1;
    lattice->cell = cell;
    lattice->lower = lattice->body.center() - 0.5 * cell * cells;
    lattice->values.resize(lattice->size[0] * lattice->size[1] * lattice->size[2]);
    return lattice;
}

}  // namespace

Shape Shape::mesh(const std::vector<Vec3>& vertices, const std::vector<Vec3i>& triangles, double cell, std::vector<std::string>* notes)
{
    TriangleMesh mesh{vertices, triangles};
    requireSound(mesh, cell);
    if (TriangleTree(mesh).empty()) throw InputError("a mesh has no triangle with an area");
    const auto lattice = latticeAround(mesh, cell);
    constexpr double kHoleCells = 2.0;  // a cell of the grid, at half of which a mesh is sampled
    const std::string mended = mendSolid(mesh, kHoleCells * cell);
    const TriangleTree tree(mesh);

    const auto [nx, ny, nz] = lattice->size;
    parallelFor(ny * nz, [&, nx = nx, ny = ny](std::size_t row) {
        TriangleTree::Nearest nearest{0.0, 0};
        for (std::size_t i = 0; i < nx; ++i) {
            const Vec3 place(static_cast<double>(i), static_cast<double>(row % ny), static_cast<double>(row / ny));
            const Vec3 x = lattice->lower + cell * place;
            nearest = tree.nearest(x, nearest.triangle);  // one node on, the same triangle is a good guess
            const bool inside = tree.windingNumber(x) > 0.5;
            lattice->values[row * nx + i] = static_cast<float>(inside ? -nearest.distance : nearest.distance);
        }
    });
    if (notes && !mended.empty()) notes->push_back("the mesh is mended: " + mended);
    return Shape(lattice);
}

}  // namespace sim
