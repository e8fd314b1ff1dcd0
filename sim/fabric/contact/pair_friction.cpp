#include "sim/core/parallel.h"
#include "sim/fabric/contact/contact_parts.h"
#include "sim/fabric/contact/pair_turn.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace sim {

using namespace contact;

namespace {

constexpr double kOfChord = 0.5;  ///< part of the chord's stiffness of friction that slides, from the second iteration on [-]

}  // namespace

/// body(slot, place) for the active pairs that are among others, which lie in the same order.
template <class Body>
void FabricContact::Parts::forEachKnown(std::span<const Vec2i> between, Body&& body) const
{
    std::size_t next = 0;
    const auto find = [&](std::span<const PairPlace> places, std::size_t first) {
        for (std::size_t i = 0; i < places.size(); ++i) {
            const Vec2i pair(places[i].a, places[i].b);
            while (next < between.size() && FrictionForces::isBefore(between[next], pair)) ++next;
            if (next < between.size() && between[next] == pair) body(first + i, next);
        }
    };
    find(edgePairs, 0);
    find(facePairs, edgePairs.size());
}

/// What friction holds on each of the active pairs.
void FabricContact::Parts::findHeld()
{
    std::ranges::fill(heldForce, Vec3::Zero());
    forEachKnown(held.between, [&](std::size_t slot, std::size_t place) { heldForce[slot] = held.force[place]; });
}

/// Normal force of an active pair where its force and stiffness lead it, below 0 where it lets go [dyn].
double FabricContact::Parts::pressOf(std::size_t slot, std::span<const Vec3> x) const
{
    Vec3 moved = -frictionPairs[slot].apart;
    for (std::size_t k = 0; k < 4; ++k) moved += active.weights[slot][k] * x[active.vertices[slot][k]];
    return frictionPairs[slot].pull - (active.force[slot] + active.stiffness[slot] * moved).dot(active.normal[slot]);
}

/// Keeps the normal forces that an iteration found on its way to x, for the next.
void FabricContact::Parts::keepFound(std::span<const Vec3> x)
{
    foundBetween.clear();
    if (isLookedAt) foundBetween = active.between;
    isLookedAt = true;
    foundPress.resize(foundBetween.size());
    parallelFor(foundPress.size(), 512, [&](std::size_t i) { foundPress[i] = pressOf(i, x); });
}

void FabricContact::Parts::findPress()
{
    std::ranges::fill(press, std::numeric_limits<double>::quiet_NaN());
    forEachKnown(foundBetween, [&](std::size_t slot, std::size_t place) { press[slot] = foundPress[place]; });
}

std::array<Vec3, 2> FabricContact::Parts::directionsAt(std::span<const Vec3> x, std::size_t slot) const
{
    const std::array<int, 4>& v = active.vertices[slot];
    const auto ends = directionsOfPair(active.firstSide[slot]);
    return {x[v[ends[0][1]]] - x[v[ends[0][0]]], x[v[ends[1][1]]] - x[v[ends[1][0]]]};
}

/// Mobility of an active pair's separation across its normal, with what turns the pair: mean over the two directions [1/g].
double FabricContact::Parts::mobility(std::size_t slot) const
{
    const std::array<Vec3, 2> tangent = tangentsOf(active.normal[slot]);
    const auto ends = directionsOfPair(active.firstSide[slot]);
    std::array<std::array<Vec3, 2>, 4> answer;  // of the separation along both tangents to each vertex
    for (int k = 0; k < 4; ++k)
        for (int j = 0; j < 2; ++j) answer[k][j] = active.weights[slot][k] * tangent[j];
    for (int n = 0; n < 2; ++n)
        for (int j = 0; j < 2; ++j) {
            answer[ends[n][0]][j] += active.lever[slot][n][j];
            answer[ends[n][1]][j] -= active.lever[slot][n][j];
        }
    double sum = 0.0;
    for (int k = 0; k < 4; ++k) sum += 0.5 * inverseMass[active.vertices[slot][k]] * (answer[k][0].squaredNorm() + answer[k][1].squaredNorm());
    return sum;
}

/// Friction of an active pair that is described but for it, at x or where the moves expected lead; gives the pair its lever.
Friction FabricContact::Parts::friction(std::span<const Vec3> x, std::span<const Vec3> expected, const PairEnergy& energy, double distance,
                                        std::size_t slot)
{
    const FrictionPair& pair = frictionPairs[slot];
    const double pressed = pair.range.reach - distance;
    active.frictionStiffness[slot] = 0.0;
    if (!(pair.coefficient > 0.0 && pressed > 0.0)) return {Vec3::Zero()};
    const std::array<int, 4>& v = active.vertices[slot];
    const std::array<double, 4>& c = active.weights[slot];
    const Vec3& normal = active.normal[slot];
    const Vec3& apart = pair.apart;
    Vec3 before = Vec3::Zero(), further = Vec3::Zero();
    for (std::size_t k = 0; k < 4; ++k) {
        before += c[k] * start[v[k]];
        if (!expected.empty()) further += c[k] * expected[v[k]];
    }
    const PairTurn turn(active.firstSide[slot], v, start, x);
    const auto along = [&](const Vec3& u) -> Vec3 { return u - normal.dot(u) * normal; };
    const Vec3 carried = turn * before;
    // What pressed at the end of the last iteration is nearer to what will than what presses at x.
    const bool isKnown = !std::isnan(press[slot]);
    const double normalForce = isKnown ? std::max(press[slot], 0.0) : -energy.slope;
    const FrictionSpring spring{along(turn * heldForce[slot]), pairFrictionStiffness(-energy.slope, pressed, pair.perStep),
                                pair.coefficient * normalForce};
    active.lever[slot] = turn.lever(before, tangentsOf(normal));  // what presses is not felt as a moment
    active.frictionStiffness[slot] = spring.stiffness;
    if (expected.empty()) return spring.at(along(apart - carried), isKnown ? kOfChord : 1.0);
    return spring.expected(along(apart - carried), along(before + further - carried), h * h * mobility(slot) * spring.stiffness);
}

FabricContact::Parts::Acted FabricContact::Parts::actedOn(std::size_t i, std::span<const Vec3> x) const
{
    const Vec3& n = active.normal[i];
    Vec3 apart = Vec3::Zero();
    for (std::size_t k = 0; k < 4; ++k) apart += active.weights[i][k] * x[active.vertices[i][k]];
    const Vec3 moved = apart - frictionPairs[i].apart;
    Vec3 slid = moved;
    if (active.frictionStiffness[i] > 0.0) {
        const std::array<Vec3, 2> now = directionsAt(x, i);
        slid -= active.turned(i, {now[0] - frictionPairs[i].directions[0], now[1] - frictionPairs[i].directions[1]});
    }
    const Vec3 acted = active.force[i] + active.frictionStiffness[i] * slid;
    return {apart, acted - acted.dot(n) * n, frictionPairs[i].coefficient * std::max(pressOf(i, x), 0.0)};
}

/// Mass of the vertices of the active pairs that are not pinned [g].
double FabricContact::Parts::touchingMass()
{
    isTouching.assign(mass.size(), 0);
    for (const std::array<int, 4>& pair : active.vertices)
        for (int v : pair) isTouching[v] = 1;
    return parallelSum(mass.size(), [&](std::size_t v) { return isTouching[v] && inverseMass[v] > 0.0 ? mass[v] : 0.0; });
}

double FabricContact::Active::frictionError(std::span<const Vec3> x, double acceleration) const
{
    Parts& p = *parts_;
    using Sums = std::array<double, 2>;
    const auto [wrong, bound] = parallelReduce(
        p.active.size(), Sums{},
        [&](std::size_t i) {
            const Parts::Acted acted = p.actedOn(i, x);
            const double beyond = acted.friction.norm() - acted.bound;
            return Sums{p.frictionPairs[i].slides ? std::abs(beyond) : std::max(beyond, 0.0), acted.bound};
        },
        [](const Sums& a, const Sums& b) {
            return Sums{a[0] + b[0], a[1] + b[1]};
        });
    return wrong > 0.0 ? wrong / std::max(bound, acceleration * p.touchingMass()) : 0.0;
}

void FabricContact::Active::storeFriction(std::span<const Vec3> x, FrictionForces& held) const
{
    Parts& p = *parts_;
    std::vector<Vec3>& force = p.keptForce;
    force.resize(p.active.size());
    parallelFor(force.size(), 512, [&](std::size_t i) {
        const Parts::Acted acted = p.actedOn(i, x);
        const bool touches = acted.apart.dot(p.active.normal[i]) < p.frictionPairs[i].range.reach;
        force[i] = touches ? atMost(acted.bound, acted.friction) : Vec3::Zero().eval();
    });
    held.clear();
    for (std::size_t i = 0; i < force.size(); ++i)
        if (!force[i].isZero(0.0)) held.add(p.active.between[i], force[i]);
}

}  // namespace sim
