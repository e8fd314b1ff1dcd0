#pragma once

#include "sim/fabric/contact/contact.h"

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
        std::array<Vec3, 2> change;
        const auto ends = directionsOfPair(firstSide);
        for (int i = 0; i < 2; ++i) {
            const Vec3 first = before[v[ends[i][1]]] - before[v[ends[i][0]]], last = now[v[ends[i][1]]] - now[v[ends[i][0]]];
            const double lengthBefore = first.norm(), lengthNow = last.norm();
            const Vec3 from = first / lengthBefore, to = last / lengthNow;
            middle_[i] = 0.5 * (from + to);
            square_[i] = middle_[i].squaredNorm();
            change[i] = to - from;
            length_[i] = 0.5 * (lengthBefore + lengthNow);
        }
        cosine_ = middle_[0].dot(middle_[1]);
        isParallel_ = std::abs(cosine_) > kParallel;
        if (isParallel_) {
            const double sign = cosine_ < 0.0 ? -1.0 : 1.0;
            axis_ = {middle_[0] + sign * middle_[1], sign * middle_[0] + middle_[1]};
            for (int i = 0; i < 2; ++i) change[i] = across(i, change[i]);
        } else {
            axis_ = middle_;
        }
        turn_ = turnOf(axis_[0].cross(change[0]) + axis_[1].cross(change[1]));
    }
    Vec3 operator*(const Vec3& u) const
    {
        const Vec3 first = turn_.cross(u);
        return u + (first + 0.5 * turn_.cross(first)) / (1.0 + 0.25 * turn_.squaredNorm());
    }
    /// How what it makes of u answers along two tangents to moves of the end of a direction against its begin, halfway through the turn: w × (u + u')/2
    /// is Σ t λ·(e' − e) along them, over the directions with their lengths [-].
    ActiveContacts::Lever lever(const Vec3& u, const std::array<Vec3, 2>& tangents) const
    {
        const Vec3 halfway = 0.5 * (u + *this * u);
        ActiveContacts::Lever lever;
        for (int j = 0; j < 2; ++j) {
            const Vec3 moment = turnOf(halfway.cross(tangents[j]));
            for (int i = 0; i < 2; ++i) {
                const Vec3 arm = moment.cross(axis_[i]) / length_[i];
                lever[i][j] = isParallel_ ? across(i, arm) : arm;
            }
        }
        return lever;
    }

 private:
    /// What of a vector is across a direction.
    Vec3 across(int i, const Vec3& a) const { return a - middle_[i].dot(a) / square_[i] * middle_[i]; }
    /// Turn that directions with these moments of their changes have made, by least squares: (Σ |m|² − m mᵀ)⁻¹, of two that are not parallel (Woodbury).
    Vec3 turnOf(const Vec3& moment) const
    {
        if (isParallel_) return moment / axis_[0].squaredNorm();
        const double first = middle_[0].dot(moment), second = middle_[1].dot(moment);
        const double perArea = 1.0 / (square_[0] * square_[1] - cosine_ * cosine_);
        return (moment + perArea * ((square_[0] * first + cosine_ * second) * middle_[0] + (cosine_ * first + square_[1] * second) * middle_[1])) /
               (square_[0] + square_[1]);
    }

    std::array<Vec3, 2> middle_;    ///< directions, means of before and now [-]
    std::array<Vec3, 2> axis_;      ///< what changes of the directions have their moments about: those means, or of both where they are parallel [-]
    std::array<double, 2> square_;  ///< squares of the means [-]
    std::array<double, 2> length_;  ///< lengths of the directions, means of before and now [cm]
    double cosine_;                 ///< of the means [-]
    bool isParallel_;               ///< whether the directions are all but parallel
    Vec3 turn_;                     ///< w [-]
};

}  // namespace sim::contact
