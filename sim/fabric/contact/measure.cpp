#include "sim/core/parallel.h"
#include "sim/fabric/contact/candidate_list.h"

#include <algorithm>

namespace sim::contact {

namespace {

constexpr std::size_t kPacksPerTask = 128;

struct Measured {
    Pack distance, p, q;
};

/// Never in line: wherever a pair is measured, and beside which others, it comes out the same to the last bit.
template <PairKind kKind>
[[gnu::noinline]] void measureEight(const Points& x, const std::array<EightIndices, 4>& vertices, Measured& result)
{
    std::array<Triple<Pack>, 4> corners;
    for (std::size_t c = 0; c < 4; ++c) corners[c] = gather(x, vertices[c]);
    const Closest<Pack> closest = closestPoints(kKind, corners);
    result = {sqrtPack(dot(closest.separation, closest.separation)), closest.p, closest.q};
}

/// Measures the pairs slot(0) … slot(n − 1), all of one kind, n ≤ 8.
template <PairKind kKind, class Slot>
Measured measurePairs(const Points& x, const Candidates& pairs, std::size_t n, Slot&& slot)
{
    std::array<EightIndices, 4> vertices;
    for (std::size_t lane = 0; lane < kLanes; ++lane) {
        const std::array<int, 4>& v = pairs.vertices[slot(std::min(lane, n - 1))];
        for (std::size_t c = 0; c < 4; ++c) vertices[c][lane] = v[c];
    }
    Measured result;
    measureEight<kKind>(x, vertices, result);
    return result;
}

template <PairKind kKind>
void measureFollowing(const Points& x, std::size_t first, std::size_t n, Candidates& pairs)
{
    const Measured m = measurePairs<kKind>(x, pairs, n, [&](std::size_t i) { return first + i; });
    storeFirst(&pairs.distance[first], m.distance, static_cast<int>(n));
    storeFirst(&pairs.p[first], m.p, static_cast<int>(n));
    storeFirst(&pairs.q[first], m.q, static_cast<int>(n));
}

template <PairKind kKind>
void measureListed(const Points& x, const int* slots, std::size_t n, Candidates& pairs)
{
    const Measured m = measurePairs<kKind>(x, pairs, n, [&](std::size_t i) { return slots[i]; });
    for (std::size_t lane = 0; lane < n; ++lane) {
        pairs.distance[slots[lane]] = m.distance[lane];
        pairs.p[slots[lane]] = m.p[lane];
        pairs.q[slots[lane]] = m.q[lane];
    }
}

/// body(first, n) for the runs of at most eight in [begin, end).
template <class Body>
void forEachPack(std::size_t begin, std::size_t end, Body&& body)
{
    parallelFor((end - begin + kLanes - 1) / kLanes, kPacksPerTask, [&](std::size_t pack) {
        const std::size_t first = begin + pack * kLanes;
        body(first, std::min<std::size_t>(kLanes, end - first));
    });
}

}  // namespace

void CandidateList::measure(std::span<const Vec3> x)
{
    const bool stands = measured_ && parallelReduce(
                                         x.size(), true, [&](std::size_t v) { return x[v] == measuredAt_[v]; },
                                         [](bool a, bool b) { return a && b; });
    if (stands) {
        const auto edgesEnd = std::ranges::lower_bound(fresh_, pairs_.begin[primitives_.edgeCount]);
        const std::size_t edges = edgesEnd - fresh_.begin();
        forEachPack(0, edges, [&](std::size_t first, std::size_t n) {
            measureListed<PairKind::EdgeEdge>(measuredAt_, &fresh_[first], n, pairs_);
        });
        forEachPack(edges, fresh_.size(), [&](std::size_t first, std::size_t n) {
            measureListed<PairKind::VertexFace>(measuredAt_, &fresh_[first], n, pairs_);
        });
    } else {
        parallelFor(x.size(), 1024, [&](std::size_t v) { measuredAt_.set(v, x[v]); });
        const std::size_t edges = pairs_.begin[primitives_.edgeCount];
        forEachPack(0, edges, [&](std::size_t first, std::size_t n) {
            measureFollowing<PairKind::EdgeEdge>(measuredAt_, first, n, pairs_);
        });
        forEachPack(edges, pairs_.size(), [&](std::size_t first, std::size_t n) {
            measureFollowing<PairKind::VertexFace>(measuredAt_, first, n, pairs_);
        });
    }
    fresh_.clear();
    measured_ = true;
}

}  // namespace sim::contact
