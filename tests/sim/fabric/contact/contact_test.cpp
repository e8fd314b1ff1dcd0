#include "sim/fabric/contact/candidate_list.h"
#include "sim/fabric/contact/pair_energy.h"
#include "tests/sim/fabric/contact/contact_scenes.h"

#include <gtest/gtest.h>

#include <limits>

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
            const std::array<Vec3, 4> forces = contacts.forcesOnVertices(i, friction);
            for (int k = 0; k < 4; ++k) {
                const Vec3& force = forces[k];
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

}  // namespace
}  // namespace sim::test
