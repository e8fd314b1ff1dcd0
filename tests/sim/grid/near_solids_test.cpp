// Every block that a solid comes near to knows it, and particles that one comes upon are moved, however fast it is.
#include "tests/sim/grid/random_solids.h"
#include "tests/sim/liquid/grid_scene.h"

#include <gtest/gtest.h>

namespace sim::test {
namespace {

/// A mesh that runs across its bounds: outside of the lattice that it is sampled on it is much nearer than its distance says.
Shape meshOfSlantedPlate(Chance& chance)
{
    const double thick = chance.between(0.1, 0.3);
    std::vector<Vec3> corners;
    const Vec3 normal = Vec3::Ones().normalized(), u = Vec3(1.0, -1.0, 0.0).normalized(), v = normal.cross(u);
    for (int n = 0; n < 8; ++n) corners.emplace_back((n & 1 ? 1.5 : -1.5) * u + (n & 2 ? 1.5 : -1.5) * v + (n & 4 ? thick : -thick) * normal);
    return Shape::mesh(corners, kFacesOfBox, 0.05);
}

TEST(NearSolids, BlocksThatOneReachesKnowIt)
{
    std::vector<Kind> kinds(kSolidKinds.begin(), kSolidKinds.end());
    kinds.push_back({"mesh of a slanted plate", meshOfSlantedPlate, true});
    for (const Kind& kind : kinds) {
        SCOPED_TRACE(kind.name);
        constexpr double kCell = 0.1, kWithin = (ObstacleField::kExactDistance - 0.05) * kCell;  // what is sampled is off by some per mille
        Chance chance(1);
        const Shape shape = kind.make(chance);
        int near = 0, far = 0;
        for (int n = 0; n < 300; ++n) {
            // One block, of which some corner, edge or face may come near.
            GridScene scene({0, 0, 0}, {8, 8, 8}, kCell, chance.inCube(3.0) - Vec3::Constant(0.4));
            scene.obstacles.add(shape, {});
            scene.updateObstacles();
            double least = 1.0e9;
            for (int k = 0; k <= 8; k += 2)
                for (int j = 0; j <= 8; j += 2)
                    for (int i = 0; i <= 8; i += 2) least = std::min(least, shape.distance(scene.corner({i, j, k})));
            ASSERT_TRUE(scene.field.nearSolid(0) || least >= kWithin) << n << ": " << least << " cm";
            ASSERT_FALSE(scene.field.nearSolid(0) && least > 8.0 * kCell) << n << ": " << least << " cm";
            near += least < kWithin;
            far += least > 8.0 * kCell;
        }
        EXPECT_GT(near, 8);
        EXPECT_TRUE(far > 8 || kind.name == std::string("vessel")) << far;
    }
}

/// Between cells on the two sides of a plate nothing flows, however thin it is and however it is turned; between others it closes nothing that
/// it does not cut.
TEST(NearSolids, APlateClosesTheFacesBetweenItsTwoSides)
{
    Chance chance(4);
    int closed = 0, open = 0;
    for (int n = 0; n < 30; ++n) {
        GridScene scene({-8, -8, -8}, {8, 8, 8}, 0.2, chance.inCube(0.3));
        const double half = 0.5 * scene.grid.dx * chance.between(0.03, 0.6);
        const Eigen::Isometry3d turn = chance.turn(0.5);
        scene.add(Shape::box(Vec3::Zero(), {half, 20.0, 20.0}).moved(turn));
        const auto across = [&](const Vec3i& c) { return (turn.inverse() * scene.middle(c)).x(); };
        scene.forEachFace([&](int a, const Vec3i& c) {
            if (c[a] == scene.lower[a]) return;
            const double here = across(c), there = across(c - Vec3i::Unit(a));
            if (std::min(std::abs(here), std::abs(there)) <= half + 1.0e-9) return;  // one of them is in the plate
            if (here * there < 0.0) {
                ASSERT_EQ(scene.open(a, c), 0.0) << "plate of " << 2.0 * half / scene.grid.dx << " cells";
                ++closed;
            } else if (std::min(std::abs(here), std::abs(there)) > half + scene.grid.dx) {
                ASSERT_EQ(scene.open(a, c), 1.0);
                ++open;
            }
        });
    }
    EXPECT_GT(closed, 1000);
    EXPECT_GT(open, 10000);
}

}  // namespace
}  // namespace sim::test
