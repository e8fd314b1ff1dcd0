#include "sim/scene/estimate_volume.h"

#include <algorithm>
#include <cmath>

namespace sim {

namespace {

constexpr int kMaxLevels = 20;

/// Distance to the region where all conditions hold: at most the true one, as shapes promise.
double regionDistance(const Vec3& x, const SourceSettings& source, const Scene& scene)
{
    double d = source.shape.distance(x);
    if (scene.domain) d = std::max(d, scene.domain->distance(x));
    for (const ObstacleSettings& o : scene.obstacles) d = std::max(d, -o.shape.distance(x));
    return d;
}

/// Boxes of one level that can be looked at in a fraction of a second.
std::size_t affordableBoxes(const SourceSettings& source, const Scene& scene, std::size_t maxBoxes)
{
    constexpr std::size_t kTextOfOnePart = 40, kDistancesInAll = 4'000'000;
    std::size_t text = source.shapeText.size() + scene.domainText.size();
    for (const ObstacleSettings& o : scene.obstacles) text += o.shapeText.size();
    return std::min(maxBoxes, kDistancesInAll / (1 + text / kTextOfOnePart));
}

Vec3 childCenter(const Vec3& center, const Vec3& half, int child)
{
    const Vec3 sign(child & 1 ? 1.0 : -1.0, child & 2 ? 1.0 : -1.0, child & 4 ? 1.0 : -1.0);
    return center + 0.5 * half.cwiseProduct(sign);
}

/// Boxes along each axis with which to start: 12 along the longest if that many are affordable, so that they are nearly
/// cubes.
Vec3i boxCounts(const Eigen::AlignedBox3d& bounds, std::size_t affordable)
{
    const double longest = bounds.sizes().maxCoeff(), most = std::clamp(std::cbrt(static_cast<double>(affordable)), 1.0, 12.0);
    Vec3i counts = Vec3i::Ones();
    for (int a = 0; a < kAxes && longest > 0.0; ++a)
        counts[a] = std::max(1, static_cast<int>(std::ceil(std::floor(most) * bounds.sizes()[a] / longest)));
    return counts;
}

std::vector<Vec3> boxCenters(const Eigen::AlignedBox3d& bounds, const Vec3i& counts)
{
    const Vec3 size = bounds.sizes().cwiseQuotient(counts.cast<double>());
    std::vector<Vec3> centers;
    for (int i = 0; i < counts[0]; ++i) {
        for (int j = 0; j < counts[1]; ++j) {
            for (int k = 0; k < counts[2]; ++k) centers.push_back(bounds.min() + size.cwiseProduct(Vec3(i + 0.5, j + 0.5, k + 0.5)));
        }
    }
    return centers;
}

}  // namespace

VolumeEstimate estimateVolume(const SourceSettings& source, const Scene& scene, std::size_t maxBoxes)
{
    VolumeEstimate result;
    Eigen::AlignedBox3d bounds = source.shape.bounds();
    if (scene.domain) bounds = bounds.intersection(scene.domain->bounds());
    if (source.shape.empty() || bounds.isEmpty()) {
        result.isEmpty = true;
        return result;
    }
    if (!bounds.sizes().allFinite()) {
        result.isUnbounded = true;
        return result;
    }
    // Boxes that are surely full or surely empty are settled, the others are halved along each axis, level by level.
    const std::size_t affordable = affordableBoxes(source, scene, maxBoxes);
    const Vec3i counts = boxCounts(bounds, affordable);
    std::vector<Vec3> open = boxCenters(bounds, counts), next;
    Vec3 half = 0.5 * bounds.sizes().cwiseQuotient(counts.cast<double>());
    bool isSomewhere = false;
    for (int level = 0; !open.empty(); ++level) {
        const double boxVolume = 8.0 * half.prod(), reach = half.norm();
        const bool isLast = 8 * open.size() > affordable || level == kMaxLevels;
        next.clear();
        bool isDecided = true;
        for (const Vec3& center : open) {
            const double d = regionDistance(center, source, scene);
            isSomewhere = isSomewhere || d < 0.0;
            if (d > reach) continue;
            isDecided = false;
            if (d < -reach || isLast) {
                // Of a box that the surface crosses, the part below it if the surface were flat.
                const double share = std::clamp(0.5 - 0.5 * d / (reach / std::sqrt(3.0)), 0.0, 1.0);
                result.volume += boxVolume * (d < -reach ? 1.0 : share);
            } else {
                for (int child = 0; child < 8; ++child) next.push_back(childCenter(center, half, child));
            }
        }
        result.isEmpty = !isSomewhere && isDecided;
        if (isLast) break;
        std::swap(open, next);
        half *= 0.5;
    }
    return result;
}

}  // namespace sim
