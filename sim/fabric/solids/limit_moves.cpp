#include "sim/core/check.h"
#include "sim/fabric/solids/bisect_interval.h"
#include "sim/fabric/solids/solid_limiter.h"

#include <fmt/format.h>

#include <algorithm>

// What is done about moves that would take fabric through a solid: blows, then moves with the solid, then resting or halves of the time.

namespace sim {

using namespace solids;

namespace {

constexpr int kSlides = 3;                             ///< surfaces along which a vertex slides at most: a corner has three
constexpr int kPushes = 4, kDraws = 6, kCarries = 60;  ///< rounds of each remedy
constexpr int kHelped = 3;                             ///< rounds in which fabric goes with the solid, until what still fails is left to its pins
constexpr double kDrawn = 0.5;                         ///< share of the way to the solid's own motion in a round of drawing [-]
constexpr int kMostCarriers = 3;  ///< solids with which a vertex goes in turn; one that is torn to and fro longer has no straight way between them

}  // namespace

/// Vertices stop at surfaces and go on along them.
bool SolidLimiter::slide(Points x, Moves u)
{
    parallelFor(x.size(), 512, [&](std::size_t v) {
        slid_[v] = 0;
        if (fabric_->pinned[v]) return;
        for (int n = 0; n <= kSlides; ++n) {
            bool any = false;
            for (const Body& body : bodies_)
                if (body.isNear) any = slide(body, v, n == kSlides, x[v], u[v]) || any;
            if (!any) return;
            slid_[v] = 1;
        }
    });
    return std::ranges::any_of(slid_, [](char c) { return c != 0; });
}

bool SolidLimiter::slide(const Body& body, std::size_t v, bool isLast, const Vec3& x, Vec3& u) const
{
    const double kept = kCoreDistance * fabric_->radius[v], distance = body.distance[v];
    const Vec3 from = body.toBegin * x, to = body.toEnd * (x + u);
    if (distance <= 0.0 || distance - body.steepest * (to - from).norm() >= kept) return false;
    SweptElement point;
    point.corners = 1;
    point.from[0] = from;
    point.to[0] = to;
    const SafePart safe = solids::safePart(body.shape, point, distance >= kept ? kept : kKept * distance);
    const Vec3 at = from + safe.part * (to - from), n = body.shape.normal(at);
    const double left = body.shape.distance(at);
    if (safe.part >= 1.0 && left >= std::min(kept, (1.0 - kStays) * distance)) return false;
    const double away = std::max(0.0, kept - left);
    Vec3 end = safe.part < 1.0 ? at : from;
    if (!isLast) end = to + (away - std::min(0.0, n.dot(to - at))) * n;
    u = body.end * end - x;
    return true;
}

/// One after the other: approaches along the normal where an element is nearest become blows without bounce.
void SolidLimiter::applyImpulses(Points x, std::span<const double> mass, Moves u) const
{
    for (const Blocked& b : blocked_) {
        const Body& body = bodies_[b.body];
        const SweptElement element = swept(body, x, u, b.vertices.data(), b.corners);
        const Vec3 at = element.at(b.weights, b.part), n = body.shape.normal(at);
        const double excess = b.lack - n.dot(element.at(b.weights, 1.0) - at);
        double compliance = 0.0;
        for (int c = 0; c < b.corners; ++c)
            if (const int v = b.vertices[c]; !fabric_->pinned[v]) compliance += b.weights[c] * b.weights[c] / mass[v];
        if (!(excess > 0.0) || compliance == 0.0) continue;
        const Vec3 blow = excess / compliance * (body.end.linear() * n);
        for (int c = 0; c < b.corners; ++c)
            if (const int v = b.vertices[c]; !fabric_->pinned[v]) u[v] += b.weights[c] / mass[v] * blow;
    }
}

/// Draws moves of what is blocked towards going with the solid.
void SolidLimiter::carryAlong(Points x, double share, Moves u) const
{
    for (const Blocked& b : blocked_) {
        const Body& body = bodies_[b.body];
        for (int c = 0; c < b.corners; ++c) {
            const int v = b.vertices[c];
            if (!fabric_->pinned[v]) u[v] += share * (body.end * (body.toBegin * x[v]) - x[v] - u[v]);
        }
    }
}

/// Is what is blocked, and about to go with a solid, not torn to and fro between several?
bool SolidLimiter::mayCarry()
{
    bool may = true;
    for (const Blocked& b : blocked_)
        for (int c = 0; c < b.corners; ++c) {
            Carrier& carrier = carriers_[b.vertices[c]];
            carrier.changes += carrier.body != b.body;
            carrier.body = b.body;
            may = may && carrier.changes <= kMostCarriers;
        }
    return may;
}

/// Elements that come too near although all of them that can goes with the solid: their pins take them there.
void SolidLimiter::leaveToPins()
{
    for (const Blocked& b : blocked_)
        if (isHeld(b.vertices.data(), b.corners)) isLeft_[b.element] = 1;
}

SolidLimiter::Limited SolidLimiter::limit(Points x, std::span<const double> mass, Moves u, SolidLimitReport& report)
{
    isNear_ = false;
    if (bodies_.empty()) return {};
    findNear(x, u);
    if (!isNear_) return {};
    measure(x, u);
    bool changed = slide(x, u);
    for (int round = 0;; ++round) {
        if (round > 0) findNear(x, u);
        if (round > 0 || changed) measure(x, u);
        findBlocked(x, u);
        if (blocked_.empty()) return limited(changed ? Limited::Moves::Changed : Limited::Moves::Unchanged);
        if (round == kPushes + kDraws) carriers_.assign(x.size(), {});
        if (round == kPushes + kDraws + kCarries || (round >= kPushes + kDraws && anyMovesNear() && !mayCarry())) break;
        if (round == 0)
            for (const Blocked& b : blocked_) report.stopped.insert(report.stopped.end(), b.vertices.begin(), b.vertices.begin() + b.corners);
        changed = true;
        if (round < kPushes) {
            applyImpulses(x, mass, u);
            slide(x, u);
        } else {
            carryAlong(x, round < kPushes + kDraws ? kDrawn : 1.0, u);
            if (round >= kPushes + kDraws + kHelped) leaveToPins();
        }
    }
    report.left += static_cast<int>(blocked_.size());
    if (anyMovesNear()) return limited(Limited::Moves::Unsafe);
    for (std::size_t v = 0; v < u.size(); ++v)
        if (!fabric_->pinned[v]) u[v].setZero();
    return limited(Limited::Moves::Changed);
}

SolidLimiter::Limited SolidLimiter::limitBisected(double t, double h, Points x, std::span<const double> mass, Moves u, SolidLimitReport& report)
{
    at_.assign(x.begin(), x.end());
    bool changed = false;
    const auto go = [&](double begin, double length) {
        moveTo(begin, begin + length);
        part_.assign(u.begin(), u.end());
        for (Vec3& move : part_) move *= length / h;
        const Limited::Moves moves = limit(at_, mass, part_, report).moves;
        if (moves == Limited::Moves::Unsafe) return false;
        changed = changed || moves == Limited::Moves::Changed;
        for (std::size_t v = 0; v < at_.size(); ++v) at_[v] += part_[v];
        return true;
    };
    if (!bisectInterval(t, h, kMostHalvings, go)) throwNoSafeMove(at_, part_);
    moveTo(t, t + h);
    for (std::size_t v = 0; changed && v < at_.size(); ++v) u[v] = at_[v] - x[v];
    return limited(changed ? Limited::Moves::Changed : Limited::Moves::Unchanged);
}

void SolidLimiter::throwNoSafeMove(Points x, std::span<const Vec3> u)
{
    findNear(x, u);
    std::string names;
    for (const Body& body : bodies_)
        if (body.isNear) names += (names.empty() ? "" : ", ") + body.name;
    throw RunError(
        fmt::format("fabric among obstacles that move ({}) is pushed through one of them: more room between them or slower motion "
                    "would do",
                    names));
}

SolidLimiter::SafeShare SolidLimiter::safePart(Points x, std::span<const Vec3> u)
{
    if (bodies_.empty()) return {};
    findNear(x, u);
    if (!isNear_) return {};
    measure(x, u);
    findBlocked(x, u);
    double part = 1.0;
    for (const Blocked& b : blocked_) part = std::min(part, b.part);
    return {part, anyMovesNear()};
}

}  // namespace sim
