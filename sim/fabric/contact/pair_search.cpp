#include "sim/fabric/contact/pair_search.h"

#include "sim/core/check.h"
#include "sim/core/parallel.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>

namespace sim::contact {

namespace {

constexpr std::size_t kLeavesPerTask = 4;
/// For each edge, vertex and face of the fabric, on average [-]. A weave at rest has a dozen; with more than this it has burst, and would
/// fill the memory.
constexpr std::size_t kMostPairs = 500;

template <class Corners>
std::vector<int> flat(const Corners& corners)
{
    std::vector<int> all;
    for (const auto& c : corners) all.insert(all.end(), c.begin(), c.end());
    return all;
}

}  // namespace

/// Takes pairs whose boxes meet, eight of one kind at a time, and keeps those that are really near.
class PairSearch::Filter {
 public:
    Filter(const PairSearch& search, const Sweep& sweep, const RestPairs& restPairs, std::vector<FoundPair>& found)
        : search_(search), sweep_(sweep), restPairs_(restPairs), found_(found)
    {
    }

    void add(int a, int b)
    {
        if (!search_.primitives_.canTouch(a, b)) return;
        if (count_ > 0 && search_.primitives_.kind(a) != kind_) flush();
        kind_ = search_.primitives_.kind(a);
        first_[count_] = a, second_[count_] = b;
        const std::array<int, 4> v = search_.primitives_.vertices(a, b);
        for (std::size_t c = 0; c < 4; ++c) corner_[c][count_] = v[c];
        if (++count_ == kLanes) flush();
    }

    void flush()
    {
        if (count_ == 0) return;
        for (std::size_t lane = count_; lane < kLanes; ++lane)
            for (EightIndices& corner : corner_) corner[lane] = corner[0];
        std::array<Vec3T<Pack>, 4> x, u;
        for (std::size_t c = 0; c < 4; ++c) {
            x[c] = gather(sweep_.from, corner_[c]);
            u[c] = gather(sweep_.move, corner_[c]);
        }
        const Vec3T<Pack> apart = closestPoints(kind_, x).separation;
        const Pack least = sqrtPack(dot(apart, apart)) - relativeMotion(kind_, u);
        for (std::size_t lane = 0; lane < count_; ++lane) {
            const int a = first_[lane], b = second_[lane];
            if (!(least[lane] <= search_.reach_[a] + search_.reach_[b])) continue;
            const ContactDistances range = search_.primitives_.range(a, b, restPairs_.distanceOf(a, b));
            if (range.core > 0.0) found_.push_back({a, b, range});
        }
        count_ = 0;
    }

 private:
    const PairSearch& search_;
    const Sweep& sweep_;
    const RestPairs& restPairs_;
    std::vector<FoundPair>& found_;
    PairKind kind_ = PairKind::EdgeEdge;
    std::size_t count_ = 0;
    EightIndices first_{}, second_{};
    std::array<EightIndices, 4> corner_{};
};

PairSearch::PairSearch(const Primitives& primitives, std::span<const Vec3> rest) : primitives_(primitives)
{
    for (double r : primitives.radius) reach_.push_back(VerletMargin::reach(r));
    const auto reachOf = [&](int first, int count) { return std::vector<double>(reach_.begin() + first, reach_.begin() + first + count); };
    edges_ = BoxTree(flat(primitives.edges), 2, rest, reachOf(0, primitives.edgeCount));
    if (primitives.faceCount == 0) return;
    std::vector<int> all(primitives.vertexCount);
    for (int v = 0; v < primitives.vertexCount; ++v) all[v] = v;
    vertices_ = BoxTree(all, 1, rest, reachOf(primitives.firstVertex(), primitives.vertexCount));
    faces_ = BoxTree(flat(primitives.faces), 3, rest, reachOf(primitives.firstFace(), primitives.faceCount));
}

void PairSearch::listDirtyLeaves(Query query, const BoxTree& tree)
{
    for (int leaf = 0; leaf < tree.leaves(); ++leaf)
        if (tree.dirtyLanes(leaf) != 0) dirtyLeaves_.push_back({query, leaf});
}

void PairSearch::run(const Sweep& sweep, std::span<const char> dirtyVertices, const RestPairs& restPairs)
{
    edges_.refit(sweep, dirtyVertices);
    vertices_.refit(sweep, dirtyVertices);
    faces_.refit(sweep, dirtyVertices);

    dirtyLeaves_.clear();
    listDirtyLeaves(Query::EdgesToEdges, edges_);
    listDirtyLeaves(Query::VerticesToFaces, vertices_);
    const bool isAnyClean = std::ranges::any_of(dirtyVertices, [](char isDirty) { return isDirty == 0; });
    if (isAnyClean) listDirtyLeaves(Query::FacesToVertices, faces_);  // dirty vertices find their faces themselves
    tasks_ = (dirtyLeaves_.size() + kLeavesPerTask - 1) / kLeavesPerTask;
    if (found_.size() < tasks_) found_.resize(tasks_);
    const std::size_t most = kMostPairs * primitives_.count();
    std::atomic<std::size_t> all = 0;
    parallelFor(tasks_, [&](std::size_t task) {
        found_[task].clear();
        if (all > most) return;
        Filter filter(*this, sweep, restPairs, found_[task]);
        const std::size_t end = std::min(dirtyLeaves_.size(), (task + 1) * kLeavesPerTask);
        for (std::size_t i = task * kLeavesPerTask; i < end; ++i) searchFrom(dirtyLeaves_[i], filter);
        filter.flush();
        all += found_[task].size();
    });
    if (all > most)
        throw RunError(
            fmt::format("pieces of fabric have more than {} others near them on average, or would in this step: it has burst; "
                        "a smaller time step may help",
                        kMostPairs));
}

void PairSearch::searchFrom(const DirtyLeaf& dirty, Filter& filter) const
{
    const BoxTree& mine = dirty.query == Query::EdgesToEdges ? edges_ : dirty.query == Query::VerticesToFaces ? vertices_ : faces_;
    const BoxTree& other = dirty.query == Query::EdgesToEdges ? edges_ : dirty.query == Query::VerticesToFaces ? faces_ : vertices_;
    const unsigned myLanes = mine.dirtyLanes(dirty.leaf);
    const SweptBoxes& boxes = mine.leaf(dirty.leaf);
    other.forEachLeafNear(boxes.around(myLanes), [&](int leaf) {
        // Two dirty primitives meet once: edges from the one before in the tree, vertices and faces from the vertex.
        unsigned lanes = other.lanes(leaf);
        if (dirty.query == Query::FacesToVertices || (dirty.query == Query::EdgesToEdges && leaf < dirty.leaf)) lanes &= ~other.dirtyLanes(leaf);
        if (lanes == 0) return;
        const bool same = dirty.query == Query::EdgesToEdges && leaf == dirty.leaf;
        for (unsigned rest = myLanes; rest != 0; rest &= rest - 1) {
            const int lane = std::countr_zero(rest);
            unsigned near = other.leaf(leaf).touching(boxes.box(lane)) & lanes;
            if (same) near &= ~myLanes | (~1u << lane);
            for (; near != 0; near &= near - 1) {
                const int p = mine.primitive(dirty.leaf, lane), q = other.primitive(leaf, std::countr_zero(near));
                if (dirty.query == Query::EdgesToEdges) filter.add(std::min(p, q), std::max(p, q));
                else if (dirty.query == Query::VerticesToFaces) filter.add(primitives_.firstVertex() + p, primitives_.firstFace() + q);
                else filter.add(primitives_.firstVertex() + q, primitives_.firstFace() + p);
            }
        }
    });
}

}  // namespace sim::contact
