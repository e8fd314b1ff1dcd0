#pragma once

#include "sim/fabric/contact/closest_points.h"

#include <Eigen/Dense>

#include <array>
#include <cmath>
#include <span>

namespace sim::contact {

/// How a pair has turned as a whole, by two directions in it: those of its edges, or two sides of its face. What turns with its pair does
/// not slide, though the separation of the two, which lie a thickness apart, changes. Exact where the pair turns like a rigid body: e' − e =
/// w × (e' + e)/2 then holds of every direction e, with w of length 2 tan(angle/2). Edges that are all but parallel do not tell by how much
/// the two have turned about themselves; then they have not.
class PairTurn {
 public:
    PairTurn(PairKind kind, const std::array<int, 4>& v, std::span<const Vec3> before, std::span<const Vec3> now)
    {
        constexpr double kParallel = 0.95;  // cosine
        const bool areEdges = kind == PairKind::EdgeEdge;
        const std::array<std::array<int, 2>, 2> ends = {areEdges ? std::array{v[0], v[1]} : std::array{v[1], v[2]},
                                                        areEdges ? std::array{v[2], v[3]} : std::array{v[1], v[3]}};
        std::array<Vec3, 2> middle, change;
        for (int i = 0; i < 2; ++i) {
            const Vec3 first = (before[ends[i][1]] - before[ends[i][0]]).normalized(), last = (now[ends[i][1]] - now[ends[i][0]]).normalized();
            middle[i] = 0.5 * (first + last);
            change[i] = last - first;
        }
        const double cosine = middle[0].dot(middle[1]);
        if (std::abs(cosine) > kParallel) {
            const double sign = cosine < 0.0 ? -1.0 : 1.0;
            const Vec3 common = middle[0] + sign * middle[1];
            turn_ = common.cross(Vec3(change[0] + sign * change[1])) / common.squaredNorm();
        } else {
            Mat3 m = Mat3::Zero();
            Vec3 moment = Vec3::Zero();
            for (int i = 0; i < 2; ++i) {
                m += middle[i].squaredNorm() * Mat3::Identity() - middle[i] * middle[i].transpose();
                moment += middle[i].cross(change[i]);
            }
            turn_ = m.inverse() * moment;
        }
    }
    Vec3 operator*(const Vec3& u) const
    {
        const Vec3 first = turn_.cross(u);
        return u + (first + 0.5 * turn_.cross(first)) / (1.0 + 0.25 * turn_.squaredNorm());
    }

 private:
    Vec3 turn_;  ///< w [-]
};

}  // namespace sim::contact
