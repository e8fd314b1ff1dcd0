#include "sim/fabric/contact/limiter.h"

#include <algorithm>

namespace sim::contact {

double collisionFreeFraction(PairKind kind, const std::array<Vec3, 4>& x, const std::array<Vec3, 4>& u, double separation)
{
    constexpr double kStop = 0.1;       // of the first gap: nearer than this is arrived
    constexpr double kShare = 0.9;      // of what is certainly free is taken at once
    constexpr int kMostAdvances = 200;  // those that creep along each other have got far enough by then

    std::array<Vec3T<double>, 4> at, move;
    const Vec3 middle = 0.25 * (u[0] + u[1] + u[2] + u[3]);
    for (std::size_t c = 0; c < 4; ++c) {
        at[c] = toVec3T(x[c]);
        move[c] = toVec3T(u[c] - middle);
    }
    const double length = relativeMotion(kind, move);
    if (length == 0.0) return 1.0;
    const auto gap = [&](double t) {
        std::array<Vec3T<double>, 4> now;
        for (std::size_t c = 0; c < 4; ++c) now[c] = at[c] + t * move[c];
        const Vec3T<double> apart = closestPoints(kind, now).separation;
        return std::sqrt(dot(apart, apart)) - separation;
    };
    const double first = gap(0.0);
    if (first <= 0.0) return 0.0;
    if (first > length) return 1.0;
    double t = kShare * first / length;
    for (int advance = 0; advance < kMostAdvances && t < 1.0; ++advance) {
        const double left = gap(t);
        if (left < kStop * first) return t;
        t += kShare * left / length;
    }
    return std::min(t, 1.0);
}

}  // namespace sim::contact
