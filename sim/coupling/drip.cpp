#include "sim/coupling/drip.h"

#include "sim/core/check.h"
#include "sim/core/parallel.h"
#include "sim/core/random.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>

namespace sim {

namespace {

constexpr std::uint64_t kSeed = 0x44726970;  // "Drip"
constexpr double kJitter = 0.5;              ///< share of the way to a corner of an element of the pool, by which a drop is off the middle [-]
constexpr double kLeastDrop = 1.0e-3;        ///< least drop, relative to the nominal mass: less stays, as it would all but vanish [-]

}  // namespace

Drip::Drip(const Fabric& fabric, const PorousElements& elements, const Settings& settings, double nominalMass)
    : elements_(elements),
      capacity_(poreCapacity(fabric, settings.liquid.density)),
      excess_(fabric.vertexCount()),
      nominalMass_(nominalMass),
      cell_(settings.cell)
{
}

/// Vertices with too much, those of a cell one behind the other.
void Drip::findPools(const FabricState& fabric)
{
    wet_.clear();
    for (std::size_t v = 0; v < excess_.size(); ++v)
        if (excess_[v] > 0.0) wet_.push_back({(fabric.x[v] / cell_).array().floor().cast<int>().matrix(), static_cast<int>(v)});
    const auto key = [](const Wet& w) { return std::make_tuple(w.cell.z(), w.cell.y(), w.cell.x(), w.vertex); };
    std::ranges::sort(wet_, [&](const Wet& a, const Wet& b) { return key(a) < key(b); });
}

/// Displacement from the middle of a pool towards a random corner of the elements at it [cm].
Vec3 Drip::jitter(std::span<const Wet> pool, const Vec3& middle, std::uint64_t number, const State& state) const
{
    const CounterRandom random(kSeed, static_cast<std::uint64_t>(pool[0].vertex), static_cast<std::uint64_t>(state.step));
    const auto pick = [&](int draw, std::size_t count) {
        return std::min(static_cast<std::size_t>(random.uniform(number, draw) * static_cast<double>(count)), count - 1);
    };
    const int v = pool[pick(0, pool.size())].vertex, first = elements_.begin[v];
    const std::size_t e = elements_.at[first + pick(1, elements_.begin[v + 1] - first)];
    return kJitter * (state.fabric.x[elements_.vertices[e][pick(2, elements_.corners(e))]] - middle);
}

/// All that a pool has too much comes off, in drops of about the nominal mass.
/// @return that [g]
double Drip::drain(std::span<const Wet> pool, const Obstacles& obstacles, State& state) const
{
    FabricState& fabric = state.fabric;
    double mass = 0.0, over = 0.0;
    Vec3 moment = Vec3::Zero(), momentum = Vec3::Zero();
    for (const Wet& w : pool) {
        const double excess = excess_[w.vertex];
        mass += excess;
        over = std::max(over, excess - kMostOver * capacity_[w.vertex]);
        moment += excess * fabric.x[w.vertex];
        momentum += excess * fabric.v[w.vertex];
    }
    if (mass < kLeastDrop * nominalMass_ || (mass < nominalMass_ && !(over > 0.0))) return 0.0;
    const Vec3 middle = moment / mass;
    if (obstacles.distance(middle) < 0.0) return 0.0;
    for (const Wet& w : pool) fabric.absorbed[w.vertex] -= excess_[w.vertex];
    const int count = std::max(1, static_cast<int>(std::lround(mass / nominalMass_)));
    for (int k = 0; k < count; ++k) {
        if (state.nextId == std::numeric_limits<std::uint32_t>::max())
            throw RunError("fabric has dripped more particles than can be numbered (2^32)");
        // In pairs on opposite sides, and a last one in the middle: their centre stays.
        const bool isAlone = k == count - 1 && k % 2 == 0;
        Vec3 offset = isAlone ? Vec3::Zero().eval() : jitter(pool, middle, k / 2, state);
        if (obstacles.distance(middle + offset) < 0.0 || obstacles.distance(middle - offset) < 0.0) offset.setZero();
        state.liquid.add(middle + (k % 2 == 0 ? 1.0 : -1.0) * offset, mass / count, state.nextId++, momentum / mass);
    }
    return mass;
}

double Drip::drip(State& state, const Obstacles& obstacles)
{
    const std::vector<double>& absorbed = state.fabric.absorbed;
    parallelFor(excess_.size(), 4096, [&](std::size_t v) { excess_[v] = std::max(absorbed[v] - capacity_[v], 0.0); });
    if (!(parallelMax(excess_.size(), [&](std::size_t v) { return excess_[v]; }) > 0.0)) return 0.0;
    findPools(state.fabric);
    double sum = 0.0;
    for (std::size_t begin = 0, end; begin < wet_.size(); begin = end) {
        for (end = begin + 1; end < wet_.size() && wet_[end].cell == wet_[begin].cell; ++end) {
        }
        sum += drain(std::span(wet_).subspan(begin, end - begin), obstacles, state);
    }
    return sum;
}

}  // namespace sim
