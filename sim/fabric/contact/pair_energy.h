#pragma once

#include "sim/fabric/contact/primitives.h"

#include <algorithm>
#include <cmath>

namespace sim::contact {

/// The energy of one pair at a distance, and its derivatives [dyn cm, dyn, dyn/cm].
struct PairEnergy {
    double energy = 0.0, slope = 0.0, curvature = 0.0;
};

inline constexpr double kSoftShare = 0.5;  ///< part of the spring's way over which its stiffness grows from 0; 0.2 still chatters [-]

/// A spring from the reach R inwards whose stiffness grows over the first part of its way; below the wall τ a logarithm that no
/// distance above the core can pay, and right at the core the parabola that touches it there, so that one Newton step leads a pair out that
/// a limited move has left below. C2 at R, C1 at τ, convex. (fabric/contact/README.md, Energy of a pair). The beginning is soft, as a spring that is
/// stiff at once chatters under light loads, and cloth that should slide on cloth sticks (ClothOnCloth tests).
inline PairEnergy pairEnergy(double distance, const ContactDistances& range, double stiffness)
{
    if (distance >= range.reach) return {};
    const double wall = range.wall(), pressed = range.reach - wall, depth = wall - range.core;
    const double soft = kSoftShare * pressed, gap = range.reach - distance, firm = gap - 0.5 * soft;
    if (gap < soft) return {stiffness * gap * gap * gap / (6.0 * soft), -0.5 * stiffness * gap * gap / soft, stiffness * gap / soft};
    const double spring = 0.5 * stiffness * firm * firm + stiffness * soft * soft / 24.0;
    if (distance >= wall) return {spring, -stiffness * firm, stiffness};
    constexpr double kLeastDepth = 0.02;  // of the wall: where the parabola begins
    const double least = kLeastDepth * depth, left = std::max(distance - range.core, least);
    const double beyond = std::max(1.0 - (distance - range.core) / least, 0.0);  // into the parabola, in parts of that depth
    const double firmest = pressed - 0.5 * soft, strength = stiffness * firmest * depth;
    const double atWall = 0.5 * stiffness * firmest * firmest + stiffness * soft * soft / 24.0;
    return {atWall + strength * (beyond + 0.5 * beyond * beyond - std::log(left / depth)), -strength / left * (1.0 + beyond),
            strength / (left * left)};
}

/// The tangent of a pair's spring, as slope and curvature at a distance, where the spring has a force that an iteration has found for the pair
/// [dyn]: as its stiffness grows with its way, Newton from where the pair has got to would let go by halves, and press many times too far. The
/// tangent touches between a quarter of that way and its double; at the wall and below it is that of where the pair is. (fabric/contact/README.md,
/// Energy of a pair.)
inline PairEnergy pairTangent(double distance, const ContactDistances& range, double stiffness, double force)
{
    constexpr double kLeastWay = 0.25, kMostWay = 2.0;
    const PairEnergy here = pairEnergy(distance, range, stiffness);
    const double wall = range.wall(), way = range.reach - distance, soft = kSoftShare * (range.reach - wall);
    if (!(way > 0.0) || distance <= wall) return here;
    const double softest = 0.5 * stiffness * soft;  // force at the end of the soft part
    const double found = force < softest ? std::sqrt(2.0 * soft * std::max(force, 0.0) / stiffness) : force / stiffness + 0.5 * soft;
    const double touching = std::clamp(found, kLeastWay * way, kMostWay * way);
    if (touching >= range.reach - wall) return here;
    const PairEnergy there = pairEnergy(range.reach - touching, range, stiffness);
    return {here.energy, std::min(there.slope + there.curvature * (touching - way), 0.0), there.curvature};
}

inline constexpr double kFirmPerStep = 4.0;  ///< stiffness relative to mass/h² that stops the mass within a few steps [-]

/// Stiffness of a pair [dyn/cm]: of the fibres where they are soft; what a step can resolve where they are hard, and no less than it
/// takes to stop the masses within a few steps.
/// @param young     E χ of the softer side [dyn/cm^2]
/// @param touching  sum of the radii [cm]
/// @param mass      mean of the four vertices [g]
/// @param step      springStepFor the step [s]
inline double pairStiffness(double young, double touching, double mass, double step)
{
    const double perStep = mass / (step * step);
    return std::max(std::min(0.1 * young * touching, 100.0 * perStep), kFirmPerStep * perStep);
}

/// Stiffness of a pair's friction [dyn/cm]: of what holds the masses within a few steps, and no less than that of what presses it, so that
/// pressed hard it gives no further than it is pressed before it slides. A stiffer spring would hold no better, as forces are remembered;
/// but it ties strands together so firmly that the linear solve, whose preconditioner sees each by itself, takes twice the iterations.
/// @param normalForce  [dyn]
/// @param pressed      how far the pair is below its reach [cm]
/// @param perStep      mean mass of the four vertices over step² [dyn/cm]
inline double pairFrictionStiffness(double normalForce, double pressed, double perStep)
{
    return std::max(kFirmPerStep * perStep, normalForce / pressed);
}

}  // namespace sim::contact
