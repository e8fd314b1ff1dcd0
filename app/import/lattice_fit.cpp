#include "app/import/lattice_fit.h"

#include <fmt/format.h>
#include <Eigen/QR>

#include <algorithm>
#include <cmath>
#include <cstdlib>

namespace app {

using sim::Vec2i;
using sim::Vec3;

LatticeFit fitLattice(std::span<const Vec3> x, std::span<const Vec2i> places, std::span<const double> heights)
{
    const auto rows = static_cast<Eigen::Index>(x.size());
    const Eigen::Index columns = heights.empty() ? 3 : 4;
    Eigen::MatrixXd terms(rows, columns), points(rows, 3);
    for (Eigen::Index i = 0; i < rows; ++i) {
        terms(i, 0) = 1.0;
        terms(i, 1) = places[i][0];
        terms(i, 2) = places[i][1];
        if (columns == 4) terms(i, 3) = heights[i];
        points.row(i) = x[i].transpose();
    }
    const Eigen::MatrixXd found = terms.colPivHouseholderQr().solve(points);
    return {found.row(0).transpose(), found.row(1).transpose(), found.row(2).transpose(),
            columns == 4 ? Vec3(found.row(3).transpose()) : Vec3::Zero()};
}

double shortest(double x)
{
    const double rounding = 1.0e-12 * std::max(1.0, std::abs(x));
    if (std::abs(x) < rounding) return 0.0;
    for (int digits = 1; digits < 17; ++digits) {
        const double candidate = std::strtod(fmt::format("{:.{}e}", x, digits).c_str(), nullptr);
        if (std::abs(candidate - x) <= rounding) return candidate;
    }
    return x;
}

Vec3 shortest(const Vec3& x) { return {shortest(x[0]), shortest(x[1]), shortest(x[2])}; }

double largestDistance(std::span<const Vec3> a, std::span<const Vec3> b)
{
    double largest = 0.0;
    for (std::size_t i = 0; i < a.size(); ++i) largest = std::max(largest, (a[i] - b[i]).norm());
    return largest;
}

}  // namespace app
