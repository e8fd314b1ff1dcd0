#pragma once

#include "sim/fabric/contact/pair_search.h"

#include <vector>

namespace sim::contact {

/// Pairs of one kind, one array per quantity, in no particular order: pairs that are dropped leave their places to new ones.
struct CandidatePool {
    explicit CandidatePool(PairKind k) : kind(k) {}

    PairKind kind;
    AlignedArray<int> a, b;
    AlignedArray<std::array<int, 4>> vertices;
    AlignedArray<double> reach, core;  ///< distances of each pair as in ContactDistances [cm]
    AlignedArray<double> distance;     ///< distance of the two primitives where they were last measured [cm]
    AlignedArray<double> p, q;         ///< nearest points of the two primitives (Closest)
    std::vector<int> unmeasured;       ///< places of pairs that have not been measured yet

    std::size_t size() const { return a.size(); }
    ContactDistances range(std::size_t i) const { return {reach[i], core[i]}; }

    /// Asks for a pair that will be described.
    void prefetch(std::size_t i) const
    {
        __builtin_prefetch(&vertices[i]);
        for (const AlignedArray<double>* quantity : {&reach, &core, &distance, &p, &q}) __builtin_prefetch(&(*quantity)[i]);
    }

    /// Drops the pairs of dirty primitives and takes in those of its kind that a search found.
    void replace(const Primitives& primitives, std::span<const char> dirty, const PairSearch& search);
    void clear();
    /// @param all  or only the fresh ones
    void measure(const Points& x, bool all);

 private:
    void resize(std::size_t n);
    void set(std::size_t place, const FoundPair& pair, const Primitives& primitives);
    void moveTo(std::size_t place, std::size_t from);

    std::vector<int> dropped_, holes_;
    std::vector<const FoundPair*> found_;
};

/// A pair in its pool, to be sorted.
struct PairPlace {
    int a, b;
    int place;
};

/// Sorts pairs by a, then b: what is summed or pushed in this order comes out the same wherever the pairs lie in their pools.
class PairSorter {
 public:
    /// @param firsts  all a are below it
    void sort(std::vector<PairPlace>& pairs, int firsts);

 private:
    std::vector<int> next_;
    std::vector<PairPlace> sorted_;
};

}  // namespace sim::contact
