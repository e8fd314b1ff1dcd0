#include "sim/fabric/contact/candidate_list.h"

#include "sim/core/parallel.h"

#include <algorithm>
#include <utility>

namespace sim::contact {

namespace {

constexpr std::size_t kGrain = 1024;
/// With more dirty vertices than this all are searched for: it is not worth keeping the rest [-].
constexpr double kMostDirty = 0.6;

/// Of each vertex the radius of the thinnest primitive it belongs to [cm].
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

void Candidates::resize(std::size_t n)
{
    a.resize(n), b.resize(n), vertices.resize(n), reach.resize(n), core.resize(n), distance.resize(n), p.resize(n), q.resize(n);
}

void Candidates::copy(std::size_t to, const Candidates& other, std::size_t from)
{
    a[to] = other.a[from], b[to] = other.b[from], vertices[to] = other.vertices[from], reach[to] = other.reach[from], core[to] = other.core[from];
    distance[to] = other.distance[from], p[to] = other.p[from], q[to] = other.q[from];
}

CandidateList::CandidateList(const Fabric& fabric) : primitives_(fabric), search_(primitives_, fabric.rest)
{
    const std::size_t n = fabric.vertexCount();
    for (double r : leastRadius(primitives_)) {
        stray_.push_back(ListMargin::stray(r));
        strayAtRest_.push_back(ListMargin::strayAtRest(r));
    }
    sweep_.from.resize(n), sweep_.move.resize(n), measuredAt_.resize(n);
    dirtyVertices_.resize(n);
    dirty_.resize(primitives_.count());
    for (Candidates* c : {&pairs_, &next_}) c->begin.assign(primitives_.firstFace() + 1, 0);
    foundBegin_.assign(primitives_.firstFace() + 1, 0);
    foundNext_ = foundBegin_;
    findRestPairs(fabric.rest);
}

void CandidateList::findRestPairs(std::span<const Vec3> rest)
{
    coverPlace(rest);
    measure(rest);
    RestPairs found;
    found.begin = {0};
    for (int a = 0; a < primitives_.firstFace(); ++a) {
        for (int c = pairs_.begin[a]; c < pairs_.begin[a + 1]; ++c)
            if (pairs_.distance[c] < pairs_.reach[c]) {
                found.partner.push_back(pairs_.b[c]);
                found.distance.push_back(pairs_.distance[c]);
            }
        found.begin.push_back(static_cast<int>(found.partner.size()));
    }
    restPairs_ = std::move(found);
    built_ = false;
}

bool CandidateList::cover(std::span<const Vec3> x, std::span<const Vec3> u)
{
    const int strays = findStrays(x, u);
    if (strays == 0) return false;
    if (!built_ || strays > kMostDirty * static_cast<double>(x.size())) {
        parallelFor(x.size(), kGrain, [&](std::size_t v) {
            dirtyVertices_[v] = 1;
            sweep_.from.set(v, x[v]);
            sweep_.move.set(v, u.empty() ? Vec3::Zero().eval() : u[v]);
        });
    }
    build();
    return true;
}

/// Vertices too far from where their pairs were searched become dirty and start from here.
int CandidateList::findStrays(std::span<const Vec3> x, std::span<const Vec3> u)
{
    const std::vector<double>& limit = u.empty() ? strayAtRest_ : stray_;
    const Chunks chunks(x.size());
    std::array<int, kMaxChunks> strays{};
    parallelFor(chunks.count(), [&](std::size_t c) {
        for (std::size_t v = chunks.begin(c); v < chunks.end(c); ++v) {
            const double most = limit[v] * limit[v];
            const Vec3 move = u.empty() ? Vec3::Zero().eval() : u[v];
            const bool stays = (x[v] - sweep_.from[v]).squaredNorm() <= most &&
                               (u.empty() || (move - sweep_.move[v]).squaredNorm() <= most);
            dirtyVertices_[v] = stays && built_ ? 0 : 1;
            if (dirtyVertices_[v]) {
                ++strays[c];
                sweep_.from.set(v, x[v]);
                sweep_.move.set(v, move);
            }
        }
    });
    int all = 0;
    for (int s : strays) all += s;
    return all;
}

void CandidateList::build()
{
    search_.run(sweep_, dirtyVertices_, restPairs_);
    markDirtyPrimitives();
    sortFound();
    merge();
    built_ = true;
}

void CandidateList::markDirtyPrimitives()
{
    parallelFor(static_cast<std::size_t>(primitives_.count()), 4096, [&](std::size_t i) {
        const int p = static_cast<int>(i);
        const auto any = [&](const auto& vertices) {
            return std::ranges::any_of(vertices, [&](int v) { return dirtyVertices_[v] != 0; });
        };
        if (p < primitives_.edgeCount) dirty_[i] = any(primitives_.edges[p]);
        else if (p < primitives_.firstFace()) dirty_[i] = dirtyVertices_[p - primitives_.firstVertex()];
        else dirty_[i] = any(primitives_.faces[p - primitives_.firstFace()]);
    });
}

/// By first primitive, then by second: the order in which they were found is forgotten.
void CandidateList::sortFound()
{
    std::ranges::fill(foundBegin_, 0);
    for (std::size_t task = 0; task < search_.tasks(); ++task)
        for (const FoundPair& f : search_.found(task)) ++foundBegin_[f.a + 1];
    for (std::size_t a = 1; a < foundBegin_.size(); ++a) foundBegin_[a] += foundBegin_[a - 1];
    found_.resize(foundBegin_.back());
    foundNext_ = foundBegin_;
    for (std::size_t task = 0; task < search_.tasks(); ++task)
        for (const FoundPair& f : search_.found(task)) found_[foundNext_[f.a]++] = f;
}

/// Pairs of clean primitives stay, those found come in between.
void CandidateList::merge()
{
    const std::size_t firsts = foundBegin_.size() - 1;
    const auto isKept = [&](int c) { return built_ && !dirty_[pairs_.a[c]] && !dirty_[pairs_.b[c]]; };
    parallelFor(firsts, kGrain, [&](std::size_t a) {
        int kept = 0;
        for (int c = pairs_.begin[a]; c < pairs_.begin[a + 1]; ++c) kept += isKept(c);
        next_.begin[a + 1] = kept + foundBegin_[a + 1] - foundBegin_[a];
        std::sort(found_.begin() + foundBegin_[a], found_.begin() + foundBegin_[a + 1],
                  [](const FoundPair& f, const FoundPair& g) { return f.b < g.b; });
    });
    for (std::size_t a = 0; a < firsts; ++a) next_.begin[a + 1] += next_.begin[a];
    next_.resize(next_.begin[firsts]);
    if (!fresh_.empty()) measured_ = false;  // pairs of an earlier build were not measured yet
    fresh_.resize(found_.size());
    parallelFor(firsts, kGrain, [&](std::size_t a) {
        int to = next_.begin[a], f = foundBegin_[a];
        const auto takeFound = [&] {
            const FoundPair& pair = found_[f];
            next_.a[to] = pair.a, next_.b[to] = pair.b, next_.reach[to] = pair.range.reach, next_.core[to] = pair.range.core;
            next_.vertices[to] = primitives_.vertices(pair.a, pair.b);
            fresh_[f++] = to++;
        };
        for (int c = pairs_.begin[a]; c < pairs_.begin[a + 1]; ++c) {
            if (!isKept(c)) continue;
            while (f < foundBegin_[a + 1] && found_[f].b < pairs_.b[c]) takeFound();
            next_.copy(to++, pairs_, c);
        }
        while (f < foundBegin_[a + 1]) takeFound();
    });
    std::swap(pairs_, next_);
}

void CandidateList::moved()
{
    parallelFor(sweep_.from.size(), kGrain, [&](std::size_t v) {
        sweep_.from.set(v, sweep_.from[v] + sweep_.move[v]);
        sweep_.move.set(v, Vec3::Zero());
    });
}

}  // namespace sim::contact
