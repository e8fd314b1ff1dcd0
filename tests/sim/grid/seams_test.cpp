// Two boxes that touch are for the liquid the one box that they make, wherever the seam is and however they are turned.
#include "sim/grid/seams.h"

#include "tests/sim/grid/random_solids.h"
#include "tests/sim/liquid/grid_scene.h"

#include <gtest/gtest.h>

namespace sim::test {
namespace {

constexpr double kCell = 0.2;  // [cm]

/// A box, whole and in two parts with flush sides.
struct Cut {
    GridScene whole, parts;
    Eigen::Isometry3d turn;
    Vec3 half;
    int axis;
    double seam;

    Cut(Chance& chance, bool isTurned)
        : whole({-8, -8, -8}, {8, 8, 8}, kCell, chance.inCube(0.3)),
          parts({-8, -8, -8}, {8, 8, 8}, kCell, whole.grid.origin),
          turn(isTurned ? chance.turn(0.3) : Eigen::Isometry3d(Eigen::Translation3d(whole.grid.origin + chance.inCube(0.1)))),
          half(Vec3::Constant(1.0) + chance.inCube(0.3)),
          axis(static_cast<int>(chance.random() % 3)),
          seam(chance.between(-0.4, 0.4))
    {
        if (!isTurned && chance.random() % 2 == 0) {  // in planes of faces, also the seam
            turn = Eigen::Isometry3d(Eigen::Translation3d(whole.grid.origin));
            seam = kCell * std::round(seam / kCell);
            for (double& h : half) h = kCell * std::round(h / kCell);
        }
        whole.obstacles.add(Shape::box(Vec3::Zero(), half).moved(turn), {});
        Vec3 lowHalf = half, low = Vec3::Zero(), highHalf = half, high = Vec3::Zero();
        lowHalf[axis] = 0.5 * (seam + half[axis]);
        low[axis] = 0.5 * (seam - half[axis]);
        highHalf[axis] = 0.5 * (half[axis] - seam);
        high[axis] = 0.5 * (half[axis] + seam);
        parts.obstacles.add(Shape::box(low, lowHalf).moved(turn), {});
        parts.obstacles.add(Shape::box(high, highHalf).moved(turn), {});
        for (GridScene* scene : {&whole, &parts}) scene->obstacles.moveTo(0.0, 0.0);
    }

    void findFields()
    {
        whole.updateObstacles();
        parts.updateObstacles();
    }
};

TEST(Seams, OfTouchingBoxesLeaveRoomOpenFractionsAndDistancesAlone)
{
    Chance chance(1);
    for (int n = 0; n < 16; ++n) {
        Cut cut(chance, n % 2 == 0);
        cut.findFields();
        SCOPED_TRACE(n);
        double room = 0.0, open = 0.0, distance = 0.0;
        for (int b = 0; b < cut.whole.grid.count(); ++b) {
            ASSERT_EQ(cut.whole.field.nearSolid(b), cut.parts.field.nearSolid(b));
            if (!cut.whole.field.nearSolid(b)) continue;
            for (int c = 0; c < kBlockCells; ++c) {
                for (int a = 0; a < kAxes; ++a) {
                    room = std::max(room, std::abs(cut.whole.field.room(b, a)[c] - cut.parts.field.room(b, a)[c]));
                    open = std::max(open, std::abs(cut.whole.field.open(b, a)[c] - cut.parts.field.open(b, a)[c]));
                }
                const double one = cut.whole.field.centerDistance(b)[c], two = cut.parts.field.centerDistance(b)[c];
                const double deepest = -ObstacleField::kExactDistance * kCell;
                distance = std::max(distance, std::abs(std::max(one, deepest) - std::max(two, deepest)));
            }
        }
        EXPECT_LT(room, 1.0e-9);
        EXPECT_LT(open, 1.0e-3);  // what is nearly closed counts as closed
        EXPECT_LT(distance, 1.0e-9);
    }
}

TEST(Seams, AreNoWayOut)
{
    Chance chance(2);
    int inside = 0;
    for (int n = 0; n < 40; ++n) {
        const Cut cut(chance, n % 2 == 0);
        for (int place = 0; place < 200; ++place) {
            const Vec3 x = cut.turn * Vec3(chance.inCube(1.3).cwiseMin(cut.half).cwiseMax(-cut.half));
            const double depth = -cut.whole.obstacles.distance(x), reach = 1.5 * kCell;
            if (depth <= 1.0e-9 || depth > 0.9 * reach) continue;
            const auto surface = nearestSurface(cut.parts.obstacles, x, reach);
            ASSERT_TRUE(surface.has_value()) << depth;
            ASSERT_NEAR((*surface - x).norm(), depth, 1.0e-9);
            ASSERT_NEAR(cut.whole.obstacles.distance(*surface), 0.0, 1.0e-9);
            ASSERT_NEAR(distanceAcrossSeams(cut.parts.obstacles, x, reach), -depth, 1.0e-9);
            ++inside;
        }
    }
    EXPECT_GT(inside, 1000);
}

TEST(Seams, NormalsOutsideAreThoseOfTheOneBox)
{
    Chance chance(3);
    int seen = 0;
    for (int n = 0; n < 40; ++n) {
        const Cut cut(chance, n % 2 == 0);
        for (int place = 0; place < 200; ++place) {
            Vec3 x = chance.inCube(1.6);
            if (place % 2 == 0) x[cut.axis] = cut.seam + 1.0e-9 * chance.between(-1.0, 1.0);
            x = cut.turn * x;
            const double distance = cut.whole.obstacles.distance(x);
            if (distance < 1.0e-3) continue;
            ASSERT_NEAR(cut.parts.obstacles.distance(x), distance, 1.0e-9);
            ASSERT_LT((cut.parts.obstacles.normal(x) - cut.whole.obstacles.normal(x)).norm(), 1.0e-5);
            ++seen;
        }
    }
    EXPECT_GT(seen, 1000);
}

}  // namespace
}  // namespace sim::test
