#pragma once

#include "sim/fabric/contact/candidate_list.h"
#include "sim/fabric/contact/contact.h"
#include "sim/fabric/contact/limiter.h"
#include "sim/fabric/contact/pair_energy.h"
#include "sim/fabric/friction_law.h"

namespace sim {

/// What FabricContact is made of: the pairs that act (contact.cpp), the friction between them (pair_friction.cpp), and the bridges of liquid
/// (bridges.cpp).
struct FabricContact::Parts {
    Parts(const Fabric& fabric, const Cohesion* c) : cohesion(c), list(fabric, c != nullptr), limiter(list.primitives()), start(fabric.rest) {}

    /// What the friction of an active pair goes by.
    struct FrictionPair {
        contact::ContactDistances range;
        Vec3 apart;                      ///< separation where it was looked at last [cm]
        std::array<Vec3, 2> directions;  ///< ends less begins of the pair's directions there [cm]
        double stiffness;                ///< stiffness of the pair [dyn/cm]
        double perStep;                  ///< mean mass of its vertices over springStep² [dyn/cm]
        double coefficient;              ///< Coulomb's [-]
        bool slides;                     ///< friction is at its bound
        double bridge = 0.0;             ///< longest length of its liquid bridge beyond the reach [cm]
        double pull = 0.0;               ///< force of its liquid bridge [dyn]
    };
    /// What acted on an active pair where it went from where it was looked at, by its force and stiffness.
    struct Acted {
        Vec3 apart;     ///< separation [cm]
        Vec3 friction;  ///< [dyn]
        double bound;   ///< bound of friction [dyn]
    };

    bool bridges() const { return cohesion && cohesion->isOnFabric(); }
    void findActive(const contact::CandidatePool& pairs, std::vector<contact::PairPlace>& found);
    void describe(std::span<const Vec3> x, std::span<const Vec3> expected, const contact::CandidatePool& pairs,
                  std::span<const contact::PairPlace> places, std::size_t first);
    void describe(std::span<const Vec3> x, std::span<const Vec3> expected, const contact::CandidatePool& pairs, std::size_t place, std::size_t slot);
    Friction friction(std::span<const Vec3> x, std::span<const Vec3> expected, const contact::PairEnergy& energy, double distance, std::size_t slot);
    double mobility(std::size_t slot) const;
    void resizeActive(std::size_t n);
    void findHeld();
    void keepFound(std::span<const Vec3> x);
    void findPress();
    double pressOf(std::size_t slot, std::span<const Vec3> x) const;
    template <class Body>
    void forEachKnown(std::span<const Vec2i> between, Body&& body) const;
    template <class Body>
    void forEachSeeker(Body&& body) const;
    double bridgeForceOf(int seeker, std::size_t i, std::span<const Vec3> x) const;
    void findBridges(std::span<const Vec3> x);
    std::array<Vec3, 2> directionsAt(std::span<const Vec3> x, std::size_t slot) const;
    Acted actedOn(std::size_t i, std::span<const Vec3> x) const;
    double touchingMass();

    const Cohesion* cohesion;  ///< liquid bridges; null without
    contact::CandidateList list;
    contact::Limiter limiter;
    std::vector<Vec3> start;                               ///< positions at the start of the step [cm]
    std::vector<double> mass, inverseMass;                 ///< [g, 1/g]
    double h = 0.0, springStep = 0.0;                      ///< [s]
    std::vector<contact::PairPlace> acting;                ///< pairs that act, by chunks
    std::vector<contact::PairPlace> edgePairs, facePairs;  ///< pairs that act, sorted
    contact::PairSorter sorter;
    ActiveContacts active;
    std::vector<FrictionPair> frictionPairs;  ///< friction of the active pairs
    FrictionForces held;                      ///< friction that is held at the start of the step
    std::vector<Vec3> heldForce;              ///< force of friction that is held on the active pairs [dyn]
    bool isLookedAt = false;                  ///< whether pairs have been looked for in this step
    std::vector<Vec2i> foundBetween;          ///< pairs of the last iteration
    std::vector<double> foundPress;           ///< normal forces that it found for them [dyn]
    std::vector<double> press;                ///< those of the active pairs, as far as they are known, or NaN [dyn]
    std::vector<char> isTouching;             ///< whether each vertex touches
    std::vector<int> nearest, opposite;       ///< active pair of each yarn edge's and vertex' bridge, and of one on its other side; or −1
    std::vector<Vec3> keptForce;              ///< force of friction on the active pairs at the end of the step [dyn]
};

}  // namespace sim
