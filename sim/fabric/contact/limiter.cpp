#include "sim/fabric/contact/limiter.h"

#include "sim/core/parallel.h"

#include <algorithm>
#include <bit>
#include <optional>

namespace sim::contact {

namespace {

/// A pair already below its floor or core may still lose this share of its distance [-].
constexpr double kKept = 0.97;
/// Share of the gap above the core by which a pair may approach even below its floor [-].
constexpr double kShareOfGap = 0.2;

std::array<Vec3, 4> atVertices(const std::array<int, 4>& v, std::span<const Vec3> values)
{
    return {values[v[0]], values[v[1]], values[v[2]], values[v[3]]};
}

}  // namespace

Limiter::Limiter(const Primitives& primitives) : primitives_(primitives) { motion_.resize(primitives.count()); }

Limiter::Limited Limiter::limit(std::span<const Vec3> x, std::span<Vec3> u, CandidateList& list, LimitReport& report, StageClock& clock)
{
    constexpr int kFilterRounds = 5, kBlendRounds = 8;
    bool changed = true, anyChanged = false;  // the moves, since they were looked at, and at all
    std::optional<CoveredMoves> covered;
    for (int round = 0; round < kFilterRounds; ++round) {
        covered = cover(x, u, list, report, clock);
        if (list.empty()) return {*covered, anyChanged};
        findApproaching(x, u, list);
        if (approaching_.empty()) return {*covered, anyChanged};
        const int sweeps = projectApproach(u, changed);
        anyChanged = anyChanged || changed;
        if (sweeps == 1) break;
    }
    double fraction = 1.0;
    for (int round = 0; round < kBlendRounds; ++round) {
        if (changed || round > 0) {
            covered = cover(x, u, list, report, clock);
            findApproaching(x, u, list);
        }
        fraction = measureFractions(x, u);
        if (fraction >= 1.0) return {*covered, anyChanged};
        anyChanged = true;
        if (round + 1 < kBlendRounds) report.blends += averageFailingPairs(u);
    }
    parallelFor(u.size(), 4096, [&](std::size_t v) { u[v] *= kSafeShare * fraction; });
    ++report.globalScalings;
    return {*covered, true};
}

/// Whatever changed the moves may have led them to where the list was not looked up.
CoveredMoves Limiter::cover(std::span<const Vec3> x, std::span<const Vec3> u, CandidateList& list, LimitReport& report, StageClock& clock)
{
    clock.start(Stage::FabricCandidates);
    const CoveredMoves covered = list.coverMoves(x, u);
    report.candidateListBuilds += covered.wereSearched();
    if (list.empty()) return covered;
    clock.start(Stage::FabricContact);
    list.measure(x);
    return covered;
}

void Limiter::motionOfPrimitives(std::span<const Vec3> u)
{
    const Primitives& p = primitives_;
    const auto setMotion = [&](int number, const auto& vertices) {
        Vec3 mean = Vec3::Zero();
        for (int v : vertices) mean += u[v];
        mean /= static_cast<double>(vertices.size());
        double most = 0.0;
        for (int v : vertices) most = std::max(most, (u[v] - mean).squaredNorm());
        motion_.set(number, mean, std::sqrt(most));
    };
    parallelFor(p.edges.size(), 1024, [&](std::size_t e) { setMotion(static_cast<int>(e), p.edges[e]); });
    if (p.faces.empty()) return;
    parallelFor(u.size(), 1024, [&](std::size_t v) { motion_.set(p.firstVertex() + v, u[v]); });
    parallelFor(p.faces.size(), 1024, [&](std::size_t f) { setMotion(p.firstFace() + static_cast<int>(f), p.faces[f]); });
}

/// Pairs whose distance could fall below their floor (or by more than 3 %) in this move; all others are safe. This depends on the pair, x and u
/// alone, not on what else is in the list.
void Limiter::findApproaching(std::span<const Vec3> x, std::span<const Vec3> u, const CandidateList& list)
{
    motionOfPrimitives(u);
    approaching_.clear();
    for (const CandidatePool* pairs : {&list.edgePairs(), &list.facePairs()}) findApproaching(x, u, *pairs);
}

void Limiter::findApproaching(std::span<const Vec3> x, std::span<const Vec3> u, const CandidatePool& pairs)
{
    const Chunks chunks(pairs.size());
    std::array<int, kMaxChunks> count{};
    near_.resize(pairs.size());
    parallelFor(chunks.count(), [&](std::size_t chunk) {
        const std::size_t begin = chunks.begin(chunk), end = chunks.end(chunk);
        PairPlace* out = near_.data() + begin;
        for (std::size_t first = begin; first < end; first += kLanes) {
            const std::size_t last = std::min(end, first + kLanes) - 1;
            EightIndices a, b;
            for (std::size_t lane = 0; lane < kLanes; ++lane) {
                a[lane] = pairs.a[std::min(first + lane, last)];
                b[lane] = pairs.b[std::min(first + lane, last)];
            }
            const Pack distance = loadPack(&pairs.distance[first]), core = loadPack(&pairs.core[first]);
            const Pack floor = floorOf(loadPack(&pairs.reach[first]), core);
            const QuadPack moveA = gatherQuads(motion_, a), moveB = gatherQuads(motion_, b);
            const Pack kept = kKept * distance;
            const Pack free = distance - (floor < kept ? floor : kept) - moveA.w - moveB.w;
            const Pack dx = moveA.x - moveB.x, dy = moveA.y - moveB.y, dz = moveA.z - moveB.z;
            constexpr double kRounding = 1.0 + 1.0e-12;
            const PackMask far = (free > 0.0) & ((dx * dx + dy * dy + dz * dz) * kRounding < free * free);
            for (unsigned bits = ~maskBits(far) & 0xffu; bits != 0; bits &= bits - 1) {
                const std::size_t i = first + std::countr_zero(bits);
                if (i > last) break;
                const std::array<int, 4>& v = pairs.vertices[i];
                const double d = pairs.distance[i], bound = std::min(floorOf(pairs.reach[i], pairs.core[i]), kKept * d);
                if (mayApproach(pairs.kind, atVertices(v, x), atVertices(v, u), d, bound))
                    out[count[chunk]++] = {pairs.a[i], pairs.b[i], static_cast<int>(i)};
            }
        }
    });
    places_.clear();
    for (std::size_t chunk = 0; chunk < chunks.count(); ++chunk)
        places_.insert(places_.end(), near_.begin() + chunks.begin(chunk), near_.begin() + chunks.begin(chunk) + count[chunk]);
    sorter_.sort(places_, primitives_.firstFace());
    for (const PairPlace& place : places_) approaching_.push_back(closing(x, pairs, place.place));
}

Limiter::ApproachingPair Limiter::closing(std::span<const Vec3> x, const CandidatePool& pairs, int place) const
{
    ApproachingPair c;
    c.kind = pairs.kind;
    c.vertices = pairs.vertices[place];
    c.weights = pairWeights(c.kind, pairs.p[place], pairs.q[place]);
    const double d = pairs.distance[place];
    const ContactDistances range = pairs.range(place);
    Vec3 apart = Vec3::Zero();
    c.compliance = 0.0;
    for (std::size_t k = 0; k < 4; ++k) {
        apart += c.weights[k] * x[c.vertices[k]];
        c.compliance += c.weights[k] * c.weights[k] * inverseMass_[c.vertices[k]];
    }
    c.normal = d > 0.0 ? Vec3(apart / d) : Vec3::Zero().eval();
    c.allowed = std::max(d - floorOf(range.reach, range.core), kShareOfGap * std::max(d - range.core, 0.0));
    c.separation = std::min(range.core, kKept * d);
    c.radii = primitives_.radius[pairs.a[place]] + primitives_.radius[pairs.b[place]];
    return c;
}

/// Gauss-Seidel with the closest points of x: approaches along the normal beyond what is allowed become blows without bounce.
/// @param changed  becomes whether any move has
/// @return sweeps it took
int Limiter::projectApproach(std::span<Vec3> u, bool& changed)
{
    constexpr int kMostSweeps = 30;
    constexpr double kTolerance = 1.0e-3, kLeast = 1.0e-5;  // of the radii: what ends the sweeps, what is not worth a push
    changed = false;
    for (int sweep = 0; sweep < kMostSweeps; ++sweep) {
        bool settled = true;
        for (std::size_t i = 0; i < approaching_.size(); ++i) {  // to and fro: blows travel both ways
            const ApproachingPair& c = approaching_[sweep % 2 == 0 ? i : approaching_.size() - 1 - i];
            double apart = 0.0;
            for (std::size_t k = 0; k < 4; ++k) apart += c.weights[k] * c.normal.dot(u[c.vertices[k]]);
            const double excess = -c.allowed - apart;
            if (excess <= kLeast * c.radii || c.compliance == 0.0) continue;
            const double impulse = excess / c.compliance;
            for (std::size_t k = 0; k < 4; ++k)
                if (const double w = inverseMass_[c.vertices[k]]; w > 0.0) u[c.vertices[k]] += (impulse * w * c.weights[k]) * c.normal;
            changed = true;
            if (excess > kTolerance * c.radii) settled = false;
        }
        if (settled) return sweep + 1;
    }
    return kMostSweeps;
}

/// @return the least
double Limiter::measureFractions(std::span<const Vec3> x, std::span<const Vec3> u)
{
    fraction_.resize(approaching_.size());
    parallelFor(approaching_.size(), 64, [&](std::size_t i) {
        const ApproachingPair& c = approaching_[i];
        fraction_[i] = collisionFreeFraction(c.kind, atVertices(c.vertices, x), atVertices(c.vertices, u), c.separation);
    });
    double least = 1.0;
    for (double f : fraction_) least = std::min(least, f);
    return least;
}

/// Draws the four vertices of each failing pair towards their common motion: without bounce, momentum kept, held vertices unmoved.
/// @return pairs
int Limiter::averageFailingPairs(std::span<Vec3> u) const
{
    constexpr double kBlend = 0.3;
    int pairs = 0;
    for (std::size_t i = 0; i < approaching_.size(); ++i) {
        if (fraction_[i] >= 1.0) continue;
        ++pairs;
        const std::array<int, 4>& vertices = approaching_[i].vertices;
        const bool held = std::ranges::any_of(vertices, [&](int v) { return inverseMass_[v] == 0.0; });
        Vec3 mean = Vec3::Zero();
        double mass = 0.0;
        for (int v : vertices) {
            const double m = held ? (inverseMass_[v] == 0.0 ? 1.0 : 0.0) : 1.0 / inverseMass_[v];
            mean += m * u[v];
            mass += m;
        }
        mean /= mass;
        for (int v : vertices)
            if (inverseMass_[v] > 0.0) u[v] += kBlend * (mean - u[v]);
    }
    return pairs;
}

}  // namespace sim::contact
