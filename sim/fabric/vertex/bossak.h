#pragma once

#include "sim/core/types.h"

#include <Eigen/Core>

namespace sim::bossak {

// Second order in time, by a vertex (fabric/vertex/README.md, Second order): the α method of Wood, Bossak and Zienkiewicz 1980 ("An alpha
// modification of Newmark's method") whose spectral radius at infinity is 0. With A the acceleration at the end of the step by elasticity, weight and
// what goes on pressing, and a the recursive mean of those of the steps so far,
//   x1 − x0 = h v0 + h²/2 A,   a1 = (a0 + A)/2,   v1 = v0 + h (a0 + 3 A)/4.
// Of a it is the forces that are kept, which always have their reverse elsewhere. What comes about within the step acts as an impulse: of
// contact h F, as if it were there from the step's beginning, so that it stops what it meets and throws nothing back (to the move it is a force 2 F,
// all of which A would give back in part); of the liquid J − D v1, spread over the step.

/// What acts on a vertex in a step of length h [s].
struct Vertex {
    double mass;         ///< [g]
    Vec3 drag, impulse;  ///< D and J of the liquid [g, g cm/s]
    Vec3 velocity;       ///< v0 [cm/s]
    Vec3 force;          ///< mean f0 of the fabric's own forces: a0 = f0/m + g [dyn]
    Vec3 gravity;        ///< [cm/s^2]
    double h;

    /// By components: what forces at the end of the step have to move, times h² [g].
    Vec3 inertia() const { return 2.0 * (mass + drag.array()) / (1.0 + drag.array() / (4.0 * mass)); }
    /// Where it goes without forces of the fabric's own [cm].
    Vec3 freeMove() const
    {
        const Eigen::Array3d d = drag.array();
        const Eigen::Array3d before = (2.0 * mass + d) * velocity.array() - 0.25 * h / mass * d * force.array();
        return h * (before + impulse.array() + h * mass * gravity.array()) / (2.0 * (mass + d));
    }
};

/// Velocity and mean force at the end of a step.
struct Rates {
    Vec3 velocity, force;
    Vec3 own;  ///< mean acceleration in the step by the fabric's own forces [cm/s^2]
};

/// @param move    x1 − x0 [cm]
/// @param abrupt  F [dyn]
inline Rates ratesOf(const Vertex& at, const Vec3& move, const Vec3& abrupt)
{
    const Vec3 lasting = at.inertia().cwiseProduct(move - at.freeMove()) / (at.h * at.h) - 2.0 * abrupt;
    const Eigen::Array3d d = at.drag.array() / at.mass;
    const Vec3 spread = (1.0 + 0.5 * d) / (1.0 + d) * abrupt.array();
    const Vec3 velocity = 2.0 / at.h * move - at.velocity - at.h / at.mass * (0.25 * (lasting - at.force) + spread);
    return {velocity, 0.5 * (at.force + lasting), (0.25 * (at.force + 3.0 * lasting) + abrupt) / at.mass};
}

/// Rate of a twist angle at the end of the step, and mean torque on it: nothing acts on it but elasticity.
struct TwistRates {
    double rate, torque;  ///< [1/s, dyn cm]
};

/// @param turn  change of the angle over the step [rad]
inline TwistRates twistRatesOf(double turn, double rate, double torque, double inertia, double h)
{
    const double mean = 0.5 * torque + inertia * (turn - h * rate) / (h * h);
    return {turn / h + 0.5 * h * mean / inertia, mean};
}

}  // namespace sim::bossak
