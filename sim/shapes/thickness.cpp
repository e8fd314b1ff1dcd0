#include "sim/shapes/thickness.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace sim {

namespace {

/// Move a place to the surface, as far as distances that may be bounds tell where it is; false where they lead nowhere.
/// @param normal  out: there, as seen from where it came, for on an edge it is either side's
bool goToSurface(const Shape& shape, double resolution, Vec3& x, Vec3& normal)
{
    normal = shape.normal(x);
    constexpr int kMostMoves = 8;
    for (int n = 0; n < kMostMoves; ++n) {
        const double distance = shape.distance(x);
        if (std::abs(distance) < 0.1 * resolution) return true;
        normal = shape.normal(x);
        x -= distance * normal;
    }
    return false;
}

/// Length within the solid along −n from a place on its surface, found in steps of the distance to the other side.
double throughSolid(const Shape& shape, const Vec3& surface, const Vec3& normal, double resolution, double most)
{
    double gone = resolution;
    for (double inside = 1.0; gone < most; gone += std::max(inside, resolution)) {
        inside = -shape.distance(surface - gone * normal);
        if (inside <= 0.0) break;
    }
    return gone;
}

}  // namespace

double thicknessOf(const Shape& shape, double pitch)
{
    constexpr double kInfinity = std::numeric_limits<double>::infinity();
    constexpr int kMostPlaces = 32;       // along an axis
    constexpr double kResolution = 0.01;  // [pitches]
    constexpr double kThin = 0.05;        // share of the places
    if (shape.empty() || shape.isInverted()) return kInfinity;
    const Eigen::AlignedBox3d box = shape.bounds();
    const Vec3 size = box.sizes();
    if (!size.allFinite()) return kInfinity;
    const double step = std::max(pitch, size.maxCoeff() / kMostPlaces), resolution = kResolution * pitch;
    std::vector<double> lengths;
    const Vec3i count = (size / step).array().ceil().cast<int>().max(1);
    for (int k = 0; k < count.z(); ++k)
        for (int j = 0; j < count.y(); ++j)
            for (int i = 0; i < count.x(); ++i) {
                Vec3 normal, x = box.min() + size.cwiseProduct((Vec3(i, j, k) + Vec3::Constant(0.5)).cwiseQuotient(count.cast<double>()));
                if (std::abs(shape.distance(x)) > step || !goToSurface(shape, resolution, x, normal)) continue;
                if (shape.distance(x - resolution * normal) >= 0.0) continue;
                lengths.push_back(throughSolid(shape, x, normal, resolution, size.norm() + step));
            }
    if (lengths.empty()) return kInfinity;
    const auto thin = lengths.begin() + static_cast<std::ptrdiff_t>(kThin * static_cast<double>(lengths.size()));
    std::nth_element(lengths.begin(), thin, lengths.end());
    return *thin;
}

}  // namespace sim
