#pragma once

#include "sim/core/parallel.h"
#include "sim/core/types.h"

#include <Eigen/Geometry>

#include <span>
#include <vector>

namespace sim {

/// Points sorted into bins, to find those near a place.
class PointBins {
 public:
    /// Ready for searches up to `reach` [cm]. The points must outlive this, and lie in a bounded region.
    PointBins(std::span<const Vec3> points, double reach);

    bool empty() const { return points_.empty(); }

    /// Calls visit(index) for all points in the bins around x, which hold all within reach, until it returns true; was
    /// there one?
    template <class Visit>
    bool anyNear(const Vec3& x, Visit&& visit) const
    {
        if (points_.empty()) return false;
        Vec3i from, to;
        for (int a = 0; a < kAxes; ++a) {
            const double q = (x[a] - lower_[a]) / width_;
            if (!(q >= -1.0 && q < size_[a] + 1.0)) return false;
            const int bin = static_cast<int>(std::floor(q));
            from[a] = std::max(bin - 1, 0);
            to[a] = std::min(bin + 1, size_[a] - 1);
        }
        for (int k = from[2]; k <= to[2]; ++k)
            for (int j = from[1]; j <= to[1]; ++j) {
                const std::size_t row = (static_cast<std::size_t>(k) * size_[1] + j) * size_[0];
                for (std::size_t n = begin_[row + from[0]]; n < begin_[row + to[0] + 1]; ++n)
                    if (visit(order_[n])) return true;
            }
        return false;
    }

    /// Is a point nearer to x than `distance` (at most reach)?
    bool anyNearer(const Vec3& x, double distance) const
    {
        return anyNear(x, [&](std::size_t p) { return (points_[p] - x).squaredNorm() < distance * distance; });
    }

 private:
    std::span<const Vec3> points_;
    Vec3 lower_ = Vec3::Zero();
    double width_ = 1.0;
    Vec3i size_ = Vec3i::Zero();
    std::vector<std::size_t> begin_;  ///< first point of each bin in order_
    std::vector<std::uint32_t> order_;
};

}  // namespace sim
