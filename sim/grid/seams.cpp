#include "sim/grid/seams.h"

#include <cmath>

namespace sim {

namespace {

constexpr double kBeyond = 0.01;  ///< distance behind a surface at which more solid is looked for, relative to the reach [-]

/// The nearest place so far, and what may lead to a nearer one.
struct Search {
    const Obstacles& obstacles;
    Vec3 x;
    double reach;
    std::optional<Vec3> best;

    /// Looks from a place outside to the surface below it, and along the normal there.
    void look(Vec3 outside)
    {
        constexpr int kMoves = 3;
        for (int move = 0; move < kMoves; ++move) {
            const double distance = obstacles.distance(outside);
            if (distance <= 0.0) return;
            const Vec3 normal = obstacles.normal(outside), surface = outside - distance * normal;
            if (!best || (surface - x).squaredNorm() < (*best - x).squaredNorm()) best = surface;
            outside = x + (normal.dot(surface - x) + kBeyond * reach) * normal;
        }
    }
};

bool endsAtSeam(const Obstacles& obstacles, const Vec3& x, double distance, double reach)
{
    return obstacles.distance(x + (kBeyond * reach - distance) * obstacles.normal(x)) < 0.0;
}

}  // namespace

std::optional<Vec3> nearestSurface(const Obstacles& obstacles, const Vec3& x, double reach)
{
    const double distance = obstacles.distance(x);
    if (distance >= 0.0) return std::nullopt;
    if (distance > -reach && !endsAtSeam(obstacles, x, distance, reach)) return x - distance * obstacles.normal(x);
    Search search{obstacles, x, reach, std::nullopt};
    for (double way : {0.25 * reach, 0.5 * reach, 1.1 * reach})
        for (int n = 0; n < 27; ++n) {
            const Vec3 direction(n % 3 - 1, n / 3 % 3 - 1, n / 9 - 1);
            if (n != 13) search.look(x + way * direction.normalized());
        }
    if (search.best && (*search.best - x).norm() > reach) return std::nullopt;
    return search.best;
}

NearSurface surfaceAcrossSeams(const Obstacles& obstacles, const Vec3& x, double reach)
{
    const double distance = obstacles.distance(x);
    if (distance >= 0.0 || distance <= -reach || !endsAtSeam(obstacles, x, distance, reach)) return {distance, obstacles.normal(x)};
    const std::optional<Vec3> surface = nearestSurface(obstacles, x, reach);
    if (!surface) return {-reach, obstacles.normal(x)};
    const double depth = (*surface - x).norm();
    return {-depth, depth > 0.0 ? Vec3((*surface - x) / depth) : obstacles.normal(x)};
}

double distanceAcrossSeams(const Obstacles& obstacles, const Vec3& x, double reach)
{
    const double distance = obstacles.distance(x);
    if (distance >= 0.0 || distance <= -reach) return distance;
    return surfaceAcrossSeams(obstacles, x, reach).distance;
}

}  // namespace sim
