#pragma once

#include "sim/fabric/contact/candidate_pool.h"

#include <limits>
#include <span>
#include <vector>

namespace sim::contact {

/// The pairs that may act or be hit, kept from move to move: only those of vertices that stray are searched anew.
/// Whatever its past, it holds all pairs that act at x or that the move u brings near (ListMargin); others among them are inactive.
class CandidateList {
 public:
    explicit CandidateList(const Fabric& fabric);
    CandidateList(const CandidateList&) = delete;

    /// Makes the list good for where the fabric is.
    /// @return whether it had to be built
    bool coverPlace(std::span<const Vec3> x) { return cover(x, {}); }
    /// Makes it good for the moves u from x as well [cm].
    bool coverMove(std::span<const Vec3> x, std::span<const Vec3> u) { return cover(x, u); }
    /// The fabric has been moved by the moves last covered.
    void moved();
    /// Brings distances up to x.
    void measure(std::span<const Vec3> x);

    const Primitives& primitives() const { return primitives_; }
    const RestPairs& restPairs() const { return restPairs_; }
    const CandidatePool& edgePairs() const { return edgePairs_; }
    const CandidatePool& facePairs() const { return facePairs_; }
    std::size_t size() const { return edgePairs_.size() + facePairs_.size(); }
    bool empty() const { return size() == 0; }

 private:
    bool cover(std::span<const Vec3> x, std::span<const Vec3> u);
    int findStrays(std::span<const Vec3> x, std::span<const Vec3> u);
    void build();
    void markDirtyPrimitives();
    void findRestPairs(std::span<const Vec3> rest);

    Primitives primitives_;
    PairSearch search_;
    RestPairs restPairs_;
    std::vector<double> stray_, strayAtRest_;   ///< of each vertex (ListMargin) [cm]

    bool built_ = false;
    Sweep sweep_;                               ///< for which each vertex's pairs were searched, moved along since
    std::vector<char> dirtyVertices_, dirty_;   ///< of vertices, of primitives
    CandidatePool edgePairs_{PairKind::EdgeEdge}, facePairs_{PairKind::VertexFace};

    bool measured_ = false;                     ///< all pairs but the fresh ones, at measuredAt_
    Points measuredAt_;
};

}  // namespace sim::contact
