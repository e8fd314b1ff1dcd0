#include "sim/core/parallel.h"
#include "sim/fabric/contact/candidate_pool.h"

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
    std::array<Vec3T<Pack>, 4> corners;
    for (std::size_t c = 0; c < 4; ++c) corners[c] = gather(x, vertices[c]);
    const Closest<Pack> closest = closestPoints(kKind, corners);
    result = {sqrtPack(dot(closest.separation, closest.separation)), closest.p, closest.q};
}

/// Measures the pairs slot(0) … slot(n − 1), all of one kind, n ≤ 8.
template <PairKind kKind, class Slot>
Measured measurePairs(const Points& x, const CandidatePool& pairs, std::size_t n, Slot&& slot)
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
void measureFollowing(const Points& x, std::size_t first, std::size_t n, CandidatePool& pairs)
{
    const Measured m = measurePairs<kKind>(x, pairs, n, [&](std::size_t i) { return first + i; });
    storeFirst(&pairs.distance[first], m.distance, static_cast<int>(n));
    storeFirst(&pairs.p[first], m.p, static_cast<int>(n));
    storeFirst(&pairs.q[first], m.q, static_cast<int>(n));
}

template <PairKind kKind>
void measureListed(const Points& x, const int* slots, std::size_t n, CandidatePool& pairs)
{
    const Measured m = measurePairs<kKind>(x, pairs, n, [&](std::size_t i) { return slots[i]; });
    for (std::size_t lane = 0; lane < n; ++lane) {
        pairs.distance[slots[lane]] = m.distance[lane];
        pairs.p[slots[lane]] = m.p[lane];
        pairs.q[slots[lane]] = m.q[lane];
    }
}

/// body(first, n) for the runs of at most eight in [0, count).
template <class Body>
void forEachPack(std::size_t count, Body&& body)
{
    parallelFor((count + kLanes - 1) / kLanes, kPacksPerTask, [&](std::size_t pack) {
        const std::size_t first = pack * kLanes;
        body(first, std::min<std::size_t>(kLanes, count - first));
    });
}

template <PairKind kKind>
void measurePool(const Points& x, bool all, CandidatePool& pairs)
{
    if (all) forEachPack(pairs.size(), [&](std::size_t first, std::size_t n) { measureFollowing<kKind>(x, first, n, pairs); });
    else forEachPack(pairs.unmeasured.size(), [&](std::size_t first, std::size_t n) { measureListed<kKind>(x, &pairs.unmeasured[first], n, pairs); });
}

}  // namespace

void CandidatePool::measure(const Points& x, bool all)
{
    if (kind == PairKind::EdgeEdge) measurePool<PairKind::EdgeEdge>(x, all, *this);
    else measurePool<PairKind::VertexFace>(x, all, *this);
    unmeasured.clear();
}

}  // namespace sim::contact
