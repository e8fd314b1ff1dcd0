#include "sim/grid/obstacle_field.h"

#include "sim/core/units.h"
#include "tests/sim/grid/random_solids.h"
#include "tests/sim/liquid/grid_scene.h"

#include <gtest/gtest.h>
#include <malloc.h>

namespace sim::test {
namespace {

/// What is in a vessel is in front of its walls and the other way about, and on no straight way between two such places is a wall.
TEST(Obstacles, VesselsHoldWhatIsInFrontOfTheirWalls)
{
    std::mt19937 random(17);
    std::uniform_real_distribution<double> unit(0.0, 1.0);
    std::size_t held = 0, out = 0;
    for (int n = 0; n < 60; ++n) {
        const Vec3 center(unit(random), unit(random), unit(random)), half = Vec3(0.2 + unit(random), 0.2 + unit(random), 0.2 + unit(random));
        const double round = n % 3 == 0 ? 0.0 : unit(random) * half.minCoeff(), margin = 1.0e-3 * unit(random);
        const Shape shape = round > 0.0 ? Shape::roundedBox(center, half, round) : Shape::box(center, half);
        const Vec3 shift(unit(random), -unit(random), 0.3);
        Obstacles obstacles;
        obstacles.add(shape.inverted().moved(Eigen::Isometry3d(Eigen::Translation3d(shift))), Motion());
        ASSERT_EQ(obstacles.vessels().size(), 1u);
        std::vector<Vec3> inside;
        for (int i = 0; i < 300; ++i) {
            const Vec3 x = center + shift + 1.1 * half.cwiseProduct(2.0 * Vec3(unit(random), unit(random), unit(random)) - Vec3::Ones());
            const double distance = obstacles.distance(x);
            const bool isHeld = obstacles.vessels()[0].holds(x, margin);
            if (std::abs(distance - margin) > 1.0e-12) {
                EXPECT_EQ(isHeld, distance > margin) << n << ": " << distance;
            }
            (isHeld ? held : out) += 1;
            if (isHeld) inside.push_back(x);
        }
        for (std::size_t i = 1; i < inside.size(); ++i) EXPECT_FALSE(obstacles.firstContact(inside[i - 1], inside[i], 1.0e-4)) << n;
    }
    EXPECT_GT(held, 1000u);
    EXPECT_GT(out, 1000u);
}

/// Solids that turn, move or are solid inside are no vessels.
TEST(Obstacles, VesselsRestAlongTheAxesAndAreSolidOutside)
{
    const Shape box = Shape::box(Vec3::Zero(), Vec3::Ones());
    const Eigen::Isometry3d turned(Eigen::AngleAxisd(0.3, Vec3::UnitX()));
    Obstacles obstacles;
    obstacles.add(box, Motion());
    obstacles.add(box.inverted().moved(turned), Motion());
    obstacles.add(Shape::ball(Vec3::Zero(), 1.0).inverted(), Motion());
    EXPECT_TRUE(obstacles.vessels().empty());
    EXPECT_TRUE(obstacles.reach(Vec3::Zero(), 0.1, 0.1, Obstacles::Which::NotVessels));
    Obstacles vessel;
    vessel.add(box.inverted(), Motion());
    EXPECT_TRUE(vessel.reach(Vec3(0.95, 0.0, 0.0), 0.1, 0.1));
    EXPECT_FALSE(vessel.reach(Vec3(0.95, 0.0, 0.0), 0.1, 0.1, Obstacles::Which::NotVessels));
}

TEST(ObstacleField, WallsInPlanesOfFacesCloseThemWhateverTheRounding)
{
    std::mt19937 random(3);
    std::uniform_real_distribution<double> unit(0.0, 1.0);
    for (int n = 0; n < 40; ++n) {
        const double dx = 0.01 + unit(random);
        GridScene scene({-3, -3, -3}, {9, 10, 11}, dx, 5.0 * Vec3(unit(random), unit(random), -unit(random)));
        // Sums in another order than the grid's own.
        Vec3 low, high;
        for (int a = 0; a < kAxes; ++a) {
            low[a] = scene.grid.origin[a] - dx + dx;
            high[a] = low[a] + dx * (3 + a) + 3.0 * dx;
        }
        scene.add(Shape::box(0.5 * (low + high), 0.5 * (high - low)).inverted());
        scene.forEachFace([&](int a, const Vec3i& c) {
            bool inside = c[a] > 0 && c[a] < 6 + a;
            for (int b = 0; b < kAxes; ++b)
                if (b != a) inside = inside && c[b] >= 0 && c[b] < 6 + b;
            ASSERT_EQ(scene.open(a, c), inside ? 1.0 : 0.0) << a << ": " << c.transpose();
            ASSERT_EQ((scene.field.closed(scene.at(c).block, a)[c.z() & 7] >> (8 * (c.y() & 7) + (c.x() & 7)) & 1) == 1, !inside);
        });
    }
}

/// What flows along a slope leaves no cell through the seams of the slope with the walls at its ends, or with another that goes on from it:
/// the open faces of a cell close its surface, Σ ω n = −A n_wall.
TEST(ObstacleField, FacesAtTheSeamsOfSolidsAreOpenAsFarAsTheirSurfaceLeavesThem)
{
    std::mt19937 random(5);
    std::uniform_real_distribution<double> unit(-1.0, 1.0);
    for (int n = 0; n < 40; ++n) {
        const int across = n % kAxes;
        const double dx = 0.1 + 0.05 * unit(random), angle = kPi * unit(random);
        GridScene scene({-8, -8, -8}, {8, 8, 8}, dx, Vec3(unit(random), unit(random), unit(random)));
        const Vec3 middle = scene.grid.origin;
        const auto between = [&](const Vec3& low, const Vec3& high) {
            return Shape::box(0.5 * (low + high), 0.5 * (high - low))
                .moved(Eigen::Translation3d(middle) * Eigen::Isometry3d(Eigen::AngleAxisd(angle, Vec3::Unit(across))));
        };
        Vec3 low = Vec3::Constant(-99.0 * dx), high = -low, seam;
        const int along = (across + 1) % kAxes, up = (across + 2) % kAxes;
        high[up] = dx * unit(random);
        low[across] = -5.0 * dx;
        high[across] = 6.0 * dx;
        // The slope is one box, two side by side with the seam in a plane of faces, or two one after the other.
        const int seamAxis = n % 2 == 0 ? across : along;
        const double at = n % 2 == 0 ? 2.0 * dx : dx * unit(random);
        if (n % 5 == 0) scene.add(between(low, high));
        else {
            Vec3 end = high, start = low;
            end[seamAxis] = start[seamAxis] = at;
            scene.add(between(low, end));
            scene.add(between(start, high));
        }
        Vec3 wallLow = Vec3::Constant(-99.0 * dx), wallHigh = -wallLow;
        wallLow[across] = low[across];
        wallHigh[across] = high[across];
        scene.add(Shape::box(middle + 0.5 * (wallLow + wallHigh), 0.5 * (wallHigh - wallLow)).inverted());
        Vec3 tangent = Eigen::AngleAxisd(angle, Vec3::Unit(across)) * Vec3::Unit(along);
        int cut = 0;
        scene.forEachCell([&](const Vec3i& c) {
            if (c[across] < -5 || c[across] >= 6 || (c.array() < -6).any() || (c.array() > 5).any()) return;
            double outflow = 0.0;
            for (int a = 0; a < kAxes; ++a) {
                const double below = scene.open(a, c), above = scene.open(a, c + Vec3i::Unit(a));
                outflow += tangent[a] * (above - below);
                cut += below > 0.0 && below < 1.0;
            }
            ASSERT_LT(std::abs(outflow), 2.0e-3) << n << ": " << c.transpose();  // open fractions below 1e-3 count as closed
        });
        EXPECT_GT(cut, 100);
    }
}

/// Corners between solids and plates thinner than a cell, wherever they are on a face.
TEST(ObstacleField, FacesAreOpenAsFarAsSamplesOfThemAre)
{
    std::mt19937 random(6);
    std::uniform_real_distribution<double> unit(-1.0, 1.0);
    double worst = 0.0, sum = 0.0;
    int faces = 0;
    for (int n = 0; n < 12; ++n) {
        GridScene scene({-8, -8, -8}, {8, 8, 8}, 0.2, Vec3(unit(random), unit(random), unit(random)));
        const auto turned = [&](const Shape& shape) {
            const Vec3 axis(unit(random), unit(random), unit(random));
            return shape.moved(Eigen::Translation3d(scene.grid.origin + 0.4 * Vec3(unit(random), unit(random), unit(random))) *
                               Eigen::Isometry3d(Eigen::AngleAxisd(kPi * unit(random), axis.normalized())));
        };
        const double thickness = 0.2 * (0.15 + 0.1 * (unit(random) + 1.0));  // of a plate, 0.15 to 0.35 cells
        scene.add(turned(Shape::box(Vec3::Zero(), {0.5 * thickness, 0.6, 0.7})));
        if (n % 2 == 0) scene.add(turned(Shape::box(Vec3::Zero(), {0.6, 0.3, 0.5})));
        if (n % 3 == 0) scene.add(turned(Shape::box(Vec3::Zero(), {1.1, 0.9, 1.0}).inverted()));
        scene.forEachFace([&](int a, const Vec3i& c) {
            if ((c.array() < -7).any() || (c.array() > 6).any() || scene.open(a, c) == 0.0) return;
            constexpr int kSamples = 20;
            int open = 0;
            for (int i = 0; i < kSamples * kSamples; ++i) {
                Vec3 at = c.cast<double>();
                at[(a + 1) % kAxes] += (i % kSamples + 0.5) / kSamples;
                at[(a + 2) % kAxes] += (i / kSamples + 0.5) / kSamples;
                open += scene.obstacles.distance(scene.grid.origin + 0.2 * at) >= 0.0;
            }
            if (open == kSamples * kSamples && scene.open(a, c) == 1.0) return;
            const double error = std::abs(scene.open(a, c) - double(open) / (kSamples * kSamples));
            worst = std::max(worst, error);
            sum += error;
            ++faces;
        });
    }
    EXPECT_GT(faces, 2000);
    EXPECT_LT(worst, 0.12);          // where one surface along the face hides another
    EXPECT_LT(sum / faces, 5.0e-3);  // of which the samples are half
}

TEST(ObstacleField, OpenFractionsOfABallCloseItsSurface)
{
    // Σ (1 − ω) h² over the faces of a plane is the area of the ball's section.
    GridScene scene({-16, -16, -16}, {16, 16, 16}, 0.1, Vec3::Zero());
    scene.add(Shape::ball({0.02, -0.03, 0.01}, 1.0));
    for (int a = 0; a < kAxes; ++a)
        for (int plane : {-6, 0, 3}) {
            double area = 0.0;
            scene.forEachCell([&](const Vec3i& c) {
                if (c[a] == plane) area += (1.0 - scene.open(a, c)) * 0.01;
            });
            const double z = 0.1 * plane - Vec3(0.02, -0.03, 0.01)[a];
            EXPECT_NEAR(area, kPi * (1.0 - z * z), 0.01);
        }
}

TEST(ObstacleField, TellsDistancesUpToItsReachInEveryBlock)
{
    Chance chance(17);
    for (const Kind& kind : kSolidKinds)
        for (int n = 0; n < 4; ++n) {
            GridScene scene({-16, -16, -16}, {16, 16, 16}, 0.2, chance.inCube(1.0));
            scene.add(kind.make(chance).moved(chance.turn(1.0)));
            const double reach = ObstacleField::kExactDistance * scene.grid.dx;
            scene.forEachCell([&](const Vec3i& c) {
                const double told = scene.field.centerDistance(scene.at(c).block)[scene.at(c).cell];
                ASSERT_LE(told, reach) << kind.name << " at cell " << c.transpose();
                // Where parts of a solid meet, its depth is counted from its surface and not from the parts' own.
                const double distance = scene.obstacles.distance(scene.middle(c));
                if (distance <= 0.0) return;
                ASSERT_NEAR(told, std::min(distance, reach), 1.0e-12) << kind.name << " at cell " << c.transpose();
            });
        }
}

TEST(ObstacleField, WallsThatRestDoNotMoveOnceOthersDo)
{
    constexpr int kFill = 0x80;  // new memory is filled with its complement
    GridScene scene({-16, -16, -16}, {16, 16, 16}, 0.2, Vec3::Zero());
    mallopt(M_PERTURB, kFill);
    scene.obstacles.add(Shape::ball({-1.5, -1.5, -1.5}, 1.0), {});
    Motion motion;
    motion.addTranslation(0.5, 1.0, {0.1, 0.0, 0.0}, 0.0, 0.0);
    scene.obstacles.add(Shape::ball({2.0, 2.0, 2.0}, 0.5), motion);
    std::vector<int> same(scene.grid.count(), BlockGrid::kNone);
    for (const double t : {0.0, 0.25, 0.75}) {
        scene.obstacles.moveTo(t, t + 0.01);
        scene.field.update(scene.grid, same, scene.obstacles, false);
        std::iota(same.begin(), same.end(), 0);
    }
    mallopt(M_PERTURB, 0);
    int moving = 0;
    scene.forEachFace([&](int a, const Vec3i& c) {
        const double u = scene.field.wallVelocity(scene.at(c).block, a)[scene.at(c).cell];
        if (scene.middle(c).maxCoeff() < 0.0) {
            ASSERT_EQ(u, 0.0) << "axis " << a << ", cell " << c.transpose();
        }
        moving += u != 0.0;
    });
    EXPECT_GT(moving, 0);
}

/// Everything a field tells of a block.
void expectSameBlock(const ObstacleField& a, int blockA, const ObstacleField& b, int blockB)
{
    for (int axis = 0; axis < kAxes; ++axis)
        for (int c = 0; c < kBlockCells; ++c) {
            ASSERT_EQ(a.open(blockA, axis)[c], b.open(blockB, axis)[c]);
            ASSERT_EQ(a.wallVelocity(blockA, axis)[c], b.wallVelocity(blockB, axis)[c]);
            ASSERT_EQ(a.closed(blockA, axis)[c / 64], b.closed(blockB, axis)[c / 64]);
        }
    if (!a.nearSolid(blockA) || !b.nearSolid(blockB)) return;
    for (int c = 0; c < kBlockCells; ++c) ASSERT_EQ(a.centerDistance(blockA)[c], b.centerDistance(blockB)[c]);
    for (int axis = 0; axis < kAxes; ++axis)
        for (int c = 0; c < kBlockCells; ++c) ASSERT_EQ(a.room(blockA, axis)[c], b.room(blockB, axis)[c]);
}

TEST(ObstacleField, FollowsBlocksThatComeAndGoAndSolidsThatMoveAndStop)
{
    Obstacles obstacles;
    obstacles.add(Shape::ball({4.0, 4.0, 4.0}, 3.0), {});
    Motion motion;
    motion.addTranslation(0.25, 0.75, {30.0, 0.0, 0.0}, 0.0, 0.0);
    motion.addRotation(0.25, 0.75, {Vec3::UnitY(), Vec3(-4.0, 0.0, 2.0)}, 2.0, 0.0, 0.0);
    obstacles.add(Shape::box({-8.0, 2.0, 4.0}, {2.0, 3.0, 4.0}), motion);

    std::mt19937 random(4);
    BlockGrid grid;
    ObstacleField field;
    for (int step = 0; step < 48; ++step) {
        const double t = step % 24 / 20.0;
        if (step < 24) obstacles.moveTo(t, t + 0.05);
        else obstacles.startAt(t, t + 0.05);
        if (step == 24) field = {};
        std::vector<Vec3i> blocks;
        for (int x = -3; x < 5; ++x)
            for (int y = -1; y < 2; ++y)
                for (int z = -1; z < 2; ++z)
                    if (random() % 4 != 0) blocks.emplace_back(x, y, z);
        const std::vector<Vec3i> before = grid.coords();
        grid.setBlocks(blocks);
        std::vector<int> previous;
        for (int b = 0; b < grid.count(); ++b) {
            const auto old = std::find(before.begin(), before.end(), grid.coords(b));
            previous.push_back(old == before.end() ? BlockGrid::kNone : static_cast<int>(old - before.begin()));
        }
        field.update(grid, previous, obstacles, false);
        ObstacleField fresh;
        fresh.update(grid, std::vector<int>(grid.count(), BlockGrid::kNone), obstacles, false);
        for (int b = 0; b < grid.count(); ++b) ASSERT_NO_FATAL_FAILURE(expectSameBlock(field, b, fresh, b)) << "step " << step;
        for (int a = 0; a < kAxes; ++a) EXPECT_EQ(field.open(grid.count(), a)[17], 1.0) << "the empty block";
    }
}

TEST(ObstacleField, WallsMoveWithTheirBody)
{
    GridScene scene({-8, -8, -8}, {16, 16, 16}, 0.5, Vec3::Zero());
    Motion motion;
    motion.addRotation(0.0, 1.0, {Vec3::UnitZ(), Vec3(1.0, 0.0, 0.0)}, 3.0, 0.0, 0.0);
    motion.addTranslation(0.0, 1.0, {0.0, 0.0, 5.0}, 0.0, 0.0);
    scene.obstacles.add(Shape::ball({1.0, 1.0, -1.0}, 1.0), motion);
    const double dt = 1.0e-5;
    scene.obstacles.moveTo(0.2, 0.2 + dt);
    scene.updateObstacles();
    scene.forEachFace([&](int a, const Vec3i& c) {
        const CellRef ref = scene.at(c);
        if (!scene.field.nearSolid(ref.block)) return;
        // The mean velocity over the step is that of its middle, to second order.
        const Vec3 x = scene.faceMiddle(a, c), v = motion.velocity(0.2 + dt, x);
        ASSERT_NEAR(scene.field.wallVelocity(ref.block, a)[ref.cell], v[a], 1.0e-3);
    });
    scene.obstacles.moveTo(1.5, 1.6);
    scene.updateObstacles();
    scene.forEachFace([&](int a, const Vec3i& c) { ASSERT_EQ(scene.field.wallVelocity(scene.at(c).block, a)[scene.at(c).cell], 0.0); });
}

}  // namespace
}  // namespace sim::test
