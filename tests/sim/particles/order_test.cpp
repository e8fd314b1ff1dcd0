#include "sim/core/check.h"
#include "tests/sim/fixtures.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <numeric>
#include <set>

using namespace sim;
using namespace sim::test;

namespace {

/// Global coordinates of the cell a place is in.
Vec3i cellAt(const BlockGrid& grid, const Vec3& x) { return ((x - grid.origin) * (1.0 / grid.dx)).array().floor().cast<int>(); }

Vec3i blockOfCell(const Vec3i& cell) { return {cell.x() >> 3, cell.y() >> 3, cell.z() >> 3}; }

/// Particles at random places whose modes tell their id, not sorted.
SortedLiquid unsortedLiquid(std::size_t count, const std::vector<Vec3>& corners, double edge, unsigned seed = 5)
{
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> unit(0.0, 1.0);
    SortedLiquid liquid;
    liquid.grid.dx = 0.25;
    liquid.grid.origin = Vec3(0.1, -0.2, 0.3);
    liquid.particles.modeCount = 4;
    for (std::uint32_t p = 0; p < count; ++p) {
        const Vec3 x = corners[p % corners.size()] + edge * Vec3(unit(random), unit(random), unit(random));
        liquid.particles.add(x, 1.0 + p, p, Vec3(p, 2.0 * p, -1.0 * p));
    }
    return liquid;
}

/// The same particles in another order of the arrays.
void shuffle(LiquidParticles& particles, unsigned seed)
{
    LiquidParticles old = particles;
    std::vector<std::size_t> to(particles.count);
    std::iota(to.begin(), to.end(), std::size_t{0});
    std::shuffle(to.begin(), to.end(), std::mt19937(seed));
    old.resize(particles.count + 1);
    for (std::size_t p = 0; p < particles.count; ++p) {
        particles.mass[to[p]] = old.mass[p];
        particles.id[to[p]] = old.id[p];
        for (int a = 0; a < kAxes; ++a) {
            particles.x[a][to[p]] = old.x[a][p];
            for (int r = 0; r < particles.modeCount; ++r) particles.mode(a, r)[to[p]] = old.mode(a, r)[p];
        }
    }
}

std::set<std::array<int, 3>> blockSet(const BlockGrid& grid)
{
    std::set<std::array<int, 3>> blocks;
    for (const Vec3i& c : grid.coords()) blocks.insert({c.x(), c.y(), c.z()});
    return blocks;
}

/// Ids of the particles of each cell.
std::vector<std::set<std::uint32_t>> idsByCell(const SortedLiquid& liquid)
{
    std::vector<std::set<std::uint32_t>> ids;
    for (int b = 0; b < liquid.grid.count(); ++b)
        for (int c = 0; c < kBlockCells; ++c) {
            const int* run = liquid.order.cells(b) + c;
            ids.emplace_back(liquid.particles.id.data() + run[0], liquid.particles.id.data() + run[1]);
        }
    return ids;
}

const std::vector<Vec3> kTwoCorners = {{-3.0, 0.0, 1.0}, {1.0, -2.0, -1.0}};

}  // namespace

TEST(ParticleOrder, EveryParticleIsInTheRunOfItsCell)
{
    SortedLiquid liquid = unsortedLiquid(5000, kTwoCorners, 2.3);
    liquid.sort();
    std::size_t seen = 0;
    for (int b = 0; b < liquid.grid.count(); ++b)
        for (int i = 0; i < kBlockEdge; ++i)
            for (int j = 0; j < kBlockEdge; ++j)
                for (int k = 0; k < kBlockEdge; ++k) {
                    const int* run = liquid.order.cells(b) + cellRank(i, j, k);
                    for (int s = run[0]; s < run[1]; ++s, ++seen)
                        EXPECT_EQ(cellAt(liquid.grid, liquid.particles.position(s)), 8 * liquid.grid.coords(b) + Vec3i(i, j, k));
                }
    EXPECT_EQ(seen, 5000);
    EXPECT_EQ(liquid.particles.count, 5000);
}

TEST(ParticleOrder, MassAndIdTravelWithThePlaceAndSourceTellsWhereTheModesAre)
{
    SortedLiquid liquid = unsortedLiquid(5000, kTwoCorners, 2.3);
    const LiquidParticles before = liquid.particles;
    liquid.sort();
    const LiquidParticles& p = liquid.particles;
    std::vector<int> source(liquid.order.source.begin(), liquid.order.source.begin() + static_cast<std::ptrdiff_t>(p.count));
    for (std::size_t s = 0; s < p.count; ++s) {
        const std::uint32_t id = p.id[s];
        EXPECT_EQ(p.position(s), before.position(id));
        EXPECT_EQ(p.mass[s], 1.0 + id);
        EXPECT_EQ(p.velocity(source[s]), Vec3(id, 2.0 * id, -1.0 * id));
    }
    std::sort(source.begin(), source.end());
    for (std::size_t s = 0; s < p.count; ++s) EXPECT_EQ(source[s], static_cast<int>(s));
}

TEST(ParticleOrder, BlocksInReachOfParticlesExistAndNoOthers)
{
    SortedLiquid liquid = unsortedLiquid(60, kTwoCorners, 3.0);
    liquid.sort();
    std::set<std::array<int, 3>> inReach;
    for (std::size_t s = 0; s < liquid.particles.count; ++s) {
        const Vec3i cell = cellAt(liquid.grid, liquid.particles.position(s));
        for (int n = 0; n < 64; ++n) {
            const Vec3i at = cell + Vec3i(n % 4 - 1, n / 4 % 4 - 1, n / 16 - 1);  // 1 below, 2 above
            const Vec3i block = blockOfCell(at);
            EXPECT_NE(liquid.grid.find(block), BlockGrid::kNone) << at.transpose();
            inReach.insert({block.x(), block.y(), block.z()});
        }
    }
    // One touched block may add a neighbour that only a mix of its particles' planes asks for.
    const auto all = blockSet(liquid.grid);
    for (const auto& block : inReach) EXPECT_TRUE(all.count(block));
    for (const auto& block : all) {
        int touched = 0;
        for (std::size_t s = 0; s < liquid.particles.count; ++s) {
            const Vec3i at = blockOfCell(cellAt(liquid.grid, liquid.particles.position(s)));
            if ((at - Vec3i(block[0], block[1], block[2])).cwiseAbs().maxCoeff() <= 1) ++touched;
        }
        EXPECT_GT(touched, 0);
    }
}

TEST(ParticleOrder, OneParticleNeedsExactlyTheBlocksInItsReach)
{
    for (int corner : {0, 1, 3, 5, 6, 7}) {
        SortedLiquid liquid = unsortedLiquid(0, {Vec3::Zero()}, 1.0);
        liquid.particles.add(liquid.grid.origin + liquid.grid.dx * Vec3(corner + 0.5, 3.5, 3.5), 1.0, 0, Vec3::Zero());
        liquid.sort();
        EXPECT_EQ(liquid.grid.count(), corner < 1 || corner > 5 ? 2 : 1) << "cell " << corner;
    }
}

TEST(ParticleOrder, BlocksThatAreNoLongerNeededGo)
{
    SortedLiquid liquid = unsortedLiquid(500, kTwoCorners, 2.3);
    liquid.sort();
    liquid.moveModesHome();
    for (std::size_t s = 0; s < liquid.particles.count; ++s) liquid.particles.x[0][s] += 100.0;
    const std::vector<Vec3i> old = liquid.grid.coords();
    liquid.sort();
    EXPECT_TRUE(liquid.order.blocksChanged);
    for (int b = 0; b < liquid.grid.count(); ++b) {
        EXPECT_GT(liquid.grid.coords(b).x(), 20);
        EXPECT_EQ(liquid.order.previous[b], BlockGrid::kNone);
    }
    liquid.moveModesHome();
    const int count = liquid.grid.count();
    liquid.sort();
    EXPECT_FALSE(liquid.order.blocksChanged);
    for (int b = 0; b < count; ++b) EXPECT_EQ(liquid.order.previous[b], b);
}

TEST(ParticleOrder, BlocksOfDeletedParticlesGo)
{
    SortedLiquid liquid = unsortedLiquid(500, {{0.0, 0.0, 0.0}, {50.0, 0.0, 0.0}}, 1.0);
    liquid.sort();
    liquid.moveModesHome();
    const Shape domain = Shape::ball(Vec3::Zero(), 20.0);
    sortParticles(liquid.particles, liquid.grid, &domain, liquid.order, &liquid.ledger);
    EXPECT_TRUE(liquid.order.blocksChanged);
    EXPECT_GT(liquid.grid.count(), 0);
    for (const Vec3i& c : liquid.grid.coords()) EXPECT_LT(c.x(), 12);
}

// A sparse grid: what lies between two drops costs nothing.
TEST(ParticleOrder, TwoDropsFarApartNeedNoMoreBlocksThanTwoSideBySide)
{
    const double edge = 1.9, block = 8 * 0.25, far = 500.0 * block;  // 10 m apart, a whole number of blocks
    SortedLiquid apart = unsortedLiquid(4000, {{0.0, 0.0, 0.0}, {far, 0.0, 0.0}}, edge);
    SortedLiquid alone = unsortedLiquid(2000, {{0.0, 0.0, 0.0}}, edge);
    apart.sort();
    alone.sort();
    EXPECT_EQ(apart.grid.count(), 2 * alone.grid.count());
    // Not aligned to blocks: a drop spans one block more along each axis at most.
    SortedLiquid shifted = unsortedLiquid(4000, {{0.0, 0.0, 0.0}, {far + 0.9, 0.7, 0.4}}, edge);
    shifted.sort();
    EXPECT_LE(shifted.grid.count(), alone.grid.count() + 4 * 4 * 4);
}

TEST(ParticleOrder, DoesNotDependOnTheOrderBefore)
{
    SortedLiquid first = unsortedLiquid(5000, kTwoCorners, 2.3), second = unsortedLiquid(5000, kTwoCorners, 2.3);
    shuffle(second.particles, 3);
    first.sort();
    second.sort();
    EXPECT_EQ(first.grid.coords(), second.grid.coords());
    EXPECT_EQ(idsByCell(first), idsByCell(second));
    EXPECT_EQ(first.order.occupied, second.order.occupied);
    EXPECT_EQ(first.order.byColor, second.order.byColor);
    EXPECT_EQ(first.order.maxParticlesPerBlock, second.order.maxParticlesPerBlock);
}

TEST(ParticleOrder, SameForAnyThreadCount)
{
    const auto sorted = [](int threads) {
        return onThreads(threads, [] {
            SortedLiquid liquid = unsortedLiquid(20000, kTwoCorners, 2.3);
            liquid.sort();
            return std::vector<int>(liquid.order.source.begin(), liquid.order.source.begin() + 20000);
        });
    };
    const auto one = sorted(1);
    for (int threads : {2, 8}) EXPECT_EQ(sorted(threads), one);
}

TEST(ParticleOrder, DeletionIsInTheLedger)
{
    SortedLiquid liquid = unsortedLiquid(3000, kTwoCorners, 2.3);
    const Shape domain = Shape::box({-2.0, 0.5, 2.0}, {2.0, 2.0, 1.0});
    double mass = 0.0;
    Vec3 momentum = Vec3::Zero();
    std::set<std::uint32_t> inside;
    for (std::size_t p = 0; p < 3000; ++p) {
        if (domain.distance(liquid.particles.position(p)) <= 0.0) {
            inside.insert(liquid.particles.id[p]);
            continue;
        }
        mass += liquid.particles.mass[p];
        momentum += liquid.particles.mass[p] * liquid.particles.velocity(p);
    }
    sortParticles(liquid.particles, liquid.grid, &domain, liquid.order, &liquid.ledger);
    EXPECT_EQ(std::set<std::uint32_t>(liquid.particles.id.data(), liquid.particles.id.data() + liquid.particles.count), inside);
    EXPECT_GT(inside.size(), 100);
    EXPECT_NEAR(liquid.ledger.leftMass, mass, 1e-13 * mass);
    EXPECT_LT((liquid.ledger.leftMomentum - momentum).norm(), 1e-13 * momentum.norm());
    for (std::size_t s = 0; s < liquid.particles.count; ++s) EXPECT_EQ(liquid.particles.velocity(liquid.order.source[s]).x(), liquid.particles.id[s]);
    // Nobody is outside any more.
    liquid.moveModesHome();
    sortParticles(liquid.particles, liquid.grid, &domain, liquid.order, &liquid.ledger);
    EXPECT_NEAR(liquid.ledger.leftMass, mass, 1e-13 * mass);
}

TEST(ParticleOrder, MayBeEmpty)
{
    SortedLiquid liquid = unsortedLiquid(10, kTwoCorners, 1.0);
    const Shape domain = Shape::ball({1000.0, 0.0, 0.0}, 1.0);
    sortParticles(liquid.particles, liquid.grid, &domain, liquid.order, &liquid.ledger);
    EXPECT_EQ(liquid.particles.count, 0);
    EXPECT_EQ(liquid.grid.count(), 0);
    liquid.sort();
    EXPECT_EQ(liquid.grid.count(), 0);
}

TEST(ParticleOrder, NamesWhatIsWrongWithAPlace)
{
    const auto messageFor = [](double place) -> std::string {
        SortedLiquid liquid = unsortedLiquid(100, kTwoCorners, 1.0);
        liquid.particles.x[1][57] = place;
        try {
            liquid.sort();
        } catch (const RunError& e) {
            return e.what();
        }
        return "no error";
    };
    const double infinity = std::numeric_limits<double>::infinity();
    EXPECT_THAT(messageFor(std::numeric_limits<double>::quiet_NaN()), testing::HasSubstr("position of a particle is not finite"));
    EXPECT_THAT(messageFor(-infinity), testing::HasSubstr("position of a particle is not finite"));
    EXPECT_THAT(messageFor(1.0e8), testing::HasSubstr("domain"));
    EXPECT_THAT(messageFor(-1.0e15), testing::HasSubstr("domain"));
    EXPECT_EQ(messageFor(1.0e3), "no error");
}

// A stray that is so far out would stop the run, but not where the scene says that it is to be deleted.
TEST(ParticleOrder, ADomainAlsoDeletesWhatHasLeftTheRangeOfBlocks)
{
    SortedLiquid liquid = unsortedLiquid(100, kTwoCorners, 1.0);
    liquid.particles.x[1][57] = 1.0e15;
    const Shape domain = Shape::ball(Vec3::Zero(), 100.0);
    sortParticles(liquid.particles, liquid.grid, &domain, liquid.order, &liquid.ledger);
    EXPECT_EQ(liquid.particles.count, 99);
    EXPECT_EQ(liquid.ledger.leftMass, 58.0);
}
