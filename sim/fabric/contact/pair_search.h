#pragma once

#include "sim/fabric/cohesion.h"
#include "sim/fabric/contact/box_tree.h"
#include "sim/fabric/contact/primitives.h"
#include "sim/fabric/contact/rest_pairs.h"

#include <vector>

namespace sim::contact {

/// Two primitives that may touch soon.
struct FoundPair {
    int a, b;  ///< as Primitives numbers them, a < b
    ContactDistances range;
};

/// Margins of the Verlet list of pairs: how far two primitives may be apart and still make a candidate, and how far vertices may drift before
/// a pair could be missed (fabric/contact/README.md, Margins).
struct VerletMargin {
    static constexpr double kMargin = 0.7;  ///< distance beyond the largest reach of a pair, of each side's radius [-]
    static double reach(double radius) { return (kMostReach + kMargin) * radius; }
    static double drift(double radius) { return (kMostReach + kMargin - kMostFloor) / (1.0 + 5.0 / 3.0) * radius; }
    static double driftAtRest(double radius) { return kMargin * radius; }
    /// Half of the length of a bridge at most: that is kBridgeLength of the thinner one's radius.
    static double bridge(double radius) { return 0.5 * kBridgeLength * radius; }
    static_assert(kMostReach + kMargin > kMostFloor, "vertices may stray before a pair is missed");
};

/// Finds pairs of which one at least has a dirty vertex.
class PairSearch {
 public:
    PairSearch(const Primitives& primitives, std::span<const Vec3> rest);

    /// All pairs of a dirty primitive with d(from) − (relative motion) within the reach of both, each once, in any order.
    void run(const Sweep& sweep, std::span<const char> dirtyVertices, const RestPairs& restPairs);

    std::size_t tasks() const { return tasks_; }
    const std::vector<FoundPair>& found(std::size_t task) const { return found_[task]; }

 private:
    enum class Query { EdgesToEdges, VerticesToFaces, FacesToVertices };
    struct DirtyLeaf {
        Query query;
        int leaf;
    };
    class Filter;
    void listDirtyLeaves(Query query, const BoxTree& tree);
    void searchFrom(const DirtyLeaf& dirty, Filter& filter) const;

    const Primitives& primitives_;
    std::vector<double> reach_;  ///< VerletMargin::reach of each primitive [cm]
    BoxTree edges_, vertices_, faces_;
    std::vector<DirtyLeaf> dirtyLeaves_;
    std::size_t tasks_ = 0;
    std::vector<std::vector<FoundPair>> found_;
};

}  // namespace sim::contact
