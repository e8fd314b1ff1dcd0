#include "sim/fabric/contact/contact.h"

#include "sim/core/parallel.h"
#include "sim/fabric/contact/contact_parts.h"

#include <cmath>
#include <limits>

namespace sim {

using namespace contact;

FabricContact::FabricContact(const Fabric& fabric, const Cohesion* cohesion) : parts_(std::make_unique<Parts>(fabric, cohesion)) {}
FabricContact::~FabricContact() = default;

void FabricContact::beginStep(std::span<const Vec3> x, std::span<const double> mass, double h, double springStep, const FrictionForces& held)
{
    Parts& p = *parts_;
    p.held = held;
    p.h = h;
    p.springStep = springStep;
    p.mass.assign(mass.begin(), mass.end());
    p.inverseMass.resize(mass.size());
    p.start.assign(x.begin(), x.end());
    for (std::size_t v = 0; v < mass.size(); ++v) p.inverseMass[v] = p.list.primitives().pinned[v] ? 0.0 : 1.0 / mass[v];
    p.limiter.setMasses(p.inverseMass);
    p.list.beginStep();
    p.isLookedAt = false;
}

FabricContact::LimitedMoves FabricContact::limit(std::span<const Vec3> x, std::span<Vec3> u, LimitReport& report, StageClock& clock)
{
    const Limiter::Limited limited = parts_->limiter.limit(x, u, parts_->list, report, clock);
    return {limited.moves, limited.wereChanged};
}

void FabricContact::moved(const LimitedMoves& moves) { parts_->list.moved(moves.covered_); }

FabricContact::Active FabricContact::activeAt(std::span<const Vec3> x, StageClock& clock, std::span<const Vec3> expected)
{
    Parts& p = *parts_;
    clock.start(Stage::FabricCandidates);
    p.list.coverPositions(x);
    if (p.list.empty()) {
        p.isLookedAt = false;
        p.resizeActive(0);
        return {p, p.active};
    }
    clock.start(Stage::FabricContact);
    p.keepFound(x);
    p.list.measure(x);
    p.findActive(p.list.edgePairs(), p.edgePairs);
    p.findActive(p.list.facePairs(), p.facePairs);
    p.resizeActive(p.edgePairs.size() + p.facePairs.size());
    p.findHeld();
    p.findPress();
    p.describe(x, expected, p.list.edgePairs(), p.edgePairs, 0);
    p.describe(x, expected, p.list.facePairs(), p.facePairs, p.edgePairs.size());
    if (p.bridges()) p.findBridges(x);
    return {p, p.active};
}

void FabricContact::Parts::findActive(const CandidatePool& pairs, std::vector<PairPlace>& found)
{
    const Chunks chunks(pairs.size());
    std::array<int, kMaxChunks> count{};
    acting.resize(pairs.size());
    const bool isHeld = bridges();
    const auto acts = [&](std::size_t i) {
        if (pairs.distance[i] < pairs.reach[i]) return true;
        return isHeld && pairs.distance[i] < pairs.reach[i] + list.bridge(pairs.a[i], pairs.b[i]);
    };
    parallelFor(chunks.count(), [&](std::size_t c) {
        PairPlace* out = acting.data() + chunks.begin(c);
        for (std::size_t i = chunks.begin(c); i < chunks.end(c); ++i)
            if (acts(i)) out[count[c]++] = {pairs.a[i], pairs.b[i], static_cast<int>(i)};
    });
    found.clear();
    for (std::size_t c = 0; c < chunks.count(); ++c)
        found.insert(found.end(), acting.begin() + chunks.begin(c), acting.begin() + chunks.begin(c) + count[c]);
    sorter.sort(found, list.primitives().firstFace());
}

void FabricContact::Parts::describe(std::span<const Vec3> x, std::span<const Vec3> expected, const CandidatePool& pairs,
                                    std::span<const PairPlace> places, std::size_t first)
{
    constexpr std::size_t kAhead = 8;  // pairs lie in their pool in no order
    parallelFor(places.size(), 512, [&](std::size_t i) {
        if (i + kAhead < places.size()) pairs.prefetch(places[i + kAhead].place);
        describe(x, expected, pairs, places[i].place, first + i);
    });
}

void FabricContact::Parts::resizeActive(std::size_t n)
{
    active.vertices.resize(n), active.firstSide.resize(n), active.weights.resize(n), active.normal.resize(n), active.force.resize(n);
    active.stiffness.resize(n), active.frictionStiffness.resize(n), active.lever.resize(n), active.between.resize(n), frictionPairs.resize(n);
    heldForce.resize(n), press.resize(n);
}

/// Pair `place` of the pool as number `slot` of the active ones.
void FabricContact::Parts::describe(std::span<const Vec3> x, std::span<const Vec3> expected, const CandidatePool& pairs, std::size_t place,
                                    std::size_t slot)
{
    const Primitives& primitives = list.primitives();
    const int a = pairs.a[place], b = pairs.b[place];
    const std::array<int, 4>& v = pairs.vertices[place];
    const std::array<double, 4> c = pairWeights(pairs.kind, pairs.p[place], pairs.q[place]);

    Vec3 apart = Vec3::Zero();
    double meanMass = 0.0;
    for (std::size_t k = 0; k < 4; ++k) {
        apart += c[k] * x[v[k]];
        meanMass += 0.25 * mass[v[k]];
    }
    const double distance = pairs.distance[place];
    const Vec3 normal = distance > 0.0 ? Vec3(apart / distance) : Vec3::UnitX().eval();

    const double young = std::min(primitives.young[a], primitives.young[b]);
    const double stiffness = pairStiffness(young, primitives.radius[a] + primitives.radius[b], meanMass, springStep);
    const bool isKnown = !std::isnan(press[slot]);
    const PairEnergy energy =
        isKnown ? pairTangent(distance, pairs.range(place), stiffness, press[slot]) : pairEnergy(distance, pairs.range(place), stiffness);

    active.vertices[slot] = v;
    active.firstSide[slot] = primitives.kind(a) == PairKind::EdgeEdge ? 2 : 1;
    active.weights[slot] = c;
    active.normal[slot] = normal;
    active.between[slot] = {a, b};
    frictionPairs[slot] = {pairs.range(place),         apart, directionsAt(x, slot), stiffness, meanMass / (springStep * springStep),
                           primitives.friction2(a, b), false};
    if (bridges()) {
        Vec3 before = Vec3::Zero();
        for (std::size_t k = 0; k < 4; ++k) before += c[k] * start[v[k]];
        const double longest = list.bridge(a, b);  // a bridge comes about between steps, so that Newton's iterations do not make and break it
        if (before.norm() < pairs.reach[place] + longest) frictionPairs[slot].bridge = longest;
    }
    active.stiffness[slot] = energy.curvature;
    const Friction sideways = friction(x, expected, energy, distance, slot);
    frictionPairs[slot].slides = sideways.slides;
    active.force[slot] = energy.slope * normal + sideways.force;
    active.frictionStiffness[slot] = sideways.along;
}

ContactEnergy FabricContact::Active::storedEnergy(std::span<const Vec3> x, const FrictionForces& held) const
{
    const Parts& p = *parts_;
    const auto sumOver = [&](auto&& of) {
        return parallelSum(p.active.size(), [&](std::size_t i) {
            Vec3 apart = Vec3::Zero();
            for (std::size_t k = 0; k < 4; ++k) apart += p.active.weights[i][k] * x[p.active.vertices[i][k]];
            return of(i, apart.norm());
        });
    };
    const auto press = [&](std::size_t i, double distance) { return pairEnergy(distance, p.frictionPairs[i].range, p.frictionPairs[i].stiffness); };
    ContactEnergy stored;
    if (p.bridges())
        stored.bridges = -sumOver([&](std::size_t i, double distance) {
            return p.frictionPairs[i].pull * std::max(0.0, p.frictionPairs[i].range.reach + p.frictionPairs[i].bridge - distance);
        });
    stored.pressed = stored.bridges + sumOver([&](std::size_t i, double distance) { return press(i, distance).energy; });
    stored.gripped = sumOver([&](std::size_t i, double distance) {
        const double pressed = p.frictionPairs[i].range.reach - distance;
        if (!(pressed > 0.0)) return 0.0;
        return 0.5 * held.at(p.active.between[i]).squaredNorm() /
               pairFrictionStiffness(-press(i, distance).slope, pressed, p.frictionPairs[i].perStep);
    });
    return stored;
}

std::size_t FabricContact::candidates() const { return parts_->list.size(); }

double FabricContact::leastDistance() const
{
    const Primitives& primitives = parts_->list.primitives();
    double least = std::numeric_limits<double>::infinity();
    for (const CandidatePool* pairs : {&parts_->list.edgePairs(), &parts_->list.facePairs()})
        least = parallelReduce(
            pairs->size(), least, [&](std::size_t i) { return pairs->distance[i] / (pairs->reach[i] - primitives.band(pairs->a[i], pairs->b[i])); },
            [](double a, double b) { return std::min(a, b); });
    return least;
}

}  // namespace sim
