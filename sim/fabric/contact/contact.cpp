#include "sim/fabric/contact/contact.h"

#include "sim/core/parallel.h"
#include "sim/fabric/contact/candidate_list.h"
#include "sim/fabric/contact/limiter.h"
#include "sim/fabric/contact/pair_energy.h"

#include <limits>

namespace sim {

using namespace contact;

struct FabricContact::Parts {
    explicit Parts(const Fabric& fabric) : list(fabric), limiter(list.primitives()), start(fabric.rest) {}

    void findActive();
    void describe(std::span<const Vec3> x, std::size_t slot);
    void resizeActive(std::size_t n);

    CandidateList list;
    Limiter limiter;
    std::vector<Vec3> start;                  ///< of the step [cm]
    std::vector<double> mass, inverseMass;    ///< [g, 1/g]
    double h = 0.0;                           ///< [s]
    std::vector<int> acting, packed;          ///< pairs of the list: by chunks, and in one row
    ActiveContacts active;
};

FabricContact::FabricContact(const Fabric& fabric) : parts_(std::make_unique<Parts>(fabric)) {}
FabricContact::~FabricContact() = default;

void FabricContact::beginStep(std::span<const Vec3> x, std::span<const double> mass, double h)
{
    Parts& p = *parts_;
    p.h = h;
    p.mass.assign(mass.begin(), mass.end());
    p.inverseMass.resize(mass.size());
    p.start.assign(x.begin(), x.end());
    for (std::size_t v = 0; v < mass.size(); ++v) p.inverseMass[v] = p.list.primitives().pinned[v] ? 0.0 : 1.0 / mass[v];
    p.limiter.setMasses(p.inverseMass);
}

void FabricContact::limit(std::span<const Vec3> x, std::span<Vec3> u, LimitReport& report, StageClock& clock)
{
    parts_->limiter.limit(x, u, parts_->list, report, clock);
}

void FabricContact::moved()
{
    parts_->list.moved();
}

const ActiveContacts& FabricContact::activeAt(std::span<const Vec3> x, StageClock& clock)
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
    p.findActive();
    p.resizeActive(p.packed.size());
    parallelFor(p.packed.size(), 512, [&](std::size_t slot) { p.describe(x, slot); });
    return p.active;
}

void FabricContact::Parts::findActive()
{
    const Candidates& pairs = list.pairs();
    const Chunks chunks(pairs.size());
    std::array<int, kMaxChunks> count{};
    acting.resize(pairs.size());
    parallelFor(chunks.count(), [&](std::size_t c) {
        int* out = acting.data() + chunks.begin(c);
        for (std::size_t i = chunks.begin(c); i < chunks.end(c); ++i)
            if (pairs.distance[i] < pairs.reach[i]) out[count[c]++] = static_cast<int>(i);
    });
    packed.clear();
    for (std::size_t c = 0; c < chunks.count(); ++c)
        packed.insert(packed.end(), acting.begin() + chunks.begin(c), acting.begin() + chunks.begin(c) + count[c]);
}

void FabricContact::Parts::resizeActive(std::size_t n)
{
    active.vertices.resize(n), active.firstSide.resize(n), active.weights.resize(n), active.normal.resize(n), active.force.resize(n);
    active.stiffness.resize(n), active.frictionStiffness.resize(n);
}

void FabricContact::Parts::describe(std::span<const Vec3> x, std::size_t slot)
{
    constexpr double kSmoothSpeed = 1.0;  // of sliding, below which friction fades [cm/s]
    const Primitives& primitives = list.primitives();
    const Candidates& pairs = list.pairs();
    const std::size_t i = packed[slot];
    const int a = pairs.a[i], b = pairs.b[i];
    const std::array<int, 4>& v = pairs.vertices[i];
    const std::array<double, 4> c = pairWeights(primitives.kind(a), pairs.p[i], pairs.q[i]);

    Vec3 apart = Vec3::Zero(), slip = Vec3::Zero();
    double meanMass = 0.0;
    for (std::size_t k = 0; k < 4; ++k) {
        apart += c[k] * x[v[k]];
        slip += c[k] * (x[v[k]] - start[v[k]]);
        meanMass += 0.25 * mass[v[k]];
    }
    const double distance = pairs.distance[i];
    const Vec3 normal = distance > 0.0 ? Vec3(apart / distance) : Vec3::UnitX().eval();
    slip -= normal.dot(slip) * normal;

    const double young = std::min(primitives.young[a], primitives.young[b]);
    const double stiffness = pairStiffness(young, primitives.radius[a] + primitives.radius[b], meanMass, h);
    const PairEnergy energy = pairEnergy(distance, pairs.range(i), stiffness);
    const double sideways = frictionStiffness(primitives.friction2(a, b), -energy.slope, slip.norm(), kSmoothSpeed * h);

    active.vertices[slot] = v;
    active.firstSide[slot] = primitives.kind(a) == PairKind::EdgeEdge ? 2 : 1;
    active.weights[slot] = c;
    active.normal[slot] = normal;
    active.force[slot] = energy.slope * normal + sideways * slip;
    active.stiffness[slot] = energy.curvature;
    active.frictionStiffness[slot] = sideways;
}

std::size_t FabricContact::candidates() const
{
    return parts_->list.pairs().size();
}

double FabricContact::leastDistance() const
{
    const Primitives& primitives = parts_->list.primitives();
    const Candidates& pairs = parts_->list.pairs();
    return parallelReduce(
        pairs.size(), std::numeric_limits<double>::infinity(),
        [&](std::size_t i) { return pairs.distance[i] / (pairs.reach[i] - primitives.band(pairs.a[i], pairs.b[i])); },
        [](double a, double b) { return std::min(a, b); });
}

}  // namespace sim
