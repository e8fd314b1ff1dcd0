#pragma once

#include "sim/fabric/contact/pair_search.h"

#include <limits>
#include <span>
#include <vector>

namespace sim::contact {

/// Pairs, one array per quantity, sorted by (a, b): edges with edges first, then vertices with faces.
struct Candidates {
    std::vector<int> begin;                         ///< of each first primitive, and the end
    AlignedArray<int> a, b;
    AlignedArray<std::array<int, 4>> vertices;
    AlignedArray<double> reach, core;               ///< as in PairRange [cm]
    AlignedArray<double> distance;                  ///< of the two where they were last measured [cm]
    AlignedArray<double> p, q;                      ///< and their nearest points (Closest)

    std::size_t size() const { return a.size(); }
    PairRange range(std::size_t i) const { return {reach[i], core[i]}; }
    void resize(std::size_t n);
    void copy(std::size_t to, const Candidates& other, std::size_t from);
};

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
    const Candidates& pairs() const { return pairs_; }
    bool empty() const { return pairs_.size() == 0; }
    PairKind kind(std::size_t pair) const { return primitives_.kind(pairs_.a[pair]); }

 private:
    bool cover(std::span<const Vec3> x, std::span<const Vec3> u);
    int findStrays(std::span<const Vec3> x, std::span<const Vec3> u);
    void build();
    void markDirtyPrimitives();
    void sortFound();
    void merge();
    void findRestPairs(std::span<const Vec3> rest);

    Primitives primitives_;
    PairSearch search_;
    RestPairs restPairs_;
    std::vector<double> stray_, strayAtRest_;   ///< of each vertex (ListMargin) [cm]

    bool built_ = false;
    Sweep sweep_;                               ///< for which each vertex's pairs were searched, moved along since
    std::vector<char> dirtyVertices_, dirty_;   ///< of vertices, of primitives
    Candidates pairs_, next_;
    std::vector<int> foundBegin_, foundNext_;   ///< of each first primitive in …
    std::vector<FoundPair> found_;              ///< … all that was found, sorted

    bool measured_ = false;                     ///< all pairs but the fresh ones, at measuredAt_
    Points measuredAt_;
    std::vector<int> fresh_;                    ///< pairs found since they were measured
};

}  // namespace sim::contact
