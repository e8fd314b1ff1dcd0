#include "sim/fabric/contact/contact.h"

#include "sim/core/parallel.h"
#include "sim/fabric/contact/candidate_list.h"
#include "sim/fabric/contact/limiter.h"
#include "sim/fabric/contact/pair_energy.h"
#include "sim/fabric/contact/pair_turn.h"
#include "sim/fabric/friction_law.h"

#include <limits>

namespace sim {

using namespace contact;

struct FabricContact::Parts {
    Parts(const Fabric& fabric, const Cohesion* c) : cohesion(c), list(fabric, c != nullptr), limiter(list.primitives()), start(fabric.rest) {}

    /// What the friction of an active pair goes by.
    struct Grip {
        PairRange range;
        Vec3 apart;           ///< separation where it was looked at last [cm]
        double stiffness;     ///< of the pair [dyn/cm]
        double perStep;       ///< mean mass of its vertices over springStep² [dyn/cm]
        double coefficient;   ///< Coulomb's [-]
        double perMass;       ///< h² over the mass that its separation has [cm/dyn]
        bool slides;          ///< friction is at its bound
        double bridge = 0.0;  ///< longest beyond the reach [cm] …
        double pull = 0.0;    ///< … and what it holds with [dyn]
    };
    /// What acted on an active pair where it went from where it was looked at, by its force and stiffness.
    struct Acted {
        Vec3 apart;     ///< its separation [cm]
        Vec3 friction;  ///< [dyn]
        double bound;   ///< of friction [dyn]
    };

    bool bridges() const { return cohesion && cohesion->isOnFabric(); }
    void findActive(const CandidatePool& pairs, std::vector<PairPlace>& found);
    void describe(std::span<const Vec3> x, std::span<const Vec3> expected, const CandidatePool& pairs, std::span<const PairPlace> places,
                  std::size_t first);
    void describe(std::span<const Vec3> x, std::span<const Vec3> expected, const CandidatePool& pairs, std::size_t place, std::size_t slot);
    Friction friction(std::span<const Vec3> x, std::span<const Vec3> expected, const PairEnergy& energy, double distance, std::size_t slot) const;
    void resizeActive(std::size_t n);
    void findHeld();
    template <class Body>
    void forEachSeeker(Body&& body) const;
    double pullOf(int seeker, std::size_t i, std::span<const Vec3> x) const;
    void findBridges(std::span<const Vec3> x);
    Acted actedOn(std::size_t i, std::span<const Vec3> x) const;
    double touchingMass();

    const Cohesion* cohesion;  ///< or null
    CandidateList list;
    Limiter limiter;
    std::vector<Vec3> start;                      ///< of the step [cm]
    std::vector<double> mass, inverseMass;        ///< [g, 1/g]
    double h = 0.0, springStep = 0.0;             ///< [s]
    std::vector<PairPlace> acting;                ///< by chunks
    std::vector<PairPlace> edgePairs, facePairs;  ///< that act, sorted
    PairSorter sorter;
    ActiveContacts active;
    std::vector<Grip> grips;             ///< of the active pairs
    Grips held;                          ///< at the start of the step
    std::vector<Vec3> heldForce;         ///< of it on the active pairs [dyn]
    std::vector<char> isTouching;        ///< of each vertex
    std::vector<int> nearest, opposite;  ///< of each yarn edge and vertex: the active pair of its bridge, and of one on its other side; or −1
    std::vector<Vec3> keptForce;         ///< of friction on the active pairs, at the end of the step [dyn]
};

FabricContact::FabricContact(const Fabric& fabric, const Cohesion* cohesion) : parts_(std::make_unique<Parts>(fabric, cohesion)) {}
FabricContact::~FabricContact() = default;

void FabricContact::beginStep(std::span<const Vec3> x, std::span<const double> mass, double h, double springStep, const Grips& held)
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
}

void FabricContact::limit(std::span<const Vec3> x, std::span<Vec3> u, LimitReport& report, StageClock& clock)
{
    parts_->limiter.limit(x, u, parts_->list, report, clock);
}

void FabricContact::moved() { parts_->list.moved(); }

const ActiveContacts& FabricContact::activeAt(std::span<const Vec3> x, StageClock& clock, std::span<const Vec3> expected)
{
    Parts& p = *parts_;
    clock.start(Stage::FabricCandidates);
    p.list.coverPlace(x);
    if (p.list.empty()) {
        p.resizeActive(0);
        return p.active;
    }
    clock.start(Stage::FabricContact);
    p.list.measure(x);
    p.findActive(p.list.edgePairs(), p.edgePairs);
    p.findActive(p.list.facePairs(), p.facePairs);
    p.resizeActive(p.edgePairs.size() + p.facePairs.size());
    p.findHeld();
    p.describe(x, expected, p.list.edgePairs(), p.edgePairs, 0);
    p.describe(x, expected, p.list.facePairs(), p.facePairs, p.edgePairs.size());
    if (p.bridges()) p.findBridges(x);
    return p.active;
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
    parallelFor(places.size(), 512, [&](std::size_t i) { describe(x, expected, pairs, places[i].place, first + i); });
}

void FabricContact::Parts::resizeActive(std::size_t n)
{
    active.vertices.resize(n), active.firstSide.resize(n), active.weights.resize(n), active.normal.resize(n), active.force.resize(n);
    active.stiffness.resize(n), active.frictionStiffness.resize(n), active.between.resize(n), grips.resize(n);
    heldForce.resize(n);
}

/// What friction holds on each of the active pairs: both lie in the same order.
void FabricContact::Parts::findHeld()
{
    std::size_t next = 0;
    const auto find = [&](std::span<const PairPlace> places, std::size_t first) {
        for (std::size_t i = 0; i < places.size(); ++i) {
            const Vec2i pair(places[i].a, places[i].b);
            while (next < held.between.size() && Grips::isBefore(held.between[next], pair)) ++next;
            heldForce[first + i] = next < held.between.size() && held.between[next] == pair ? held.force[next] : Vec3::Zero().eval();
        }
    };
    find(edgePairs, 0);
    find(facePairs, edgePairs.size());
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
    double meanMass = 0.0, mobility = 0.0;
    for (std::size_t k = 0; k < 4; ++k) {
        apart += c[k] * x[v[k]];
        meanMass += 0.25 * mass[v[k]];
        mobility += c[k] * c[k] * inverseMass[v[k]];
    }
    const double distance = pairs.distance[place];
    const Vec3 normal = distance > 0.0 ? Vec3(apart / distance) : Vec3::UnitX().eval();

    const double young = std::min(primitives.young[a], primitives.young[b]);
    const double stiffness = pairStiffness(young, primitives.radius[a] + primitives.radius[b], meanMass, springStep);
    const PairEnergy energy = pairEnergy(distance, pairs.range(place), stiffness);

    active.vertices[slot] = v;
    active.firstSide[slot] = primitives.kind(a) == PairKind::EdgeEdge ? 2 : 1;
    active.weights[slot] = c;
    active.normal[slot] = normal;
    active.between[slot] = {a, b};
    grips[slot] = {pairs.range(place), apart, stiffness, meanMass / (springStep * springStep), primitives.friction2(a, b), h * h * mobility, false};
    if (bridges()) {
        Vec3 before = Vec3::Zero();
        for (std::size_t k = 0; k < 4; ++k) before += c[k] * start[v[k]];
        const double longest = list.bridge(a, b);  // a bridge comes about between steps, so that Newton's iterations do not make and break it
        if (before.norm() < pairs.reach[place] + longest) grips[slot].bridge = longest;
    }
    const Friction sideways = friction(x, expected, energy, distance, slot);
    grips[slot].slides = sideways.slides;
    active.force[slot] = energy.slope * normal + sideways.force;
    active.stiffness[slot] = energy.curvature;
    active.frictionStiffness[slot] = sideways.along;
}

/// Of an active pair that is described but for it, at x or where the moves expected lead.
Friction FabricContact::Parts::friction(std::span<const Vec3> x, std::span<const Vec3> expected, const PairEnergy& energy, double distance,
                                        std::size_t slot) const
{
    const Grip& grip = grips[slot];
    const double pressed = grip.range.reach - distance;
    if (!(grip.coefficient > 0.0 && pressed > 0.0)) return {Vec3::Zero()};
    const std::array<int, 4>& v = active.vertices[slot];
    const std::array<double, 4>& c = active.weights[slot];
    const Vec3& normal = active.normal[slot];
    const Vec3& apart = grip.apart;
    Vec3 before = Vec3::Zero(), further = Vec3::Zero();
    for (std::size_t k = 0; k < 4; ++k) {
        before += c[k] * start[v[k]];
        if (!expected.empty()) further += c[k] * expected[v[k]];
    }
    const PairTurn turn(active.firstSide[slot] == 2 ? PairKind::EdgeEdge : PairKind::VertexFace, v, start, x);
    const auto along = [&](const Vec3& u) -> Vec3 { return u - normal.dot(u) * normal; };
    const Vec3 carried = turn * before;
    const GripSpring spring{along(turn * heldForce[slot]), gripStiffness(-energy.slope, pressed, grip.perStep), grip.coefficient * -energy.slope};
    if (expected.empty()) return spring.at(along(apart - carried));
    return spring.expected(along(apart - carried), along(before + further - carried), spring.stiffness * grip.perMass);
}

/// body(seeker, pair, direction from the seeker to the other) for the active pairs that may have bridges: yarns seek yarns, vertices faces.
template <class Body>
void FabricContact::Parts::forEachSeeker(Body&& body) const
{
    const Primitives& primitives = list.primitives();
    for (std::size_t i = 0; i < active.size(); ++i) {
        if (!(grips[i].bridge > 0.0)) continue;
        const int a = active.between[i][0], b = active.between[i][1];
        const bool areEdges = primitives.kind(a) == PairKind::EdgeEdge;
        if (areEdges && (primitives.strand[a] < 0 || primitives.strand[b] < 0)) continue;
        body(a, i, Vec3(-active.normal[i]));
        if (areEdges) body(b, i, active.normal[i]);
    }
}

/// A seeker's part of the force of a pair's bridge [dyn]. Yarns that cross touch along their width.
double FabricContact::Parts::pullOf(int seeker, std::size_t i, std::span<const Vec3> x) const
{
    const Primitives& primitives = list.primitives();
    const std::array<int, 4>& v = active.vertices[i];
    const std::array<double, 4>& c = active.weights[i];
    if (primitives.kind(seeker) == PairKind::VertexFace) return cohesion->onFace(v[0], {v[1], v[2], v[3]}, {-c[1], -c[2], -c[3]});
    const int other = active.between[i][active.between[i][0] == seeker ? 1 : 0];
    const Vec3 first = x[v[1]] - x[v[0]], second = x[v[3]] - x[v[2]];
    const double length = (active.between[i][0] == seeker ? first : second).norm();
    const double along = std::abs(first.normalized().dot(second.normalized()));
    return std::min(1.0, along + 2.0 * primitives.radius[other] / length) * cohesion->onYarn(seeker);
}

/// Each vertex and yarn edge has a bridge to what is nearest, and one to what is nearest on its other side.
void FabricContact::Parts::findBridges(std::span<const Vec3> x)
{
    for (std::vector<int>* best : {&nearest, &opposite}) best->assign(list.primitives().firstFace(), -1);
    const auto isNearer = [&](std::size_t i, int than) { return than < 0 || grips[i].apart.squaredNorm() < grips[than].apart.squaredNorm(); };
    const auto direction = [&](int seeker, int i) -> Vec3 { return active.between[i][0] == seeker ? Vec3(-active.normal[i]) : active.normal[i]; };
    forEachSeeker([&](int seeker, std::size_t i, const Vec3&) {
        if (isNearer(i, nearest[seeker])) nearest[seeker] = static_cast<int>(i);
    });
    forEachSeeker([&](int seeker, std::size_t i, const Vec3& towards) {
        if (towards.dot(direction(seeker, nearest[seeker])) < 0.0 && isNearer(i, opposite[seeker])) opposite[seeker] = static_cast<int>(i);
    });
    forEachSeeker([&](int seeker, std::size_t i, const Vec3&) {
        const int slot = static_cast<int>(i);
        if (slot == nearest[seeker] || slot == opposite[seeker]) grips[i].pull += pullOf(seeker, i, x);
    });
    for (std::size_t i = 0; i < active.size(); ++i) active.force[i] += grips[i].pull * active.normal[i];
}

FabricContact::Parts::Acted FabricContact::Parts::actedOn(std::size_t i, std::span<const Vec3> x) const
{
    const Vec3& n = active.normal[i];
    Vec3 apart = Vec3::Zero();
    for (std::size_t k = 0; k < 4; ++k) apart += active.weights[i][k] * x[active.vertices[i][k]];
    const Vec3 moved = apart - grips[i].apart, acted = active.force[i] + active.frictionStiffness[i] * moved;
    const double normalForce = grips[i].pull - (active.force[i] + active.stiffness[i] * moved).dot(n);
    return {apart, acted - acted.dot(n) * n, grips[i].coefficient * std::max(normalForce, 0.0)};
}

/// Mass of the vertices of the active pairs that are not pinned [g].
double FabricContact::Parts::touchingMass()
{
    isTouching.assign(mass.size(), 0);
    for (const std::array<int, 4>& pair : active.vertices)
        for (int v : pair) isTouching[v] = 1;
    return parallelSum(mass.size(), [&](std::size_t v) { return isTouching[v] && inverseMass[v] > 0.0 ? mass[v] : 0.0; });
}

double FabricContact::frictionError(std::span<const Vec3> x, double acceleration)
{
    Parts& p = *parts_;
    using Sums = std::array<double, 2>;
    const auto [wrong, bound] = parallelReduce(
        p.active.size(), Sums{},
        [&](std::size_t i) {
            const Parts::Acted acted = p.actedOn(i, x);
            const double beyond = acted.friction.norm() - acted.bound;
            return Sums{p.grips[i].slides ? std::abs(beyond) : std::max(beyond, 0.0), acted.bound};
        },
        [](const Sums& a, const Sums& b) {
            return Sums{a[0] + b[0], a[1] + b[1]};
        });
    return wrong > 0.0 ? wrong / std::max(bound, acceleration * p.touchingMass()) : 0.0;
}

void FabricContact::keepFriction(std::span<const Vec3> x, Grips& held)
{
    Parts& p = *parts_;
    std::vector<Vec3>& force = p.keptForce;
    force.resize(p.active.size());
    parallelFor(force.size(), 512, [&](std::size_t i) {
        const Parts::Acted acted = p.actedOn(i, x);
        const bool touches = acted.apart.dot(p.active.normal[i]) < p.grips[i].range.reach;
        force[i] = touches ? atMost(acted.bound, acted.friction) : Vec3::Zero().eval();
    });
    held.clear();
    for (std::size_t i = 0; i < force.size(); ++i)
        if (!force[i].isZero(0.0)) held.add(p.active.between[i], force[i]);
}

ContactEnergy FabricContact::storedEnergy(std::span<const Vec3> x, const Grips& held) const
{
    const Parts& p = *parts_;
    const auto sumOver = [&](auto&& of) {
        return parallelSum(p.active.size(), [&](std::size_t i) {
            Vec3 apart = Vec3::Zero();
            for (std::size_t k = 0; k < 4; ++k) apart += p.active.weights[i][k] * x[p.active.vertices[i][k]];
            return of(i, apart.norm());
        });
    };
    const auto press = [&](std::size_t i, double distance) { return pairEnergy(distance, p.grips[i].range, p.grips[i].stiffness); };
    ContactEnergy stored;
    if (p.bridges())
        stored.bridges = -sumOver(
            [&](std::size_t i, double distance) { return p.grips[i].pull * std::max(0.0, p.grips[i].range.reach + p.grips[i].bridge - distance); });
    stored.pressed = stored.bridges + sumOver([&](std::size_t i, double distance) { return press(i, distance).energy; });
    stored.gripped = sumOver([&](std::size_t i, double distance) {
        const double pressed = p.grips[i].range.reach - distance;
        if (!(pressed > 0.0)) return 0.0;
        return 0.5 * held.at(p.active.between[i]).squaredNorm() / gripStiffness(-press(i, distance).slope, pressed, p.grips[i].perStep);
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
