#include "sim/coupling/drip.h"

#include "sim/core/check.h"
#include "sim/core/parallel.h"
#include "sim/core/random.h"

#include <algorithm>
#include <limits>

namespace sim {

namespace {

constexpr std::uint64_t kSeed = 0x44726970;  // "Drip"
constexpr double kJitter = 0.5;              ///< of the way to a random point of the element [-]

}  // namespace

Drip::Drip(const Fabric& fabric, const WetElements& elements, const Settings& settings, double nominalMass)
    : elements_(elements),
      capacity_(poreCapacity(fabric, settings.liquid.density)),
      excess_(fabric.vertexCount()),
      nominalMass_(nominalMass)
{
}

/// One particle made of these masses of the element's corners [g], beside their centre.
void Drip::release(int element, const std::array<double, 3>& part, const Vec3& offset, State& state) const
{
    if (state.nextId == std::numeric_limits<std::uint32_t>::max())
        throw RunError("fabric has dripped more particles than can be numbered (2^32)");
    FabricState& fabric = state.fabric;
    double mass = 0.0;
    Vec3 moment = Vec3::Zero(), momentum = Vec3::Zero();
    for (int c = 0; c < elements_.corners(element); ++c) {
        const int v = elements_.vertices[element][c];
        fabric.absorbed[v] -= part[c];
        mass += part[c];
        moment += part[c] * fabric.x[v];
        momentum += part[c] * fabric.v[v];
    }
    state.liquid.add(moment / mass + offset, mass, state.nextId++, momentum / mass);
}

/// From the middle of an element towards a random point of it [cm].
Vec3 Drip::jitter(int element, std::uint64_t number, const State& state) const
{
    const CounterRandom random(kSeed, static_cast<std::uint64_t>(element), static_cast<std::uint64_t>(state.step));
    const std::array<int, 3>& v = elements_.vertices[element];
    const std::vector<Vec3>& x = state.fabric.x;
    double u = random.uniform(number, 0), w = random.uniform(number, 1);
    if (v[2] < 0) return kJitter * (u - 0.5) * (x[v[1]] - x[v[0]]);
    if (u + w > 1.0) u = 1.0 - u, w = 1.0 - w;
    return kJitter * ((u - 1.0 / 3.0) * (x[v[1]] - x[v[0]]) + (w - 1.0 / 3.0) * (x[v[2]] - x[v[0]]));
}

double Drip::drip(State& state)
{
    FabricState& fabric = state.fabric;
    parallelFor(excess_.size(), 4096, [&](std::size_t v) { excess_[v] = std::max(fabric.absorbed[v] - capacity_[v], 0.0); });
    if (!(parallelMax(excess_.size(), [&](std::size_t v) { return excess_[v]; }) > 0.0)) return 0.0;

    double sum = 0.0;
    for (std::size_t e = 0; e < elements_.size(); ++e) {
        std::array<double, 3> part{};
        double whole = 0.0;
        for (int c = 0; c < elements_.corners(e); ++c) {
            part[c] = excess_[elements_.vertices[e][c]] * elements_.share[e][c];
            whole += part[c];
        }
        const int count = static_cast<int>(whole / nominalMass_);
        for (double& m : part) m *= whole > 0.0 ? nominalMass_ / whole : 0.0;
        const int element = static_cast<int>(e);
        for (int k = 0; k < count; ++k) {
            // In pairs on opposite sides, and a last one in the middle: their centre stays.
            const Vec3 offset = k == count - 1 && k % 2 == 0 ? Vec3::Zero() : jitter(element, k / 2, state);
            release(element, part, k % 2 == 0 ? offset : Vec3(-offset), state);
        }
        sum += count * nominalMass_;
    }
    return sum;
}

}  // namespace sim
