#pragma once

#include "sim/fabric/friction.h"

#include <algorithm>

namespace sim {

// Friction that sticks (Coulomb's, elastic up to its bound). What touches is held by a spring across the normal, whose force is
// remembered from step to step (Grips), carried along by what it holds on to, and never more than friction can hold: below that it
// comes to where it balances the load and nothing moves, above it slides at the bound. As springs against penetration do, its stiffness
// goes by mass/h², so that it neither knows a speed or a length of its own nor rings. Changes of h leave the force as it is. It gives
// back no more than the bound's square over twice its stiffness, a small part of what gravity does in a step, and where contact ends
// nothing. Source: Simo and Hughes 1998, "Computational Inelasticity" (return mapping).

/// Friction of two that touch, and how it answers to their slip. All of it is across the normal.
struct Friction {
    Vec3 force;                     ///< gradient by the position of the first against the second [dyn]
    double stiffness = 0.0;         ///< against slip across `direction` [dyn/cm]
    double along = 0.0;             ///< against slip along `direction` [dyn/cm]
    Vec3 direction = Vec3::Zero();  ///< unit; 0 where both are the same
    bool slides = false;            ///< whether it is at its bound

    Mat3 matrix(const Vec3& normal) const
    {
        return stiffness * (Mat3::Identity() - normal * normal.transpose()) + (along - stiffness) * (direction * direction.transpose());
    }
};

/// A force as far as friction can hold it.
inline Vec3 atMost(double bound, const Vec3& force)
{
    const double size = force.norm();
    return size > bound ? Vec3(bound / size * force) : force;
}

/// A spring that friction holds, and by what it can be held.
struct FrictionSpring {
    Vec3 held;         ///< force at the start of the step [dyn]
    double stiffness;  ///< [dyn/cm]
    double bound;      ///< Coulomb's coefficient times the normal force [dyn]

    Vec3 trial(const Vec3& slip) const { return held + stiffness * slip; }
    /// Friction at a slip. Its stiffness is that of the chord, by which iterations come to rest from any side.
    /// @param ofChord  part of it where it slides: with a half, errors along the way and across it shrink alike from iteration to iteration [-]
    Friction at(const Vec3& slip, double ofChord = 1.0) const
    {
        const Vec3 force = trial(slip);
        const double size = force.norm();
        if (size <= bound) return {force, stiffness, stiffness};
        const double share = bound / size, answer = ofChord * share * stiffness;
        return {share * force, answer, answer, Vec3::Zero(), true};
    }
    /// Friction at a slip that is not yet that of the end of the step; there it is expected to be another. A mass m that `expected` takes
    /// forward with the friction held so far would, without friction, come to where the spring has E = trial(expected) + κ held with
    /// κ = h²/m · stiffness. It sticks up to (1 + κ) bound and slides to trial E − κ bound beyond. What slides steadily goes on as expected,
    /// whatever its mass is tied to. The force there is the bound, the stiffness along it less than that of the chord: what begins to
    /// slide is held back by the chord for 1 + κ steps, by this for two.
    Friction expected(const Vec3& slip, const Vec3& expectedSlip, double perMass) const;
};

inline Friction FrictionSpring::expected(const Vec3& slip, const Vec3& expectedSlip, double perMass) const
{
    const Vec3 smooth = trial(expectedSlip), free = smooth + perMass * held;
    const double size = free.norm();
    const Vec3 direction = size > 0.0 ? Vec3(free / size) : Vec3::Zero().eval();
    const double last = size - perMass * bound;
    if (last <= bound) return {trial(slip), stiffness, stiffness};
    const double share = bound / last, along = stiffness * bound / (last + perMass * bound);
    const Vec3 further = slip - (last * direction - held) / stiffness;
    const double ahead = direction.dot(further);
    return {(bound + (along - share * stiffness) * ahead) * direction + share * stiffness * further, share * stiffness, along, direction, true};
}

}  // namespace sim
