#include "sim/liquid/push_out.h"

#include "tests/sim/fixtures.h"

#include <gtest/gtest.h>

namespace sim::test {
namespace {

constexpr double kCell = 0.25;  // [cm]

/// Random particles that have moved by up to `farthest` since they were sorted, and what pushing out makes of them.
struct PushOutTotals {
    std::vector<Vec3> before, after;

    PushOutTotals(const Obstacles& obstacles, double farthest)
    {
        SortedLiquid liquid = randomLiquid(6000, 1, {30, 30, 30}, {-15, -15, -15}, kCell);
        ObstacleField field;
        field.update(liquid.grid, std::vector<int>(liquid.grid.count(), BlockGrid::kNone), obstacles, false);
        std::mt19937 random(8);
        std::uniform_real_distribution<double> unit(-1.0, 1.0);
        for (std::size_t p = 0; p < liquid.particles.count; ++p) {
            const Vec3 way = Vec3(unit(random), unit(random), unit(random)).normalized() * farthest;
            for (int a = 0; a < kAxes; ++a) liquid.particles.x[a][p] += way[a];
            before.push_back(liquid.particles.position(p));
        }
        ChunkSums<Impulse> onSolids;
        pushOutOfObstacles(liquid.order, {liquid.grid, field, obstacles}, farthest, nullptr, liquid.particles, onSolids);
        for (std::size_t p = 0; p < before.size(); ++p) after.push_back(liquid.particles.position(p));
    }
};

void expectAllOutside(const Obstacles& obstacles, double farthest)
{
    const PushOutTotals pushed(obstacles, farthest);
    std::size_t moved = 0;
    for (std::size_t p = 0; p < pushed.before.size(); ++p) {
        const double distance = obstacles.distance(pushed.before[p]);
        ASSERT_GT(obstacles.distance(pushed.after[p]), -1.0e-12) << "from " << distance;
        const double way = (pushed.after[p] - pushed.before[p]).norm();
        ASSERT_NEAR(way, distance < 0.0 ? kPushedInFront * kCell - distance : 0.0, 1.0e-9)
            << "the shortest way out and a little more, none for those outside";
        moved += way > 0.0;
    }
    EXPECT_GT(moved, 20u);
    EXPECT_LT(moved, pushed.before.size());
}

TEST(PushOut, ParticlesLeaveABallByTheShortestWay)
{
    Obstacles obstacles;
    obstacles.add(Shape::ball({0.3, 0.2, 0.1}, 1.3), {});
    for (double farthest : {0.0, 0.1, 0.24, 0.3, 0.8}) expectAllOutside(obstacles, farthest);
}

TEST(PushOut, ParticlesStayInATank)
{
    Obstacles obstacles;
    obstacles.add(Shape::box({0.1, -0.2, 0.3}, {3.0, 3.2, 3.1}).inverted(), {});
    for (double farthest : {0.0, 0.1, 0.24, 0.3, 0.8}) expectAllOutside(obstacles, farthest);
}

TEST(PushOut, MovingBodiesFarFromRestingOnesAreMet)
{
    Obstacles obstacles;
    Motion motion;
    motion.addTranslation(0.0, 1.0, {4.0, 0.0, 0.0}, 0.0, 0.0);
    obstacles.add(Shape::box({0.1, -0.2, 0.3}, {9.0, 9.0, 9.0}).inverted(), {});
    obstacles.add(Shape::ball({-1.0, 0.2, 0.1}, 0.9), motion);
    obstacles.moveTo(0.3, 0.4);
    for (double farthest : {0.1, 0.8}) expectAllOutside(obstacles, farthest);
}

}  // namespace
}  // namespace sim::test
