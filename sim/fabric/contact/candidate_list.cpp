#include "sim/fabric/contact/candidate_list.h"

#include "sim/core/parallel.h"

#include <algorithm>
#include <utility>

namespace sim::contact {

namespace {

/// With more dirty vertices than this all are searched for: it is not worth keeping the rest [-].
constexpr double kMostDirty = 0.6;
/// How far ahead pairs are searched: as many steps, and the fastest vertex goes no farther than so many times what it
/// may stray [-]. By measurement, of 6, 12 and 40: with more, lists of yarns in steps of 1e-3 s grow by what they save.
constexpr int kMostStepsAhead = 16;
constexpr double kFarAhead = 12.0;

/// Radius of the thinnest primitive that each vertex belongs to [cm].
std::vector<double> leastRadius(const Primitives& p)
{
    std::vector<double> r(p.radius.begin() + p.firstVertex(), p.radius.begin() + p.firstFace());
    for (int e = 0; e < p.edgeCount; ++e)
        for (int v : p.edges[e]) r[v] = std::min(r[v], p.radius[e]);
    for (int f = 0; f < p.faceCount; ++f)
        for (int v : p.faces[f]) r[v] = std::min(r[v], p.radius[p.firstFace() + f]);
    return r;
}

}  // namespace

CandidateList::CandidateList(const Fabric& fabric, bool bridges) : primitives_(fabric), bridges_(bridges), search_(primitives_, fabric.rest)
{
    const std::size_t n = fabric.vertexCount();
    for (double r : leastRadius(primitives_)) {
        drift_.push_back(VerletMargin::drift(r));
        driftAtRest_.push_back(VerletMargin::driftAtRest(r) - (bridges ? VerletMargin::bridge(r) : 0.0));
    }
    sweep_.from.resize(n), sweep_.move.resize(n), measuredAt_.resize(n), ahead_.resize(n);
    dirtyVertices_.resize(n), drifted_.resize(n);
    dirty_.resize(primitives_.count());
    findRestPairs(fabric.rest);
}

void CandidateList::findRestPairs(std::span<const Vec3> rest)
{
    coverPositions(rest);
    measure(rest);
    std::vector<PairPlace> places;
    RestPairs found;
    found.begin = {0};
    PairSorter sorter;
    for (const CandidatePool* pool : {&edgePairs_, &facePairs_}) {
        places.clear();
        for (std::size_t i = 0; i < pool->size(); ++i)
            if (pool->distance[i] < pool->reach[i] + (bridges_ ? kNearAtRest * primitives_.bridge(pool->a[i], pool->b[i]) : 0.0))
                places.push_back({pool->a[i], pool->b[i], static_cast<int>(i)});
        sorter.sort(places, primitives_.firstFace());
        for (const PairPlace& pair : places) {
            found.begin.resize(pair.a + 1, static_cast<int>(found.partner.size()));
            found.partner.push_back(pair.b);
            found.distance.push_back(pool->distance[pair.place]);
        }
    }
    found.begin.resize(primitives_.firstFace() + 1, static_cast<int>(found.partner.size()));
    restPairs_ = std::move(found);
    built_ = false;
}

void CandidateList::beginStep()
{
    isStepStart_ = true;
    if (stepsAhead_ > 0) return;
    // All pairs are known where the fabric is, for no move.
    parallelFor(drifted_.size(), kGrain, [&](std::size_t v) {
        ahead_.set(v, Vec3::Zero());
        drifted_[v] = 0;
    });
}

bool CandidateList::cover(std::span<const Vec3> x, std::span<const Vec3> u)
{
    const bool looksAhead = isStepStart_ && stepsAhead_ == 0;
    if (looksAhead) stepsAhead_ = stepsToLookAhead(u);
    const int strays = findDrifted(x, u, looksAhead ? stepsAhead_ : 1);
    if (strays == 0) return false;
    if (!built_ || strays > kMostDirty * static_cast<double>(x.size())) {
        stepsAhead_ = isStepStart_ ? stepsToLookAhead(u) : 0;
        parallelFor(x.size(), kGrain, [&](std::size_t v) { setDirty(v, x[v], u.empty() ? Vec3::Zero().eval() : u[v]); });
    }
    build();
    return true;
}

int CandidateList::stepsToLookAhead(std::span<const Vec3> u) const
{
    const double largest = parallelMax(u.size(), [&](std::size_t v) { return u[v].norm() / drift_[v]; });
    int steps = 1;
    while (steps < kMostStepsAhead && (steps + 1) * largest <= kFarAhead) ++steps;
    return steps;
}

/// Vertices too far from where their pairs were searched, or that would be after so many moves, become dirty and start
/// from here.
int CandidateList::findDrifted(std::span<const Vec3> x, std::span<const Vec3> u, int moves)
{
    const std::vector<double>& limit = u.empty() ? driftAtRest_ : drift_;
    const Chunks chunks(x.size());
    std::array<int, kMaxChunks> strays{};
    parallelFor(chunks.count(), [&](std::size_t c) {
        for (std::size_t v = chunks.begin(c); v < chunks.end(c); ++v) {
            const double most = limit[v] * limit[v];
            const Vec3 move = u.empty() ? Vec3::Zero().eval() : u[v];
            const bool isKnown = built_ && !(isStepStart_ && drifted_[v]);
            const bool stays = (x[v] - sweep_.from[v]).squaredNorm() <= most && (u.empty() || (moves * (move - expected(v))).squaredNorm() <= most);
            dirtyVertices_[v] = 0;
            if (isKnown && stays) continue;
            ++strays[c];
            setDirty(v, x[v], move);
        }
    });
    int all = 0;
    for (int s : strays) all += s;
    return all;
}

void CandidateList::setDirty(std::size_t v, const Vec3& x, const Vec3& move)
{
    dirtyVertices_[v] = 1;
    sweep_.from.set(v, x);
    (isStepStart_ ? ahead_ : sweep_.move).set(v, move);
    drifted_[v] = !isStepStart_;
}

void CandidateList::build()
{
    if (isStepStart_) parallelFor(ahead_.size(), kGrain, [&](std::size_t v) { sweep_.move.set(v, stepsAhead_ * ahead_[v]); });
    search_.run(sweep_, dirtyVertices_, restPairs_);
    markDirtyPrimitives();
    for (CandidatePool* pool : {&edgePairs_, &facePairs_}) {
        if (!built_) pool->clear();
        if (!pool->unmeasured.empty()) measured_ = false;  // pairs of an earlier build have not been measured yet
        pool->replace(primitives_, dirty_, search_);
    }
    built_ = true;
}

void CandidateList::markDirtyPrimitives()
{
    parallelFor(static_cast<std::size_t>(primitives_.count()), 4096, [&](std::size_t i) {
        const int p = static_cast<int>(i);
        const auto any = [&](const auto& vertices) { return std::ranges::any_of(vertices, [&](int v) { return dirtyVertices_[v] != 0; }); };
        if (p < primitives_.edgeCount) dirty_[i] = any(primitives_.edges[p]);
        else if (p < primitives_.firstFace()) dirty_[i] = dirtyVertices_[p - primitives_.firstVertex()];
        else dirty_[i] = any(primitives_.faces[p - primitives_.firstFace()]);
    });
}

void CandidateList::moved(const CoveredMoves&)
{
    parallelFor(sweep_.from.size(), kGrain, [&](std::size_t v) {
        sweep_.from.set(v, sweep_.from[v] + expected(v));
        sweep_.move.set(v, Vec3::Zero());
    });
    if (isStepStart_ && stepsAhead_ > 0) --stepsAhead_;
    isStepStart_ = false;
}

void CandidateList::measure(std::span<const Vec3> x)
{
    const bool stands =
        measured_ && parallelReduce(
                         x.size(), true, [&](std::size_t v) { return x[v] == measuredAt_[v]; }, [](bool a, bool b) { return a && b; });
    if (!stands) parallelFor(x.size(), kGrain, [&](std::size_t v) { measuredAt_.set(v, x[v]); });
    edgePairs_.measure(measuredAt_, !stands);
    facePairs_.measure(measuredAt_, !stands);
    measured_ = true;
}

}  // namespace sim::contact
