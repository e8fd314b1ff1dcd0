#include "app/diff/state_diff.h"

#include "sim/state_hash.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace app {

namespace {

/// Numbers of the particles in the order of their ids.
std::vector<std::size_t> orderOfIds(const sim::LiquidParticles& liquid)
{
    std::vector<std::size_t> order(liquid.count);
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::ranges::sort(order, {}, [&](std::size_t p) { return liquid.id[p]; });
    return order;
}

}  // namespace

void StateDiff::Largest::offer(double difference, std::uint64_t id, double t)
{
    if (std::isnan(difference)) difference = std::numeric_limits<double>::infinity();
    if (difference > value) value = difference, who = id, time = t;
}

void StateDiff::Missing::offer(const std::vector<std::uint64_t>& ids, double t)
{
    if (ids.size() > most) most = ids.size(), first = ids.front(), time = t;
}

void StateDiff::add(const sim::State& a, const sim::State& b)
{
    ++states_;
    const double difference = std::abs(a.time - b.time);
    if (!differsFrom_ && (difference != 0.0 || sim::stateHash(a) != sim::stateHash(b))) differsFrom_ = a.time;
    addLiquid(a.liquid, b.liquid, a.time);
    addFabric(a.fabric, b.fabric, a.time);
}

void StateDiff::addLiquid(const sim::LiquidParticles& a, const sim::LiquidParticles& b, double time)
{
    const std::vector<std::size_t> orderA = orderOfIds(a), orderB = orderOfIds(b);
    std::vector<std::uint64_t> onlyA, onlyB;
    std::size_t i = 0, j = 0;
    while (i < orderA.size() || j < orderB.size()) {
        if (j == orderB.size() || (i < orderA.size() && a.id[orderA[i]] < b.id[orderB[j]])) {
            onlyA.push_back(a.id[orderA[i++]]);
        } else if (i == orderA.size() || b.id[orderB[j]] < a.id[orderA[i]]) {
            onlyB.push_back(b.id[orderB[j++]]);
        } else {
            const std::size_t p = orderA[i++], q = orderB[j++];
            position_.offer((a.position(p) - b.position(q)).norm(), a.id[p], time);
            velocity_.offer((a.velocity(p) - b.velocity(q)).norm(), a.id[p], time);
            mass_.offer(std::abs(a.mass[p] - b.mass[q]), a.id[p], time);
        }
    }
    onlyA_.offer(onlyA, time);
    onlyB_.offer(onlyB, time);
}

void StateDiff::addFabric(const sim::FabricState& a, const sim::FabricState& b, double time)
{
    verticesA_ = std::max(verticesA_, a.x.size());
    verticesB_ = std::max(verticesB_, b.x.size());
    for (std::size_t v = 0; v < std::min(a.x.size(), b.x.size()); ++v) {
        vertexPosition_.offer((a.x[v] - b.x[v]).norm(), v, time);
        vertexVelocity_.offer((a.v[v] - b.v[v]).norm(), v, time);
    }
    for (std::size_t v = 0; v < std::min(a.absorbed.size(), b.absorbed.size()); ++v)
        absorbed_.offer(std::abs(a.absorbed[v] - b.absorbed[v]), v, time);
}

std::vector<DiffFinding> StateDiff::findings(const Tolerance& tolerance) const
{
    std::vector<DiffFinding> findings;
    const auto add = [&](const char* what, const char* whose, const Largest& largest, double limit) {
        DiffFinding& finding = findings.emplace_back(DiffFinding{what, {}, largest.value > limit});
        if (largest.value > 0.0)
            finding.words = fmt::format("{:.3g} {} apart, {} {} at {:.6g} s", largest.value, largest.unit, whose, largest.who, largest.time);
    };
    const auto addMissing = [&](const char* where, const Missing& missing) {
        if (missing.most > 0)
            findings.push_back(
                {"particles", fmt::format("{} only in {} at {:.6g} s, particle {} is one", missing.most, where, missing.time, missing.first), true});
    };
    addMissing("A", onlyA_);
    addMissing("B", onlyB_);
    if (verticesA_ != verticesB_) findings.push_back({"vertices", fmt::format("{} against {}", verticesA_, verticesB_), true});
    add("positions of particles", "particle", position_, tolerance.position);
    add("velocities of particles", "particle", velocity_, tolerance.velocity);
    add("masses of particles", "particle", mass_, tolerance.mass);
    if (verticesA_ + verticesB_ == 0) return findings;
    add("positions of vertices", "vertex", vertexPosition_, tolerance.position);
    add("velocities of vertices", "vertex", vertexVelocity_, tolerance.velocity);
    add("liquid absorbed at vertices", "vertex", absorbed_, tolerance.mass);
    return findings;
}

}  // namespace app
