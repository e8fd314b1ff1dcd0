#include "sim/shapes/volume.h"

#include "sim/core/check.h"
#include "sim/core/parallel.h"

#include <array>
#include <cmath>

namespace sim {

namespace {

/// Halvings of a cell that the surface may cross.
constexpr int kHalvings = 3;

/// Share of a unit cube around 0 in which m·x < depth, all m ≥ 0: corners counted in and out (inclusion and exclusion).
double shareBelow(const Vec3& m, double depth)
{
    // Axes along which the plane hardly rises drop out: they change the share by the square of that at most, and would
    // make it 0/0.
    std::array<double, kAxes> rise;
    int axes = 0;
    for (double r : m)
        if (r > 1.0e-4 * m.maxCoeff()) rise[axes++] = r;
    double sum = 0.0, scale = 1.0;
    for (int corner = 0; corner < 1 << axes; ++corner) {
        double below = depth, sign = 1.0;
        for (int a = 0; a < axes; ++a) {
            const bool far = corner >> a & 1;
            below += far ? -0.5 * rise[a] : 0.5 * rise[a];
            if (far) sign = -sign;
        }
        if (below > 0.0) sum += sign * std::pow(below, axes);
    }
    for (int a = 0; a < axes; ++a) scale *= rise[a] * (a + 1);
    return std::clamp(sum / scale, 0.0, 1.0);
}

/// Share of the box of the given size around a point that lies inside the shape.
double shareInside(const Shape& shape, const Vec3& center, const Vec3& size, int halvings)
{
    const double d = shape.distance(center);
    if (std::abs(d) >= 0.5 * size.norm()) return d < 0.0 ? 1.0 : 0.0;
    if (halvings == 0) return shareBelow(shape.normal(center).cwiseAbs().cwiseProduct(size), -d);
    double sum = 0.0;
    for (int octant = 0; octant < 8; ++octant) {
        const Vec3 side(octant & 1 ? 0.25 : -0.25, octant & 2 ? 0.25 : -0.25, octant & 4 ? 0.25 : -0.25);
        sum += shareInside(shape, center + side.cwiseProduct(size), 0.5 * size, halvings - 1);
    }
    return sum / 8.0;
}

}  // namespace

double boundedVolume(const Shape& shape, double cell)
{
    const Eigen::AlignedBox3d box = shape.bounds();
    if (box.isEmpty() || !(box.sizes().minCoeff() > 0.0)) return 0.0;
    if (!box.sizes().allFinite()) throw InputError("the volume of an unbounded shape was asked for");
    const Vec3 counts = (box.sizes() / cell).array().ceil().max(1.0);
    constexpr double kMostCells = 1.0e9;
    if (!(counts.prod() < kMostCells)) throw InputError("a shape is too large for its cells: its volume takes over 1e9 of them");
    const Vec3 size = box.sizes().cwiseQuotient(counts);
    const std::size_t nx = static_cast<std::size_t>(counts[0]), ny = static_cast<std::size_t>(counts[1]);
    const std::size_t rows = ny * static_cast<std::size_t>(counts[2]);
    const double cells = parallelSum(rows, [&](std::size_t row) {
        double sum = 0.0;
        for (std::size_t i = 0; i < nx; ++i) {
            const Vec3 place(static_cast<double>(i) + 0.5, static_cast<double>(row % ny) + 0.5, static_cast<double>(row / ny) + 0.5);
            sum += shareInside(shape, box.min() + place.cwiseProduct(size), size, kHalvings);
        }
        return sum;
    });
    return cells * size.prod();
}

}  // namespace sim
