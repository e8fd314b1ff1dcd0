#pragma once

#include "sim/fabric/contact/candidate_pool.h"
#include "sim/fabric/contact/covered_moves.h"

#include <limits>
#include <span>
#include <vector>

namespace sim::contact {

/// Verlet list of the pairs that may act or be hit, kept from move to move: only those of vertices that have drifted are searched anew. At
/// the start of a step they are searched along the moves of some steps ahead, as if vertices went on; where they do,
/// the next steps find their pairs there. Whatever its past, it holds all pairs that act at x or that the move u brings
/// near (VerletMargin); others among them are inactive.
class CandidateList {
 public:
    /// @param bridges  it holds all pairs within the length of liquid bridges as well
    explicit CandidateList(const Fabric& fabric, bool bridges = false);
    CandidateList(const CandidateList&) = delete;

    /// The moves covered from now on, until the fabric is moved, are those by which a step begins.
    void beginStep();
    /// Makes the list good for where the fabric is.
    /// @return whether it had to be built
    bool coverPositions(std::span<const Vec3> x) { return cover(x, {}); }
    /// Makes it good for the moves u from x as well [cm].
    CoveredMoves coverMoves(std::span<const Vec3> x, std::span<const Vec3> u) { return CoveredMoves(cover(x, u)); }
    /// The fabric has been moved by the moves that were covered last.
    void moved(const CoveredMoves&);
    /// Brings distances up to x.
    void measure(std::span<const Vec3> x);

    const Primitives& primitives() const { return primitives_; }
    const RestPairs& restPairs() const { return restPairs_; }
    /// How long a liquid bridge between the two may be beyond their reach [cm]; none holds parts of one yarn or cloth that are about as near
    /// at rest.
    double bridge(int a, int b) const
    {
        const double length = primitives_.bridge(a, b), reach = primitives_.radius[a] + primitives_.radius[b] + primitives_.band(a, b);
        const bool isNear = primitives_.areOfOnePiece(a, b) && restPairs_.distanceOf(a, b) < reach + kNearAtRest * length;
        return isNear ? 0.0 : length;
    }
    const CandidatePool& edgePairs() const { return edgePairs_; }
    const CandidatePool& facePairs() const { return facePairs_; }
    std::size_t size() const { return edgePairs_.size() + facePairs_.size(); }
    bool empty() const { return size() == 0; }

 private:
    static constexpr double kNearAtRest = 2.0;  ///< lengths of a bridge [-]

    bool cover(std::span<const Vec3> x, std::span<const Vec3> u);
    int findDrifted(std::span<const Vec3> x, std::span<const Vec3> u, int moves);
    int stepsToLookAhead(std::span<const Vec3> u) const;
    Vec3 expected(std::size_t v) const { return isStepStart_ ? ahead_[v] : sweep_.move[v]; }
    void setDirty(std::size_t v, const Vec3& x, const Vec3& move);
    void build();
    void markDirtyPrimitives();
    void findRestPairs(std::span<const Vec3> rest);

    Primitives primitives_;
    bool bridges_;
    PairSearch search_;
    RestPairs restPairs_;
    std::vector<double> drift_, driftAtRest_;  ///< VerletMargin of each vertex [cm]

    bool built_ = false;
    Sweep sweep_;  ///< places from where each vertex's pairs are known, and the moves to search along
    bool isStepStart_ = false;
    int stepsAhead_ = 0;                       ///< whose first moves the list is good for
    Points ahead_;                             ///< the first expected move of each of the steps ahead [cm]
    std::vector<char> drifted_;                ///< whether each vertex' pairs were searched at one place since, without the steps ahead
    std::vector<char> dirtyVertices_, dirty_;  ///< whether vertices and primitives are dirty
    CandidatePool edgePairs_{PairKind::EdgeEdge}, facePairs_{PairKind::VertexFace};

    bool measured_ = false;  ///< all pairs but the fresh ones, at measuredAt_
    Points measuredAt_;
};

}  // namespace sim::contact
