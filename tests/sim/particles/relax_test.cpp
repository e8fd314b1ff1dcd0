#include "sim/particles/relax.h"

#include "tests/sim/fixtures.h"

#include <gtest/gtest.h>

namespace sim::test {
namespace {

constexpr double kDx = 0.288, kReach = 0.8 * kDx, kRate = 125.0, kDt = 1.0e-3;

using Displacements = std::array<AlignedArray<double>, kAxes>;

SortedLiquid liquidAt(const std::vector<Vec3>& positions)
{
    SortedLiquid liquid;
    liquid.grid.dx = kDx;
    liquid.grid.origin = Vec3(0.1, -0.2, 0.3);
    for (std::size_t p = 0; p < positions.size(); ++p) liquid.particles.add(positions[p], 1.0, static_cast<std::uint32_t>(p), Vec3::Zero());
    liquid.sort();
    return liquid;
}

/// By the id of each particle.
std::vector<Vec3> displacementsOf(const SortedLiquid& liquid, double reach = kReach, double rate = kRate)
{
    RelaxScratch scratch;
    Displacements displacement;
    relaxationDisplacements({liquid.particles, liquid.order, liquid.grid}, rate, reach, kDt, scratch, displacement);
    std::vector<Vec3> byId(liquid.particles.count);
    for (std::size_t s = 0; s < byId.size(); ++s) byId[liquid.particles.id[s]] = {displacement[0][s], displacement[1][s], displacement[2][s]};
    return byId;
}

/// The law itself (particles/README.md, Relaxation).
Vec3 pushBetween(const Vec3& to, const Vec3& from)
{
    const Vec3 away = to - from;
    const double q = away.squaredNorm() / (kReach * kReach), rest = std::max(0.0, 1.0 - q);
    return std::min(1.0, kRate * kDt) * rest * rest * rest * kReach * away.normalized();
}

TEST(Relaxation, PairIsPushedApartEquallyAlongItsLine)
{
    std::mt19937 random(1);
    std::uniform_real_distribution<double> unit(-1.0, 1.0);
    for (int n = 0; n < 300; ++n) {
        const Vec3 a = 2.5 * Vec3(unit(random), unit(random), unit(random));
        const Vec3 b = a + kReach * 0.6 * Vec3(unit(random), unit(random), unit(random));
        const std::vector<Vec3> d = displacementsOf(liquidAt({a, b}));
        EXPECT_LT((d[0] + d[1]).norm(), 2.0e-5 * kReach);
        EXPECT_LT((d[0] - pushBetween(a, b)).norm(), 2.0e-5 * kReach);
    }
}

TEST(Relaxation, NothingMovesBeyondTheReach)
{
    std::mt19937 random(2);
    std::uniform_real_distribution<double> unit(-1.0, 1.0);
    for (int n = 0; n < 300; ++n) {
        const Vec3 a = 2.5 * Vec3(unit(random), unit(random), unit(random)), way = Vec3(unit(random), unit(random), unit(random)).normalized();
        const std::vector<Vec3> d = displacementsOf(liquidAt({a, a + 1.0001 * kReach * way}));
        EXPECT_EQ(d[0].norm() + d[1].norm(), 0.0);
    }
}

TEST(Relaxation, LatticeRests)
{
    // Pitch 0.4 cells, reach 2 × 0.5103 of it: the neighbours hardly touch, and inside of the lattice they cancel.
    const double pitch = 0.4 * kDx;
    std::vector<Vec3> positions;
    for (int i = 0; i < 12; ++i)
        for (int j = 0; j < 12; ++j)
            for (int k = 0; k < 12; ++k) positions.emplace_back(pitch * Vec3(i, j, k));
    for (const Vec3& d : displacementsOf(liquidAt(positions), 2.0 * 0.5103 * pitch)) EXPECT_LT(d.norm(), 1.0e-3 * pitch);
}

TEST(Relaxation, IsTheSumOverAllPairs)
{
    const SortedLiquid liquid = randomLiquid(3000, 1, {9, 10, 8}, {-4, -5, -3}, kDx);
    const std::vector<Vec3> d = displacementsOf(liquid);
    for (std::size_t p = 0; p < liquid.particles.count; ++p) {
        Vec3 expected = Vec3::Zero();
        for (std::size_t q = 0; q < liquid.particles.count; ++q)
            if (q != p) expected += pushBetween(liquid.particles.position(p), liquid.particles.position(q));
        ASSERT_LT((d[liquid.particles.id[p]] - expected).norm(), 2.0e-5 * kReach);
    }
}

TEST(Relaxation, ParticlesAtTheSamePlaceLeaveInOppositeDirections)
{
    const Vec3 x(0.4, 0.5, -0.6);
    for (const double offset : {0.0, 1.0e-12, 1.0e-9}) {
        const std::vector<Vec3> d = displacementsOf(liquidAt({x, x + Vec3(offset, 0.0, 0.0)}));
        EXPECT_NEAR(d[0].norm(), kRate * kDt * kReach, 1.0e-4 * kReach) << offset;
        EXPECT_LT((d[0] + d[1]).norm(), 1.0e-5 * kReach) << offset;
    }
}

TEST(Relaxation, StepMovesNoFartherThanTheLimitOfTheRate)
{
    const SortedLiquid liquid = randomLiquid(500, 1, {6, 6, 6}, {0, 0, 0}, kDx);
    const std::vector<Vec3> once = displacementsOf(liquid, kReach, 1.0 / kDt), more = displacementsOf(liquid, kReach, 50.0 / kDt);
    for (std::size_t p = 0; p < once.size(); ++p) EXPECT_EQ(once[p], more[p]);
}

TEST(Relaxation, SameBitsForAnyThreadCount)
{
    const SortedLiquid liquid = randomLiquid(20000, 1, {30, 20, 20}, {-9, -3, 2}, kDx);
    const std::vector<Vec3> one = onThreads(1, [&] { return displacementsOf(liquid); });
    for (int threads : {2, 8}) EXPECT_EQ(one, onThreads(threads, [&] { return displacementsOf(liquid); })) << threads;
}

}  // namespace
}  // namespace sim::test
