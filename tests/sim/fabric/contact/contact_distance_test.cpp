#include "sim/fabric/contact/closest_points.h"
#include "sim/fabric/contact/limiter.h"
#include "sim/fabric/contact/pair_energy.h"
#include "tests/sim/fabric/pieces.h"

#include <gtest/gtest.h>

#include <random>

namespace sim::test {
namespace {

using namespace contact;
using Corners = std::array<Vec3, 4>;
constexpr PairKind kKinds[] = {PairKind::EdgeEdge, PairKind::VertexFace};

Vec3 separationAt(PairKind kind, const Corners& x, double p, double q)
{
    const std::array<double, 4> c = pairWeights(kind, p, q);
    return c[0] * x[0] + c[1] * x[1] + c[2] * x[2] + c[3] * x[3];
}

/// Least distance by search: for each p the best q along its line, over p by thirds, since that least is convex in p.
double searchedDistance(PairKind kind, const Corners& x)
{
    const auto leastAt = [&](double p) {
        const double most = kind == PairKind::EdgeEdge ? 1.0 : 1.0 - p;
        const Vec3 from = separationAt(kind, x, p, 0.0), along = separationAt(kind, x, p, 1.0) - from;
        const double q = along.squaredNorm() > 0.0 ? std::clamp(-from.dot(along) / along.squaredNorm(), 0.0, most) : 0.0;
        return separationAt(kind, x, p, q).norm();
    };
    double lo = 0.0, hi = 1.0;
    for (int i = 0; i < 150; ++i) {
        const double third = (hi - lo) / 3.0;
        (leastAt(lo + third) < leastAt(hi - third) ? hi : lo) += leastAt(lo + third) < leastAt(hi - third) ? -third : third;
    }
    return std::min({leastAt(lo), leastAt(0.0), leastAt(1.0)});
}

Closest<double> closestOf(PairKind kind, const Corners& x)
{
    return closestPoints<double>(kind, {toVec3T(x[0]), toVec3T(x[1]), toVec3T(x[2]), toVec3T(x[3])});
}

void expectClosest(PairKind kind, const Corners& x, double tolerance)
{
    const Closest<double> c = closestOf(kind, x);
    const Vec3 separation(c.separation.x, c.separation.y, c.separation.z);
    EXPECT_LE((separation - separationAt(kind, x, c.p, c.q)).norm(), 1.0e-14 * 10.0);  // rounding of coordinates up to 10
    EXPECT_NEAR(separation.norm(), searchedDistance(kind, x), tolerance);
    const std::array<double, 4> weights = pairWeights(kind, c.p, c.q);
    for (int k = 0; k < 4; ++k)  // of the first side positive, of the second negative, but for the rounding of p + q
        EXPECT_GE(k < (kind == PairKind::EdgeEdge ? 2 : 1) ? weights[k] : -weights[k], -1.0e-12);
}

Corners randomCorners(std::mt19937& random, double size = 1.0)
{
    std::uniform_real_distribution<double> unit(-size, size);
    Corners x;
    for (Vec3& v : x) v = Vec3(unit(random), unit(random), unit(random));
    return x;
}

// Thirds are told apart by d to about 1e-16, so p is good to 1e-8 where d is smooth, and d to 1e-16; where d ends in a cone, at 0, to 1e-8.
constexpr double kSearched = 1.0e-7;

TEST(ClosestPoints, AgreeWithSearchOfRandomPairs)
{
    std::mt19937 random(1);
    for (PairKind kind : kKinds)
        for (int i = 0; i < 300; ++i) expectClosest(kind, randomCorners(random), kSearched);
}

TEST(ClosestPoints, OfParallelEdgesAreInTheMiddleOfTheOverlap)
{
    const Corners x = {Vec3(0, 0, 0), Vec3(2, 0, 0), Vec3(3, 1, 0), Vec3(1, 1, 0)};
    const Closest<double> c = closestOf(PairKind::EdgeEdge, x);
    EXPECT_NEAR(c.p, 0.75, 1.0e-15);
    EXPECT_NEAR(c.q, 0.75, 1.0e-15);
    expectClosest(PairKind::EdgeEdge, {Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(3, 1, 0), Vec3(2, 1, 0)}, kSearched);
}

TEST(ClosestPoints, OfNearlyParallelEdgesAreAsNear)
{
    std::mt19937 random(2);
    for (double angle : {1.0e-3, 1.0e-5, 1.0e-6, 1.0e-7, 1.0e-9, 1.0e-12})
        for (int i = 0; i < 50; ++i) {
            Corners x = randomCorners(random), nudge = randomCorners(random, angle);
            x[3] = x[2] + 1.3 * (x[1] - x[0]) + nudge[0];
            expectClosest(PairKind::EdgeEdge, x, 1.0e-6);  // at most kParallel^½ of an edge beside the nearest
        }
}

TEST(ClosestPoints, OfDegenerateShapes)
{
    std::mt19937 random(3);
    for (int i = 0; i < 50; ++i) {
        Corners x = randomCorners(random);
        x[1] = x[0];
        expectClosest(PairKind::EdgeEdge, x, kSearched);
        x[3] = x[2];
        expectClosest(PairKind::EdgeEdge, x, kSearched);
        expectClosest(PairKind::VertexFace, x, kSearched);
        x[1] = x[2];
        expectClosest(PairKind::VertexFace, x, kSearched);
        x = randomCorners(random);
        x[3] = x[1] + 0.3 * (x[2] - x[1]);
        expectClosest(PairKind::VertexFace, x, kSearched);
    }
}

TEST(ClosestPoints, PacksAgreeWithScalars)
{
    std::mt19937 random(4);
    for (PairKind kind : kKinds)
        for (int i = 0; i < 20; ++i) {
            std::array<Vec3T<Pack>, 4> packed;
            std::array<Corners, kLanes> x;
            for (int lane = 0; lane < kLanes; ++lane) {
                x[lane] = randomCorners(random);
                for (int c = 0; c < 4; ++c) {
                    packed[c].x[lane] = x[lane][c].x();
                    packed[c].y[lane] = x[lane][c].y();
                    packed[c].z[lane] = x[lane][c].z();
                }
            }
            const Closest<Pack> c = closestPoints(kind, packed);
            for (int lane = 0; lane < kLanes; ++lane) {  // but for contractions of the compiler's choice
                EXPECT_NEAR(c.p[lane], closestOf(kind, x[lane]).p, 1.0e-12);
                EXPECT_NEAR(c.q[lane], closestOf(kind, x[lane]).q, 1.0e-12);
            }
        }
}

TEST(RelativeMotion, BoundsTheChangeOfDistance)
{
    std::mt19937 random(5);
    for (PairKind kind : kKinds)
        for (int i = 0; i < 2000; ++i) {
            const Corners x = randomCorners(random), u = randomCorners(random, 0.5);
            Corners y;
            for (int c = 0; c < 4; ++c) y[c] = x[c] + u[c];
            const double motion = relativeMotion(kind, {toVec3T(u[0]), toVec3T(u[1]), toVec3T(u[2]), toVec3T(u[3])});
            const auto distance = [&](const Corners& z) {
                const Vec3T<double> s = closestOf(kind, z).separation;
                return std::sqrt(dot(s, s));
            };
            EXPECT_LE(std::abs(distance(y) - distance(x)), motion * (1.0 + 1.0e-12));
        }
}

TEST(CollisionFreeFraction, StopsBeforeAndNotLongBeforeTheMeeting)
{
    std::mt19937 random(6);
    int stopped = 0;
    for (PairKind kind : kKinds)
        for (int i = 0; i < 1000; ++i) {
            const Corners x = randomCorners(random), u = randomCorners(random, 2.0);
            const auto distanceAt = [&](double t) {
                Corners y;
                for (int c = 0; c < 4; ++c) y[c] = x[c] + t * u[c];
                const Vec3T<double> s = closestOf(kind, y).separation;
                return std::sqrt(dot(s, s));
            };
            const double separation = 0.3 * distanceAt(0.0);
            const double fraction = collisionFreeFraction(kind, x, u, separation);
            double least = 1.0e30;
            for (int k = 0; k <= 400; ++k) least = std::min(least, distanceAt(fraction * k / 400.0));
            EXPECT_GE(least, separation * (1.0 - 1.0e-12));
            if (fraction == 1.0) continue;
            ++stopped;
            EXPECT_LT(distanceAt(fraction) - separation, 0.1 * (distanceAt(0.0) - separation));  // stops at a tenth of the gap
        }
    EXPECT_GT(stopped, 50);
}

constexpr ContactDistances kRange = {0.108, 0.0547};

TEST(PairEnergy, DerivativesMatchDifferences)
{
    const double parabola = kRange.core + 0.02 * (kRange.wall() - kRange.core);  // begins below
    for (double d = 0.9 * kRange.core; d < 1.1 * kRange.reach; d += 1.01e-4) {
        // Between, the logarithm's third derivatives are too large for differences.
        if (d > parabola - 1.0e-6 && d < kRange.core + 0.04 * (kRange.reach - kRange.core)) continue;
        constexpr double kEps = 1.0e-7;  // error: third derivative · ε² / 6, relative to E' up to (ε / 0.3e-3)² ≈ 1e-7
        if (std::abs(d - kRange.wall()) < 2 * kEps || std::abs(d - kRange.reach) < 2 * kEps) continue;  // curvature jumps there
        const PairEnergy e = pairEnergy(d, kRange, 1.0e4);
        const PairEnergy after = pairEnergy(d + kEps, kRange, 1.0e4), before = pairEnergy(d - kEps, kRange, 1.0e4);
        EXPECT_NEAR((after.energy - before.energy) / (2 * kEps), e.slope, 1.0e-5 * (1.0 + std::abs(e.slope))) << d;
        EXPECT_NEAR((after.slope - before.slope) / (2 * kEps), e.curvature, 1.0e-5 * (1.0 + e.curvature)) << d;
        EXPECT_LE(e.slope, 0.0);
        EXPECT_GE(e.curvature, 0.0);
    }
}

TEST(PairEnergy, IsSmoothAtTheWallAndZeroAtTheReach)
{
    constexpr double kEps = 1.0e-13;
    const PairEnergy above = pairEnergy(kRange.wall() + kEps, kRange, 1.0e4), below = pairEnergy(kRange.wall() - kEps, kRange, 1.0e4);
    EXPECT_NEAR(above.energy, below.energy, 1.0e-9 * above.energy);  // energy and slope change by 1e-11 and 1e-10 over 2 ε
    EXPECT_NEAR(above.slope, below.slope, -1.0e-9 * above.slope);
    EXPECT_EQ(pairEnergy(kRange.reach, kRange, 1.0e4).energy, 0.0);
    EXPECT_EQ(pairEnergy(kRange.reach, kRange, 1.0e4).slope, 0.0);
    const PairEnergy light = pairEnergy(kRange.reach - 1.0e-9, kRange, 1.0e4);
    EXPECT_NEAR(light.slope, 0.0, 1.0e-8);
    EXPECT_NEAR(light.curvature, 0.0, 0.1);  // of 1e4: it grows from 0
}

TEST(PairEnergy, WallIsLastInsideTheCore)
{
    const PairEnergy inside = pairEnergy(0.5 * kRange.core, kRange, 1.0e4);
    EXPECT_TRUE(std::isfinite(inside.energy));
    EXPECT_LT(inside.slope, pairEnergy(kRange.wall(), kRange, 1.0e4).slope);
}

/// Limited moves may leave a pair a little below its core. Held there by a force that no longer grew, under a stiffness as high as ever, it
/// came out by a fiftieth of the wall per iteration and stayed below for many steps.
TEST(PairEnergy, OneNewtonStepLeadsOutOfTheCore)
{
    for (double d = 0.5 * kRange.core; d < kRange.core; d += 1.0e-4) {
        const PairEnergy e = pairEnergy(d, kRange, 1.0e4);
        const double reached = d - e.slope / e.curvature;
        EXPECT_GT(reached, kRange.core) << d;
        EXPECT_LT(reached, kRange.wall()) << d;
    }
}

/// Iterations of a mass that is pressed against a pair's spring, until the force that they find errs by less than a hundredth of the load.
/// @param give  how far the mass gives way, relative to the spring's force [cm/dyn]
int iterationsUnder(double load, double give, double from, bool goesByForce)
{
    constexpr double kStiffness = 1.0e4;
    const auto forceAt = [&](double way) { return -pairEnergy(kRange.reach - way, kRange, kStiffness).slope; };
    double low = 0.0, high = kRange.reach - kRange.wall();  // the way at rest: forceAt(way) = load there, and less the more the mass gives way
    const double free = give * load + [&] {
        for (int i = 0; i < 100; ++i) (forceAt(0.5 * (low + high)) < load ? low : high) = 0.5 * (low + high);
        return low;
    }();
    double way = from, found = 0.0;
    for (int i = 1; i <= 50; ++i) {
        const double distance = kRange.reach - way;
        const PairEnergy e = goesByForce && i > 1 ? pairTangent(distance, kRange, kStiffness, found) : pairEnergy(distance, kRange, kStiffness);
        const double next = (free + give * (e.slope + e.curvature * way)) / (1.0 + give * e.curvature);
        found = -e.slope + e.curvature * (next - way);
        way = std::clamp(next, 0.0, 0.999 * (kRange.reach - kRange.wall()));
        if (std::abs(found - load) < 1.0e-2 * load && std::abs(forceAt(way) - load) < 1.0e-2 * load) return i;
    }
    return 50;
}

TEST(PairTangent, FindsLightAndHeavyLoadsInFewIterations)
{
    testing::Noise random(3);
    int most = 0, mostBefore = 0, sum = 0, sumBefore = 0;
    for (int i = 0; i < 1000; ++i) {
        const double load = 150.0 * std::pow(10.0, -1.5 * (1.0 + random())), give = std::pow(10.0, -3.0 + 2.0 * random());
        const double from = 0.5 * (1.0 + random()) * 0.9 * (kRange.reach - kRange.wall()) + 1.0e-4;
        const int now = iterationsUnder(load, give, from, true), before = iterationsUnder(load, give, from, false);
        most = std::max(most, now), mostBefore = std::max(mostBefore, before);
        sum += now, sumBefore += before;
    }
    EXPECT_LE(most, 5);
    EXPECT_GE(mostBefore, 7);  // by halves
    EXPECT_LT(sum, 0.9 * sumBefore);
}

TEST(PairTangent, IsTheSpringWhereItHasTheForce)
{
    for (double d = kRange.wall() + 1.0e-4; d < kRange.reach; d += 1.0e-4) {
        const PairEnergy e = pairEnergy(d, kRange, 1.0e4), tangent = pairTangent(d, kRange, 1.0e4, -e.slope);
        EXPECT_NEAR(tangent.slope, e.slope, 1.0e-10) << d;
        EXPECT_NEAR(tangent.curvature, e.curvature, 1.0e-8) << d;
        for (double force : {-100.0, 0.0, 1.0, 100.0}) {
            EXPECT_LE(pairTangent(d, kRange, 1.0e4, force).slope, 0.0);
            EXPECT_GE(pairTangent(d, kRange, 1.0e4, force).curvature, 0.0);
        }
    }
}

TEST(PairStiffness, IsTheFibresOrWhatAStepResolves)
{
    const double mass = 6.6e-4, young = 6.6e7 * 0.16, touching = 0.096;
    EXPECT_NEAR(pairStiffness(young, touching, mass, 1.0e-3), 100.0 * mass / 1.0e-6, 1.0e-9);
    EXPECT_NEAR(pairStiffness(young, touching, mass, 2.0e-4), 0.1 * young * touching, 1.0e-9);
    EXPECT_NEAR(pairStiffness(1.0, touching, mass, 1.0e-3), 4.0 * mass / 1.0e-6, 1.0e-9);
}

TEST(GripStiffness, LetsAPairGiveNoFurtherThanItIsPressed)
{
    EXPECT_EQ(pairFrictionStiffness(0.5, 0.5, 3.0), 12.0);   // pressed lightly: what stops the masses
    EXPECT_EQ(pairFrictionStiffness(10.0, 0.5, 3.0), 20.0);  // pressed hard: N over how far
}

}  // namespace
}  // namespace sim::test
