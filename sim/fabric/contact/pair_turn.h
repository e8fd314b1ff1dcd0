#pragma once

#include "sim/fabric/contact/contact.h"

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
    /// @param firstSide  vertices of the pair's first side
    PairTurn(int firstSide, const std::array<int, 4>& v, std::span<const Vec3> before, std::span<const Vec3> now)
    {
        constexpr double kParallel = 0.95;  // cosine
        std::array<Vec3, 2> middle, change;
        const auto ends = directionsOfPair(firstSide);
        for (int i = 0; i < 2; ++i) {
            const Vec3 first = before[v[ends[i][1]]] - before[v[ends[i][0]]], last = now[v[ends[i][1]]] - now[v[ends[i][0]]];
            const double lengthBefore = first.norm(), lengthNow = last.norm();
            middle[i] = 0.5 * (first / lengthBefore + last / lengthNow);
            change[i] = last / lengthNow - first / lengthBefore;
            length_[i] = 0.5 * (lengthBefore + lengthNow);
        }
        const double cosine = middle[0].dot(middle[1]);
        if (std::abs(cosine) > kParallel) {
            const double sign = cosine < 0.0 ? -1.0 : 1.0;
            const Vec3 common = middle[0] + sign * middle[1];
            inverse_ = Mat3::Identity() / common.squaredNorm();
            for (int i = 0; i < 2; ++i)
                moment_[i] = crossMatrix(i == 0 ? common : Vec3(sign * common)) *
                             (Mat3::Identity() - middle[i] * middle[i].transpose() / middle[i].squaredNorm());
        } else {
            Mat3 m = Mat3::Zero();
            for (int i = 0; i < 2; ++i) {
                m += middle[i].squaredNorm() * Mat3::Identity() - middle[i] * middle[i].transpose();
                moment_[i] = crossMatrix(middle[i]);
            }
            inverse_ = m.inverse();
        }
        turn_ = inverse_ * (moment_[0] * change[0] + moment_[1] * change[1]);
    }
    Vec3 operator*(const Vec3& u) const
    {
        const Vec3 first = turn_.cross(u);
        return u + (first + 0.5 * turn_.cross(first)) / (1.0 + 0.25 * turn_.squaredNorm());
    }
    /// How what it makes of u answers to moves of the end of a direction against its begin, halfway through the turn: Λ with
    /// w × (u + u')/2 = Σ Λ (e' − e) of the directions with their lengths [-].
    ActiveContacts::Lever lever(const Vec3& u) const
    {
        const Mat3 across = -crossMatrix(0.5 * (u + *this * u)) * inverse_;
        return {across * moment_[0] / length_[0], across * moment_[1] / length_[1]};
    }

 private:
    static Mat3 crossMatrix(const Vec3& a)
    {
        Mat3 m;
        m << 0.0, -a.z(), a.y(), a.z(), 0.0, -a.x(), -a.y(), a.x(), 0.0;
        return m;
    }

    std::array<Mat3, 2> moment_;    ///< moments of the directions' changes, about the mean of before and now, or of both where they are parallel [-]
    std::array<double, 2> length_;  ///< lengths of the directions, means of before and now [cm]
    Mat3 inverse_;                  ///< w is that times the moments of the directions' changes [-]
    Vec3 turn_;                     ///< w [-]
};

}  // namespace sim::contact
