#pragma once

#include "sim/fabric/cohesion.h"
#include "sim/fabric/fabric.h"
#include "sim/settings.h"
#include "sim/stage.h"

#include <array>
#include <memory>
#include <span>
#include <vector>

namespace sim {

/// Pairs of fabric primitives (edge-edge, vertex-face) close enough to push on each other; sorted, one array per quantity.
/// With c the weights and x the positions of its four vertices, a pair's separation is Σ c x. Its first side are the first two
/// vertices, or the first alone where a vertex meets a face.
struct ActiveContacts {
    std::vector<std::array<int, 4>> vertices;
    std::vector<std::uint8_t> firstSide;         ///< vertices of the first side: 2 or 1
    std::vector<std::array<double, 4>> weights;  ///< of both sides, those of the second negative: they sum to zero [-]
    std::vector<Vec3> normal;                    ///< unit, from the second side to the first
    std::vector<Vec3> force;                     ///< dE/d(separation), with friction: vertex a has the gradient c_a force [dyn]
    std::vector<double> stiffness;               ///< along the normal, k_n [dyn/cm]
    std::vector<double> frictionStiffness;       ///< across it, k_t: the block of a, b is c_a c_b (k_n n nᵀ + k_t (1 − n nᵀ)) [dyn/cm]
    std::vector<Vec2i> between;                  ///< the two, as contact/primitives.h counts them: ascending

    std::size_t size() const { return vertices.size(); }
    bool empty() const { return vertices.empty(); }
};

/// What limiting the moves of one step took.
struct LimitReport {
    int listBuilds = 0;  ///< full and partial ones of the candidate list
    int blends = 0;      ///< pairs whose motion was blended towards their mean
    int scalings = 0;    ///< moves that had to be scaled as a whole: the last resort
};

/// Fabric against fabric with true thickness, (fabric/contact/README.md, Pairs): every pair has an offset of its own, taken from the rest
/// shape where that is nearer than the radii; moves are limited pair by pair, so that no committed move ever crosses.
/// Costs nothing per step but the check of the candidate list where no pair is near.
class FabricContact {
 public:
    /// @param cohesion  of liquid between wet fabric, taken up before each step; null without
    explicit FabricContact(const Fabric& fabric, const Cohesion* cohesion = nullptr);
    ~FabricContact();

    /// At the start of a step of length h [s]: stiffness of the pairs follows from the masses [g] and springStep [s] (springStepFor), friction
    /// acts against the motion since these positions and goes on from what is held.
    void beginStep(std::span<const Vec3> x, std::span<const double> mass, double h, double springStep, const FrictionForces& held = {});
    /// Shortens the moves u from x [cm], pair by pair, until going along them in a straight line is safe. Pinned vertices keep theirs
    /// unless everything has to be scaled.
    /// @return whether it changed any
    bool limit(std::span<const Vec3> x, std::span<Vec3> u, LimitReport& report, StageClock& clock);
    /// To be called once the fabric has been moved from x by the u of the last limit().
    void moved();
    /// Pairs that act at x, with force and stiffness.
    /// @param expected  moves of the vertices since the start of the step if forces act on as they did [cm], where x is a prediction
    const ActiveContacts& activeAt(std::span<const Vec3> x, StageClock& clock, std::span<const Vec3> expected = {});
    /// How far friction that acted between the pairs found last, up to x, is from what the normal forces that acted there have it, both
    /// according to their forces and stiffnesses: over all pairs, relative to what they can hold, and no less than to what gives their
    /// vertices an acceleration [cm/s^2]. Forces at x hardly tell: a small move changes what presses by as much as the load [-].
    double frictionError(std::span<const Vec3> x, double acceleration);
    /// What of the friction of the pairs found last is held at the end of the step, at x: what acted there according to their forces and
    /// stiffnesses.
    void storeFriction(std::span<const Vec3> x, FrictionForces& held);

    /// Energy that the pairs found last hold at x, in what presses and in the friction that is held there.
    ContactEnergy storedEnergy(std::span<const Vec3> x, const FrictionForces& held) const;

    std::size_t candidates() const;  ///< pairs in the list
    double leastDistance() const;    ///< of the candidates, relative to the distance at which they may touch; infinite without any [-]

 private:
    struct Parts;
    std::unique_ptr<Parts> parts_;
};

}  // namespace sim
