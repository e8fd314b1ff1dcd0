#include "sim/particles/point_bins.h"

#include "sim/core/check.h"

#include <cmath>

namespace sim {

PointBins::PointBins(std::span<const Vec3> points, double reach) : points_(points)
{
    if (points.empty()) return;
    SIM_CHECK(reach > 0.0);
    Eigen::AlignedBox3d box;
    for (const Vec3& x : points) box.extend(x);
    lower_ = box.min();
    // Bins grow where points are few: there are never many more bins than points.
    width_ = reach;
    const double most = 8.0 * static_cast<double>(points.size()) + 64.0;
    const auto counts = [&] { return Vec3((box.sizes() / width_).array().floor() + 1.0); };
    while (counts().prod() > most) width_ *= 1.25;
    size_ = counts().cast<int>();

    const auto binOf = [&](const Vec3& x) {
        const Vec3i b = ((x - lower_) / width_).cast<int>().cwiseMin(size_ - Vec3i::Ones());
        return (static_cast<std::size_t>(b[2]) * size_[1] + b[1]) * size_[0] + b[0];
    };
    std::vector<std::uint32_t> bins(points.size());
    parallelFor(points.size(), 4096, [&](std::size_t p) { bins[p] = static_cast<std::uint32_t>(binOf(points[p])); });
    begin_.assign(static_cast<std::size_t>(size_.cast<double>().prod()) + 1, 0);
    for (std::uint32_t b : bins) ++begin_[b + 1];
    for (std::size_t b = 1; b < begin_.size(); ++b) begin_[b] += begin_[b - 1];
    order_.resize(points.size());
    std::vector<std::size_t> next(begin_.begin(), begin_.end() - 1);
    for (std::size_t p = 0; p < points.size(); ++p) order_[next[bins[p]]++] = static_cast<std::uint32_t>(p);
}

}  // namespace sim
