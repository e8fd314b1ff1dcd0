#pragma once

#include "sim/fabric/cohesion.h"
#include "sim/fabric/contact/covered_moves.h"
#include "sim/fabric/fabric.h"
#include "sim/fabric/vec3t.h"
#include "sim/settings.h"
#include "sim/stage.h"

#include <array>
#include <memory>
#include <span>
#include <vector>

namespace sim {

/// Begin and end, among the four vertices of a pair, of the two directions in it that tell how it turns: those of its edges, or two sides of its
/// face.
/// @param firstSide  vertices of its first side
constexpr std::array<std::array<int, 2>, 2> directionsOfPair(int firstSide)
{
    return firstSide == 2 ? std::array{std::array{0, 1}, std::array{2, 3}} : std::array{std::array{1, 2}, std::array{1, 3}};
}

/// Two unit vectors across a unit vector and each other (Duff et al. 2017, "Building an orthonormal basis, revisited").
template <class T>
std::array<Vec3T<T>, 2> tangentsOf(const Vec3T<T>& n)
{
    const T one = constant<T>(1.0), sign = signOf(n.z), a = -one / (sign + n.z), b = n.x * n.y * a;
    return {Vec3T<T>{one + sign * n.x * n.x * a, sign * b, -(sign * n.x)}, Vec3T<T>{b, sign + n.y * n.y * a, -n.y}};
}
inline std::array<Vec3, 2> tangentsOf(const Vec3& n)
{
    const std::array<Vec3T<double>, 2> t = tangentsOf(toVec3T(n));
    return {toVec3(t[0]), toVec3(t[1])};
}

/// Pairs of fabric primitives (edge-edge, vertex-face) close enough to push on each other; sorted, one array per quantity.
/// With c the weights and x the positions of its four vertices, a pair's separation is Σ c x. Its first side are the first two
/// vertices, or the first alone where a vertex meets a face.
///
/// Friction acts across the gap between the two: where it pushes them sideways it also turns them, and as the pair turns as a whole nothing slides
/// (PairTurn). How fast the two slide is Σ c v − Σ Λ (v_end − v_begin), over the two directions by which that turn is told; friction acts by the
/// transpose of it, so that it has no moment about the pair, and does the work that its slip takes.
struct ActiveContacts {
    /// What two turning directions do to the separation along the tangents t of its normal: Λ = Σ t λᵀ with λ by directions and tangents [-].
    using Lever = std::array<std::array<Vec3, 2>, 2>;

    std::vector<std::array<int, 4>> vertices;
    std::vector<std::uint8_t> firstSide;         ///< vertices of the first side: 2 or 1
    std::vector<std::array<double, 4>> weights;  ///< weights of both sides, those of the second negative: they sum to zero [-]
    std::vector<Vec3> normal;                    ///< unit, from the second side to the first
    std::vector<Vec3> force;                ///< dE/d(separation), with friction: its transpose of slip() is the gradient (forcesOnVertices) [dyn]
    std::vector<double> stiffness;          ///< along the normal, k_n [dyn/cm]
    std::vector<double> frictionStiffness;  ///< across it, k_t: with B of slip() the matrix is Bᵀ (k_n n nᵀ + k_t (1 − n nᵀ)) B [dyn/cm]
    std::vector<Lever> lever;               ///< how the turn of the pair moves its separation; of no account without friction
    std::vector<Vec2i> between;             ///< the two, as contact/primitives.h counts them: ascending

    std::size_t size() const { return vertices.size(); }
    bool empty() const { return vertices.empty(); }

    /// How the separation of pair i changes with moves of its vertices, but for what it turns as a whole: B u.
    /// @param move  of vertex v, a Vec3 [cm]
    template <class Move>
    Vec3 slip(std::size_t i, Move&& move) const
    {
        std::array<Vec3, 4> u;
        Vec3 sum = Vec3::Zero();
        for (int k = 0; k < 4; ++k) {
            u[k] = move(vertices[i][k]);
            sum += weights[i][k] * u[k];
        }
        if (!(frictionStiffness[i] > 0.0)) return sum;
        const auto ends = directionsOfPair(firstSide[i]);
        return sum - turned(i, {u[ends[0][1]] - u[ends[0][0]], u[ends[1][1]] - u[ends[1][0]]});
    }
    /// What changes of the pair's directions do to its separation: Σ Λ (change of end less begin).
    Vec3 turned(std::size_t i, const std::array<Vec3, 2>& change) const
    {
        const std::array<Vec3, 2> tangent = tangentsOf(normal[i]);
        Vec3 sum = Vec3::Zero();
        for (int j = 0; j < 2; ++j) sum += (lever[i][0][j].dot(change[0]) + lever[i][1][j].dot(change[1])) * tangent[j];
        return sum;
    }
    /// What a force on the separation of pair i is on its vertices: Bᵀ f.
    std::array<Vec3, 4> forcesOnVertices(std::size_t i, const Vec3& onPair) const
    {
        std::array<Vec3, 4> on;
        for (int k = 0; k < 4; ++k) on[k] = weights[i][k] * onPair;
        if (!(frictionStiffness[i] > 0.0)) return on;
        const auto ends = directionsOfPair(firstSide[i]);
        const std::array<Vec3, 2> tangent = tangentsOf(normal[i]);
        for (int n = 0; n < 2; ++n) {
            const Vec3 couple = tangent[0].dot(onPair) * lever[i][n][0] + tangent[1].dot(onPair) * lever[i][n][1];
            on[ends[n][0]] += couple;
            on[ends[n][1]] -= couple;
        }
        return on;
    }
};

/// What limiting the moves of one step took.
struct LimitReport {
    int candidateListBuilds = 0;  ///< full and partial ones of the candidate list
    int blends = 0;               ///< pairs whose motion was blended towards their mean
    int globalScalings = 0;       ///< moves that had to be scaled as a whole: the last resort
};

/// Fabric against fabric with true thickness, (fabric/contact/README.md, Pairs): every pair has an offset of its own, taken from the rest
/// shape where that is nearer than the radii; moves are limited pair by pair, so that no committed move ever crosses.
/// Costs nothing per step but the check of the candidate list where no pair is near.
class FabricContact {
    struct Parts;

 public:
    /// @param cohesion  of liquid between wet fabric, taken up before each step; null without
    explicit FabricContact(const Fabric& fabric, const Cohesion* cohesion = nullptr);
    ~FabricContact();

    /// At the start of a step of length h [s]: stiffness of the pairs follows from the masses [g] and springStep [s] (springStepFor), friction
    /// acts against the motion since these positions and goes on from what is held.
    void beginStep(std::span<const Vec3> x, std::span<const double> mass, double h, double springStep, const FrictionForces& held = {});
    /// Token that moves are safe, and that the pairs which they bring near are known.
    class LimitedMoves {
     public:
        bool wereChanged() const { return wereChanged_; }

     private:
        friend FabricContact;
        LimitedMoves(const contact::CoveredMoves& covered, bool wereChanged) : covered_(covered), wereChanged_(wereChanged) {}
        contact::CoveredMoves covered_;
        bool wereChanged_;
    };
    /// Shortens the moves u from x [cm], pair by pair, until going along them in a straight line is safe. Pinned vertices keep theirs
    /// unless everything has to be scaled.
    LimitedMoves limit(std::span<const Vec3> x, std::span<Vec3> u, LimitReport& report, StageClock& clock);
    /// The fabric has been moved from x by the moves u that were limited last.
    void moved(const LimitedMoves& moves);
    /// Pairs that act where they were looked for, until others are.
    class Active {
     public:
        const ActiveContacts& pairs() const { return *pairs_; }
        /// How far friction that acted between the pairs, up to x, is from what the normal forces that acted there have it, both according to
        /// their forces and stiffnesses: over all pairs, relative to what they can hold, and no less than to what gives their vertices an
        /// acceleration [cm/s^2]. Forces at x hardly tell: a small move changes what presses by as much as the load [-].
        double frictionError(std::span<const Vec3> x, double acceleration) const;
        /// What of their friction is held at the end of the step, at x: what acted there according to their forces and stiffnesses.
        void storeFriction(std::span<const Vec3> x, FrictionForces& held) const;
        /// Energy that they hold at x, in what presses and in the friction that is held there.
        ContactEnergy storedEnergy(std::span<const Vec3> x, const FrictionForces& held) const;

     private:
        friend FabricContact;
        Active(Parts& parts, const ActiveContacts& pairs) : parts_(&parts), pairs_(&pairs) {}
        Parts* parts_;
        const ActiveContacts* pairs_;
    };
    /// Pairs that act at x, with force and stiffness.
    /// @param expected  moves of the vertices since the start of the step if forces act on as they did [cm], where x is a prediction
    Active activeAt(std::span<const Vec3> x, StageClock& clock, std::span<const Vec3> expected = {});

    std::size_t candidates() const;  ///< pairs in the list
    double leastDistance() const;    ///< least distance of the candidates, relative to that at which they may touch; infinite without any [-]

 private:
    std::unique_ptr<Parts> parts_;
};

}  // namespace sim
