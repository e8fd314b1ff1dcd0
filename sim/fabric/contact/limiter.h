#pragma once

#include "sim/fabric/contact/candidate_list.h"
#include "sim/fabric/contact/contact.h"

#include <span>
#include <vector>

namespace sim::contact {

/// Makes moves safe in the relative motion of each pair, never in the absolute one (fabric/contact/README.md, Limiter).
class Limiter {
 public:
    explicit Limiter(const Primitives& primitives);

    /// @param inverseMass  of each vertex; 0 = held [1/g]
    void setMasses(std::span<const double> inverseMass) { inverseMass_ = inverseMass; }
    /// Moves that are safe, and whether they had to be changed.
    struct Limited {
        CoveredMoves moves;
        bool wereChanged;
    };
    Limited limit(std::span<const Vec3> x, std::span<Vec3> u, CandidateList& list, LimitReport& report, StageClock& clock);

 private:
    /// A pair that the move brings near.
    struct ApproachingPair {
        PairKind kind;
        std::array<int, 4> vertices;
        std::array<double, 4> weights;
        Vec3 normal;        ///< unit vector from the second to the first [-]
        double allowed;     ///< approach along the normal that is left alone [cm]
        double compliance;  ///< Σ c² / m of the free vertices [1/g]
        double separation;  ///< least distance on the way [cm]
        double radii;       ///< sum of the two radii [cm]
    };

    CoveredMoves cover(std::span<const Vec3> x, std::span<const Vec3> u, CandidateList& list, LimitReport& report, StageClock& clock);
    void findApproaching(std::span<const Vec3> x, std::span<const Vec3> u, const CandidateList& list);
    void motionOfPrimitives(std::span<const Vec3> u);
    void findApproaching(std::span<const Vec3> x, std::span<const Vec3> u, const CandidatePool& pairs);
    ApproachingPair closing(std::span<const Vec3> x, const CandidatePool& pairs, int place) const;
    int projectApproach(std::span<Vec3> u, bool& changed);
    double measureFractions(std::span<const Vec3> x, std::span<const Vec3> u);
    int averageFailingPairs(std::span<Vec3> u) const;

    const Primitives& primitives_;
    std::span<const double> inverseMass_;
    Points motion_;                ///< mean move of each primitive's vertices, and as the fourth their largest distance from it [cm]
    std::vector<PairPlace> near_;  ///< pairs that the quick look left, by chunks
    std::vector<PairPlace> places_;
    PairSorter sorter_;
    std::vector<ApproachingPair> approaching_;  ///< sorted: edges with edges first
    std::vector<double> fraction_;              ///< safe part of each pair's move [0..1]
};

/// Safe part of the move u of four vertices: on the way to it they never come nearer than `separation` [cm].
/// Common motion does not count. Source: Li et al. 2021, "Codimensional Incremental Potential Contact", additive CCD.
double collisionFreeFraction(PairKind kind, const std::array<Vec3, 4>& x, const std::array<Vec3, 4>& u, double separation);

}  // namespace sim::contact
