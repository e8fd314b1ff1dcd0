#include "tests/sim/fabric/contact/contact_scenes.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <Eigen/LU>

namespace sim::test {
namespace {

using namespace contact;

Vec3 momentum(const Fabric& fabric, std::span<const Vec3> u)
{
    Vec3 p = Vec3::Zero();
    for (std::size_t v = 0; v < u.size(); ++v) p += fabric.mass[v] * u[v];
    return p;
}

/// Share of the wanted moves that was taken, by mass.
double taken(const Fabric& fabric, std::span<const Vec3> want, std::span<const Vec3> got)
{
    double sum = 0.0, of = 0.0;
    for (std::size_t v = 0; v < want.size(); ++v) {
        sum += fabric.mass[v] * want[v].dot(got[v]);
        of += fabric.mass[v] * want[v].squaredNorm();
    }
    return sum / of;
}

/// Does the edge p-q pass through the triangle a-b-c? By signs of volumes: nothing of the distances of sim/ is in it.
bool pierces(const Vec3& p, const Vec3& q, const Vec3& a, const Vec3& b, const Vec3& c)
{
    const auto volume = [](const Vec3& k, const Vec3& l, const Vec3& m, const Vec3& n) { return (l - k).cross(m - k).dot(n - k); };
    if ((volume(a, b, c, p) > 0.0) == (volume(a, b, c, q) > 0.0)) return false;
    const bool side = volume(p, q, a, b) > 0.0;
    return (volume(p, q, b, c) > 0.0) == side && (volume(p, q, c, a) > 0.0) == side;
}

bool isPierced(const Fabric& fabric, std::span<const Vec3> x)
{
    const Primitives primitives(fabric);
    for (const std::array<int, 2>& e : primitives.edges)
        for (const std::array<int, 3>& f : primitives.faces) {
            if (std::ranges::any_of(e, [&](int v) { return std::ranges::find(f, v) != f.end(); })) continue;
            if (pierces(x[e[0]], x[e[1]], x[f[0]], x[f[1]], x[f[2]])) return true;
        }
    return false;
}

/// Follows a move in steps much shorter than the thickness, pair by pair, all pairs.
void expectSafe(std::span<const NearPair> pairs, std::span<const Vec3> x, std::span<const Vec3> u)
{
    constexpr int kSamples = 40;
    std::vector<double> bound;
    for (const NearPair& p : pairs) bound.push_back(std::min(p.range.core, 0.97 * distanceOf(p, x)));
    std::vector<Vec3> y(x.begin(), x.end());
    for (int k = 1; k <= kSamples; ++k) {
        for (std::size_t v = 0; v < y.size(); ++v) y[v] = x[v] + u[v] * (static_cast<double>(k) / kSamples);
        for (std::size_t i = 0; i < pairs.size(); ++i)
            ASSERT_GE(distanceOf(pairs[i], y), bound[i] * (1.0 - 1.0e-9)) << k;  // rounding of coordinates of 1
    }
}

TEST(ContactLimit, SoupsNeverCross)
{
    int shortened = 0, reached = 0;
    for (unsigned seed = 1; seed <= 4; ++seed) {
        const Fabric fabric = soup(seed, seed % 2 == 0 ? 60 : 30, seed % 2 == 0 ? 0 : 30);
        const std::vector<NearPair> pairs = allPairs(fabric);
        const bool piercedAtRest = isPierced(fabric, fabric.rest);
        ContactRun run(fabric);
        for (unsigned step = 0; step < 12; ++step) {
            const std::vector<Vec3> x = run.x, want = randomMoves(fabric, step % 3 == 0 ? 1.0 : 0.2, 100 * seed + step);
            const std::vector<Vec3> got = run.moveSafely(want);
            expectSafe(pairs, x, got);
            EXPECT_TRUE(piercedAtRest || !isPierced(fabric, run.x)) << seed << " " << step;
            shortened += got != want;
            for (const NearPair& p : pairs) reached += distanceOf(p, run.x) < p.range.reach;
        }
        EXPECT_GT(taken(fabric, randomMoves(fabric, 0.02, 1), run.moveSafely(randomMoves(fabric, 0.02, 1))), 0.2);
    }
    EXPECT_GT(shortened, 40);
    EXPECT_GT(reached, 100);
}

TEST(ContactLimit, ClothThrownOntoYarnsAndItselfIsNeverPierced)
{
    ContactScene scene;
    for (int i = 0; i < 4; ++i) scene.addYarn({0.0, 0.0, 0.2 * i}, {0.6, 0.0, 0.2 * i}, 5, 0.03);
    scene.addCloth({0, 0.1, 0}, {0.1, 0, 0}, {0, 0, 0.1}, 6, 6, 0.03);
    scene.addCloth({0, 0.2, 0}, {0.1, 0, 0}, {0, 0, 0.1}, 6, 6, 0.03);
    const std::vector<NearPair> pairs = allPairs(scene.fabric);
    ContactRun run(scene.fabric);
    for (unsigned step = 0; step < 6; ++step) {
        const std::vector<Vec3> x = run.x;
        std::vector<Vec3> u = randomMoves(scene.fabric, 0.02, step);
        for (std::size_t v = 0; v < u.size(); ++v) u[v].y() -= 0.3 * x[v].y();
        const std::vector<Vec3> got = run.moveSafely(u);
        expectSafe(pairs, x, got);
        EXPECT_FALSE(isPierced(scene.fabric, run.x));
    }
    EXPECT_LT(momentum(scene.fabric, run.x).y(), momentum(scene.fabric, scene.fabric.rest).y());
}

TEST(ContactLimit, CommonTranslationIsNeverShortened)
{
    ContactRun run(wovenSheet(30));
    for (int step = 0; step < 5; ++step) {
        const std::vector<Vec3> u(run.x.size(), Vec3(0.3, -0.2, 0.1));  // 374 cm/s at 1e-3 s
        EXPECT_EQ(run.moveSafely(u), u);
    }
    EXPECT_EQ(run.report.blends + run.report.globalScalings, 0);
}

TEST(ContactLimit, RotationIsHardlyShortened)
{
    ContactRun run(wovenSheet(30));
    const Mat3 turn = Eigen::AngleAxisd(0.05, Vec3(1, 2, 3).normalized()).toRotationMatrix();  // 50 rad/s at 1e-3 s
    for (int step = 0; step < 10; ++step) {
        std::vector<Vec3> u;
        for (const Vec3& x : run.x) u.push_back(turn * x - x);
        const std::vector<Vec3> got = run.moveSafely(u);
        EXPECT_GT(taken(run.fabric, u, got), 1.0 - 1.0e-6);  // chords are shorter than arcs by 0.05² / 8 of the yarns' distance
    }
    EXPECT_EQ(run.report.globalScalings, 0);
}

TEST(ContactLimit, KeepsTheMomentumOfFreeVertices)
{
    const Fabric fabric = soup(11, 60, 40);
    ContactRun run(fabric);
    int blends = 0;
    for (unsigned step = 0; step < 20; ++step) {
        const std::vector<Vec3> want = randomMoves(fabric, 0.08, step);
        const int globalScalings = run.report.globalScalings;
        const std::vector<Vec3> got = run.moveSafely(want);
        if (run.report.globalScalings > globalScalings) continue;  // that shortens all of it
        double size = 0.0;
        for (std::size_t v = 0; v < want.size(); ++v) size += fabric.mass[v] * want[v].norm();
        EXPECT_LT((momentum(fabric, got) - momentum(fabric, want)).norm(), 1.0e-12 * size);
        blends = run.report.blends;
    }
    EXPECT_GT(blends, 0);
}

TEST(ContactLimit, HeldVerticesKeepTheirMoves)
{
    ContactScene scene;
    scene.fabric = soup(12, 60, 40);
    for (int v = 0; v < static_cast<int>(scene.fabric.vertexCount()); v += 7) scene.pin(v);
    ContactRun run(scene.fabric);
    int kept = 0;
    for (unsigned step = 0; step < 20; ++step) {
        const std::vector<Vec3> want = randomMoves(scene.fabric, 0.05, step);
        const int globalScalings = run.report.globalScalings;
        const std::vector<Vec3> got = run.moveSafely(want);
        if (run.report.globalScalings > globalScalings) continue;
        ++kept;
        for (std::size_t v = 0; v < want.size(); v += 7) EXPECT_EQ(got[v], want[v]);
    }
    EXPECT_GT(kept, 10);
}

TEST(ContactLimit, FastHeadOnCollisionIsNotTunnelled)
{
    ContactScene scene;
    scene.addYarn({-0.2, 0.0, 0.0}, {0.2, 0.0, 0.0}, 1, 0.05);
    scene.addYarn({0.0, 2.0, -0.2}, {0.0, 2.0, 0.2}, 1, 0.05);
    ContactRun run(scene.fabric);
    const std::vector<Vec3> got = run.moveSafely({Vec3(0, 3, 0), Vec3(0, 3, 0), Vec3(0, -3, 0), Vec3(0, -3, 0)});
    EXPECT_GE(run.x[2].y() - run.x[0].y(), 0.057);       // core: 0.57 · 0.1
    EXPECT_LE(run.x[2].y() - run.x[0].y(), 0.1125);      // and no further off than where they touch
    EXPECT_NEAR(got[0].y() + got[2].y(), 0.0, 1.0e-14);  // like masses, opposite moves
    EXPECT_EQ(run.report.globalScalings, 0);
}

TEST(ContactLimit, PairsUnderTheCoreMaySeparate)
{
    ContactScene scene;
    scene.addYarn({-0.2, 0.0, 0.0}, {0.2, 0.0, 0.0}, 1, 0.05);
    scene.addYarn({0.0, 0.5, -0.2}, {0.0, 0.5, 0.2}, 1, 0.05);
    ContactRun run(scene.fabric);
    for (int v : {2, 3}) run.x[v].y() = 0.03;
    const std::vector<Vec3> apart = {Vec3(0, -0.1, 0), Vec3(0, -0.1, 0), Vec3(0, 0.1, 0), Vec3(0, 0.1, 0)};
    EXPECT_EQ(run.moveSafely(apart), apart);
}

/// Steps that move the same sheet about, some of them tried and taken back.
std::vector<Vec3> stirred(ContactRun& run, unsigned from, unsigned to)
{
    for (unsigned step = from; step < to; ++step) {
        run.contact.beginStep(run.x, run.fabric.mass, ContactRun::kStep, ContactRun::kStep);
        // Wild in one place, which wanders, hardly at all elsewhere: the list is mended, not built anew.
        std::vector<Vec3> u = randomMoves(run.fabric, 1.0, step);
        const Vec3 middle(0.5 + 0.1 * step, 0.0, 1.0);
        for (std::size_t v = 0; v < u.size(); ++v) {
            const double share = std::exp(-(run.fabric.rest[v] - middle).squaredNorm() / 0.2);
            u[v] = (0.001 + 0.1 * share) * u[v] - Vec3(0.0, 0.2 * share, 0.0);
        }
        run.moveSafely(u);
        const ActiveContacts& contacts = run.active();
        std::vector<Vec3> push(u.size(), Vec3::Zero());
        for (std::size_t i = 0; i < contacts.size(); ++i)
            for (int a = 0; a < 4; ++a) push[contacts.vertices[i][a]] -= 0.1 * contacts.weights[i][a] / contacts.stiffness[i] * contacts.force[i];
        run.moveSafely(push);
    }
    return run.x;
}

TEST(ContactLimit, ResumedRunHasTheSameBits)
{
    for (const Fabric& fabric : {wovenSheet(24), soup(13, 80, 60)}) {
        ContactRun whole(fabric), resumed(fabric);
        resumed.x = stirred(whole, 0, 8);
        EXPECT_EQ(stirred(resumed, 8, 14), stirred(whole, 8, 14));
    }
}

TEST(ContactLimit, StepTakenBackLeavesNoTrace)
{
    const Fabric fabric = wovenSheet(24);
    ContactRun straight(fabric), back(fabric);
    stirred(straight, 0, 4);
    const std::vector<Vec3> start = stirred(back, 0, 4);
    stirred(back, 20, 21);
    back.x = start;
    EXPECT_EQ(stirred(back, 4, 8), stirred(straight, 4, 8));
}

}  // namespace
}  // namespace sim::test
