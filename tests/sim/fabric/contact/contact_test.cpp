#include "sim/core/check.h"
#include "sim/fabric/contact/candidate_list.h"
#include "sim/fabric/contact/pair_energy.h"
#include "tests/sim/fabric/contact/contact_scenes.h"

#include <gtest/gtest.h>

#include <limits>
#include <set>

namespace sim::test {
namespace {

using namespace contact;

/// Two straight yarns that cross at right angles, their middles `gap` apart.
Fabric crossing(double gap, double radius = 0.05)
{
    ContactScene scene;
    scene.addYarn({-0.2, 0.0, 0.0}, {0.2, 0.0, 0.0}, 1, radius);
    scene.addYarn({0.0, gap, -0.2}, {0.0, gap, 0.2}, 1, radius);
    return scene.fabric;
}

/// The same at rest far apart, then brought to `gap`.
struct Pressed : ContactRun {
    explicit Pressed(double gap) : ContactRun(crossing(0.5))
    {
        for (int v : {2, 3}) x[v].y() = gap;
        contact.beginStep(x, fabric.mass, kStep, kStep);
    }
};

TEST(FabricContact, PairsOfTheWeaveAreAsManyAsWereCounted)
{
    const Fabric sheet = wovenSheet(100);
    EXPECT_EQ(sheet.vertexCount(), 19604u);
    EXPECT_EQ(sheet.edges.size(), 19800u);
    const CandidateList list(sheet);
    EXPECT_EQ(list.restPairs().partner.size(), 26460u);  // within 2 r + 0.012 cm (fabric/contact/README.md, Pairs)
    EXPECT_EQ(std::ranges::count_if(list.restPairs().distance, [](double d) { return d < 0.096; }),
              7252);  // overlapping
}

TEST(FabricContact, WeaveAtRestIsFreeOfForces)
{
    ContactRun run(wovenSheet(20));
    EXPECT_TRUE(run.active().empty());
    EXPECT_GT(run.contact.candidates(), 0u);
    EXPECT_GT(run.contact.leastDistance(), 1.0);
}

TEST(FabricContact, ClothAtRestIsFreeOfForces)
{
    ContactScene scene;  // its vertices are nearer to each other than it is thick
    scene.addCloth({0, 0, 0}, {0.03, 0, 0}, {0, 0, 0.03}, 8, 8, 0.05);
    scene.addCloth({0, 0.06, 0}, {0.03, 0, 0}, {0, 0, 0.03}, 8, 8, 0.05);
    ContactRun run(scene.fabric);
    EXPECT_TRUE(run.active().empty());
    EXPECT_GT(run.contact.candidates(), 0u);
}

TEST(FabricContact, NeighboursOnAYarnDoNotTouchButItsEndsMay)
{
    ContactScene straight;
    straight.addYarn({0, 0, 0}, {2, 0, 0}, 40, 0.05);
    EXPECT_TRUE(CandidateList(straight.fabric).restPairs().partner.empty());

    ContactScene hairpin;
    std::vector<int> yarn;
    for (int j = 0; j < 20; ++j) yarn.push_back(hairpin.addVertex({0.05 * j, 0, 0}));
    for (int j = 19; j >= 0; --j) yarn.push_back(hairpin.addVertex({0.05 * j, 0.11, 0}));
    hairpin.addStrand(yarn, 0.05);
    EXPECT_GT(CandidateList(hairpin.fabric).restPairs().partner.size(), 20u);
}

TEST(FabricContact, HeldVerticesAloneMakeNoPair)
{
    ContactScene scene;
    scene.fabric = crossing(0.15);
    EXPECT_EQ(allPairs(scene.fabric).size(), 1u);
    for (int v = 0; v < 4; ++v) scene.pin(v);
    EXPECT_TRUE(allPairs(scene.fabric).empty());
}

TEST(FabricContact, ClothEdgesAreUniqueAndYarnsAlongThemCountOnce)
{
    ContactScene scene;
    scene.addCloth({0, 0, 0}, {0.2, 0, 0}, {0, 0, 0.2}, 2, 2, 0.01);
    EXPECT_EQ(Primitives(scene.fabric).edgeCount, 16);  // V − E + F = 1
    scene.addStrand({0, 1, 2}, 0.02);
    const Primitives sewn(scene.fabric);
    EXPECT_EQ(sewn.edgeCount, 16);
    EXPECT_EQ(sewn.radius[0], 0.02);
}

TEST(FabricContact, WithoutNeighboursOnlyTheListIsCharged)
{
    ContactRun run(crossing(1.0));
    EXPECT_TRUE(run.active().empty());
    run.moveSafely(randomMoves(run.fabric, 0.1, 1));
    EXPECT_EQ(run.contact.leastDistance(), std::numeric_limits<double>::infinity());
    EXPECT_TRUE(run.step.stageRan[static_cast<int>(Stage::FabricCandidates)]);
    EXPECT_FALSE(run.step.stageRan[static_cast<int>(Stage::FabricContact)]);
}

TEST(FabricContact, GradientIsThatOfTheEnergy)
{
    for (double gap : {0.11, 0.1, 0.085, 0.075, 0.065}) {
        Pressed run(gap);
        for (Vec3& x : run.x) x += Vec3(0.01, 0.003, -0.02).cwiseProduct(x);  // not so symmetric
        run.contact.beginStep(run.x, run.fabric.mass, ContactRun::kStep, ContactRun::kStep);
        const ActiveContacts contacts = run.active();
        ASSERT_EQ(contacts.size(), 1u);
        const NearPair pair = allPairs(run.fabric).at(0);
        const double stiffness =
            pairStiffness(run.fabric.materials[0].young * run.fabric.materials[0].packing(), 0.1, run.fabric.mass[0], ContactRun::kStep);
        const auto energyAt = [&](int corner, int axis, double eps) {
            std::vector<Vec3> x = run.x;
            x[pair.vertices[corner]][axis] += eps;
            return pairEnergy(distanceOf(pair, x), pair.range, stiffness);
        };
        constexpr double kEps = 1.0e-6;  // relative error (ε / depth of the wall)² ≈ 1e-8, and of rounding 1e-16 E / (ε E')
        const double scale = contacts.force[0].norm();
        for (int c = 0; c < 4; ++c)
            for (int k = 0; k < 3; ++k) {
                const double slope = (energyAt(c, k, kEps).energy - energyAt(c, k, -kEps).energy) / (2.0 * kEps);
                EXPECT_NEAR(contacts.weights[0][c] * contacts.force[0][k], slope, 1.0e-6 * scale) << gap;
            }
        const double d = distanceOf(pair, run.x);
        const double curvature =
            (pairEnergy(d + kEps, pair.range, stiffness).slope - pairEnergy(d - kEps, pair.range, stiffness).slope) / (2.0 * kEps);
        EXPECT_NEAR(contacts.stiffness[0], curvature, 1.0e-6 * curvature) << gap;
    }
}

TEST(FabricContact, StiffnessIsOfTheSofterMaterial)
{
    ContactScene scene;
    scene.fabric.materials.push_back(scene.fabric.materials[0]);
    scene.fabric.materials[1].young = 3.0e6;
    scene.addYarn({-0.2, 0.0, 0.0}, {0.2, 0.0, 0.0}, 1, 0.05, 0);
    scene.addYarn({0.0, 0.5, -0.2}, {0.0, 0.5, 0.2}, 1, 0.05, 1);
    ContactRun run(scene.fabric);
    for (int v : {2, 3}) run.x[v].y() = 0.09;  // past the soft beginning
    ASSERT_EQ(run.active().size(), 1u);
    EXPECT_NEAR(run.active().stiffness[0], 0.1 * 3.0e6 * 0.16 * 0.1, 1.0e-9 * 4800);
}

TEST(FabricContact, ForcesOfEachPairSumToZero)
{
    ContactRun run(soup(3, 60, 60));
    for (unsigned i = 0; i < 10; ++i) run.moveSafely(randomMoves(run.fabric, 0.2, i));
    const ActiveContacts& contacts = run.active();
    ASSERT_GT(contacts.size(), 20u);
    for (std::size_t i = 0; i < contacts.size(); ++i) {
        const std::array<double, 4>& c = contacts.weights[i];
        EXPECT_NEAR(c[0] + c[1] + c[2] + c[3], 0.0, 1.0e-15);  // weights are at most 1
        EXPECT_NEAR(contacts.normal[i].norm(), 1.0, 1.0e-14);
        EXPECT_GE(contacts.stiffness[i], 0.0);
        EXPECT_GE(contacts.frictionStiffness[i], 0.0);
    }
}

TEST(FabricContact, FrictionOpposesSlidingAndIsBounded)
{
    for (double slide : {1.0e-5, 5.0e-4, 0.02}) {  // ε = 1e-3 cm
        Pressed run(0.09);
        for (int v : {2, 3}) run.x[v] += Vec3(slide, 0.0, 0.0);
        const ActiveContacts& contacts = run.active();
        ASSERT_EQ(contacts.size(), 1u);
        const Vec3 onSecond = contacts.force[0];  // the gradient of the first side is +force: it is pushed by −force, the second by +
        const double normal = std::abs(onSecond.dot(contacts.normal[0]));
        const double mu = std::tan(run.fabric.materials[0].frictionAngle);
        EXPECT_LT(onSecond.x(), 0.0);
        EXPECT_NEAR(onSecond.z(), 0.0, 1.0e-12 * normal);
        EXPECT_LE(-onSecond.x(), mu * normal * (1.0 + 1.0e-12));
        if (slide > 1.0e-3) {
            EXPECT_NEAR(-onSecond.x(), mu * normal, 1.0e-12 * normal);
        }
    }
}

/// Friction acts across the gap of a pair: its forces at the four vertices have neither a sum nor, by what they turn, a moment. Edges that are
/// all but parallel tell no turn about themselves.
TEST(FabricContact, FrictionHasNoMomentAboutItsPair)
{
    constexpr double kNearlyParallel = 0.9, kMove = 1.0e-4;  // cosine, cm
    std::size_t seen = 0;
    for (unsigned seed = 0; seed < 5; ++seed) {
        ContactRun run(soup(seed, 60, 60));
        for (unsigned i = 0; i < 10; ++i) run.moveSafely(randomMoves(run.fabric, 0.2, i));
        run.contact.beginStep(run.x, run.fabric.mass, ContactRun::kStep, ContactRun::kStep);
        const std::vector<Vec3> moves = randomMoves(run.fabric, kMove, 99 + seed);
        for (std::size_t v = 0; v < run.x.size(); ++v) run.x[v] += moves[v];
        const ActiveContacts& contacts = run.active();
        for (std::size_t i = 0; i < contacts.size(); ++i) {
            const std::array<int, 4>& v = contacts.vertices[i];
            const auto ends = directionsOfPair(contacts.firstSide[i]);
            const auto direction = [&](int d) -> Vec3 { return (run.x[v[ends[d][1]]] - run.x[v[ends[d][0]]]).normalized(); };
            const Vec3 friction = contacts.force[i] - contacts.normal[i].dot(contacts.force[i]) * contacts.normal[i];
            if (friction.isZero(0.0) || std::abs(direction(0).dot(direction(1))) > kNearlyParallel) continue;
            Vec3 sum = Vec3::Zero(), moment = Vec3::Zero(), apart = Vec3::Zero();
            double sizes = 0.0;
            for (int k = 0; k < 4; ++k) {
                const Vec3 force = contacts.slipJacobian(i, k).transpose() * friction;
                sum += force;
                moment += (run.x[v[k]] - run.x[v[0]]).cross(force);
                apart += contacts.weights[i][k] * run.x[v[k]];
                sizes += force.norm();
            }
            EXPECT_LT(sum.norm(), 1.0e-12 * sizes);
            EXPECT_LT(moment.norm(), 0.02 * apart.norm() * sizes) << "moves of a hundredth of the gap and less";
            ++seen;
        }
    }
    EXPECT_GT(seen, 50u);
}

TEST(FabricContact, FrictionIsZeroForCommonMotion)
{
    Pressed run(0.09);
    for (Vec3& x : run.x) x += Vec3(0.02, -0.01, 0.03);
    const ActiveContacts& contacts = run.active();
    ASSERT_EQ(contacts.size(), 1u);
    EXPECT_LT(contacts.force[0].cross(contacts.normal[0]).norm(),
              1.0e-9 * contacts.force[0].norm());  // x + 0.02 is rounded: 1e-17 / ε
}

/// A list with all pairs that could be in it, moved along with the fabric.
struct WatchedList {
    explicit WatchedList(const Fabric& fabric) : all(allPairs(fabric)), list(fabric), x(fabric.rest) {}

    bool holds(const NearPair& p) const
    {
        const CandidatePool& pool = p.kind == PairKind::EdgeEdge ? list.edgePairs() : list.facePairs();
        for (std::size_t i = 0; i < pool.size(); ++i)
            if (pool.a[i] == p.a && pool.b[i] == p.b) return true;
        return false;
    }
    /// Covers the moves u, looks whether pairs are there that they bring near, and makes them.
    /// @return whether the list had to be built
    bool move(std::span<const Vec3> u)
    {
        const bool isBuilt = list.coverMoves(x, u);
        for (const NearPair& p : all) {
            const auto at = [&](std::span<const Vec3> w) {
                return std::array<Vec3, 4>{w[p.vertices[0]], w[p.vertices[1]], w[p.vertices[2]], w[p.vertices[3]]};
            };
            const double floor = p.range.core + 0.15 * (p.range.reach - p.range.core);
            if (!mayApproach(p.kind, at(x), at(u), distanceOf(p, x), floor)) continue;
            ++mattered;
            EXPECT_TRUE(holds(p));
        }
        for (std::size_t v = 0; v < u.size(); ++v) x[v] += u[v];
        list.moved();
        return isBuilt;
    }
    /// Looks whether pairs are there that act.
    void stay()
    {
        list.coverPositions(x);
        for (const NearPair& p : all)
            if (distanceOf(p, x) < p.range.reach) {
                EXPECT_TRUE(holds(p));
            }
    }

    std::vector<NearPair> all;
    CandidateList list;
    std::vector<Vec3> x;
    std::size_t mattered = 0;
};

/// Pairs that act, and pairs that a move brings near, at any past of the list.
TEST(CandidateList, HoldsAllPairsThatMatterAfterManyMotions)
{
    const Fabric fabric = soup(5, 50, 40);
    WatchedList watched(fabric);
    for (unsigned step = 0; step < 60; ++step) {
        SCOPED_TRACE(step);
        // Moves of all sizes, some of few vertices only, so that the list is kept, mended and built anew.
        std::vector<Vec3> u = randomMoves(fabric, std::array{0.002, 0.01, 0.05, 0.3}[step % 4], step);
        for (std::size_t v = 0; v < u.size(); ++v)
            if (step % 3 != 0 && v % 5 != step % 5) u[v] *= 0.02;
        watched.move(u);
        watched.stay();
    }
    EXPECT_GT(watched.mattered, 1000u);
}

/// Vertices that go on as they did need no search in every step; some that are knocked off their way, or stop, do.
TEST(CandidateList, LooksAheadAlongTheStepsToCome)
{
    const Fabric fabric = soup(5, 50, 40);
    WatchedList watched(fabric);
    std::vector<Vec3> u = randomMoves(fabric, 0.004, 0);
    int kept = 0;
    for (unsigned step = 0; step < 120; ++step) {
        SCOPED_TRACE(step);
        if (step % 20 == 10) u = randomMoves(fabric, 0.004, step);
        if (step % 10 == 3)
            for (std::size_t v = step % 5; v < u.size(); v += 5) u[v] *= -0.5;
        watched.list.beginStep();
        kept += watched.move(u) ? 0 : 1;
        watched.stay();
        std::vector<Vec3> correction = randomMoves(fabric, 0.0001, step);
        if (step >= 60 && step % 8 == 1)
            for (std::size_t v = step % 6; v < u.size(); v += 6) correction[v] *= 100.0;
        watched.move(correction);
        watched.stay();
    }
    EXPECT_GT(watched.mattered, 1000u);
    EXPECT_GT(kept, 40);
}

/// A yarn that would pass another by is knocked before it, and goes on.
TEST(CandidateList, WhoIsKnockedOffItsWayIsSoughtAlongItsNewOne)
{
    constexpr double kRadius = 0.05;
    ContactScene scene;
    scene.addYarn({0, 0, 0}, {0, 0, 0.4}, 1, kRadius);
    scene.addYarn({4.4 * kRadius, -0.2, 0.2}, {4.4 * kRadius, 0.2, 0.2}, 1, kRadius);
    scene.fabric.rest[0].y() += 20.0 * kRadius, scene.fabric.rest[1].y() += 20.0 * kRadius;
    WatchedList watched(scene.fabric);
    std::vector<Vec3> go(4, Vec3::Zero()), knock = go;
    for (int v : {0, 1}) go[v].x() = 0.6 * kRadius, knock[v].y() = -20.0 * kRadius;
    for (int step = 0; step < 7; ++step) {
        SCOPED_TRACE(step);
        watched.list.beginStep();
        watched.move(go);
        if (step == 0) watched.move(knock);
    }
    EXPECT_GT(watched.mattered, 0u);
}

TEST(CandidateList, HoldsNoPairTwice)
{
    const Fabric fabric = soup(6, 40, 40);
    CandidateList list(fabric);
    std::vector<Vec3> x = fabric.rest;
    for (unsigned step = 0; step < 30; ++step) {
        std::vector<Vec3> u = randomMoves(fabric, 0.1, step);
        for (std::size_t v = 0; v < u.size(); ++v)
            if (v % 3 != step % 3) u[v].setZero();
        list.coverMoves(x, u);
        for (const CandidatePool* pool : {&list.edgePairs(), &list.facePairs()}) {
            std::set<std::pair<int, int>> seen;
            for (std::size_t i = 0; i < pool->size(); ++i) EXPECT_TRUE(seen.insert({pool->a[i], pool->b[i]}).second);
        }
        for (std::size_t v = 0; v < u.size(); ++v) x[v] += u[v];
        list.moved();
    }
}

/// Cloth whose every piece is near every other would fill the memory with pairs: it says so instead.
TEST(CandidateList, GivesUpOnFabricThatHasBurst)
{
    ContactScene scene;
    scene.addCloth({0, 0, 0}, {0.1, 0, 0}, {0, 0, 0.1}, 40, 40, 0.02);
    CandidateList list(scene.fabric);
    std::vector<Vec3> burst = scene.fabric.rest;
    for (Vec3& x : burst) x *= 1.0e-3;
    EXPECT_THROW(list.coverPositions(burst), RunError);
}

TEST(CandidateList, MeasuresAtX)
{
    const Fabric fabric = soup(7, 40, 40);
    CandidateList list(fabric);
    std::vector<Vec3> x = fabric.rest;
    for (unsigned step = 0; step < 30; ++step) {
        std::vector<Vec3> u = randomMoves(fabric, step % 2 == 0 ? 0.1 : 0.02, step);
        list.coverMoves(x, u);
        list.measure(x);
        for (Vec3& v : u) v *= 1.3;
        list.coverMoves(x, u);
        list.measure(x);
        for (const CandidatePool* pool : {&list.edgePairs(), &list.facePairs()})
            for (std::size_t i = 0; i < pool->size(); ++i)  // packs contract products as they like
                EXPECT_NEAR(pool->distance[i], distanceOf({0, 0, pool->kind, pool->vertices[i], {}}, x), 1.0e-12);
        for (std::size_t v = 0; v < u.size(); ++v) x[v] += u[v];
        list.moved();
    }
}

}  // namespace
}  // namespace sim::test
