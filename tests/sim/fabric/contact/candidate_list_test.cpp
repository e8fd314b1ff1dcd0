#include "sim/fabric/contact/candidate_list.h"
#include "sim/core/check.h"
#include "tests/sim/fabric/contact/contact_scenes.h"

#include <gtest/gtest.h>

#include <set>

namespace sim::test {
namespace {

using namespace contact;

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
        const CoveredMoves covered = list.coverMoves(x, u);
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
        list.moved(covered);
        return covered.wereSearched();
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
TEST(CandidateList, RefreshesPairsAfterDeflection)
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
        const CoveredMoves covered = list.coverMoves(x, u);
        for (const CandidatePool* pool : {&list.edgePairs(), &list.facePairs()}) {
            std::set<std::pair<int, int>> seen;
            for (std::size_t i = 0; i < pool->size(); ++i) EXPECT_TRUE(seen.insert({pool->a[i], pool->b[i]}).second);
        }
        for (std::size_t v = 0; v < u.size(); ++v) x[v] += u[v];
        list.moved(covered);
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
        const CoveredMoves covered = list.coverMoves(x, u);
        list.measure(x);
        for (const CandidatePool* pool : {&list.edgePairs(), &list.facePairs()})
            for (std::size_t i = 0; i < pool->size(); ++i)  // packs contract products as they like
                EXPECT_NEAR(pool->distance[i], distanceOf({0, 0, pool->kind, pool->vertices[i], {}}, x), 1.0e-12);
        for (std::size_t v = 0; v < u.size(); ++v) x[v] += u[v];
        list.moved(covered);
    }
}

}  // namespace
}  // namespace sim::test
