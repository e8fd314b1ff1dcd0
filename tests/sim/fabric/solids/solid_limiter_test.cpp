#include "sim/fabric/solids/solid_limiter.h"
#include "tests/sim/fabric/contact/encounter.h"

#include <gtest/gtest.h>

namespace sim::testing {
namespace {

TEST(SolidLimiter, NoMoveGetsThroughASolid)
{
    int without = 0;
    for (unsigned seed = 1; seed <= 60; ++seed) {
        const Encounter scene(seed, 500.0);
        Noise noise(1000 + seed);
        const Fabric fabric = assembleFabric(scene.pieces);
        SolidLimiter guard(fabric, {&scene.solid, 1});
        std::vector<Vec3> x = fabric.rest, u(x.size());
        for (int step = 0; step < 8; ++step) {
            const double t0 = 2.0e-3 * step, t1 = t0 + 2.0e-3;
            for (Vec3& move : u) move = 2.0e-3 * scene.pieces[0].velocity + 0.05 * noise.vector();
            guard.moveTo(t0, t1);
            without += crossings(fabric, scene.solid, t0, t1, x, u) > 0;
            SolidLimitReport report;
            guard.limit(x, fabric.mass, u, report);
            EXPECT_EQ(report.left, 0) << "seed " << seed << " step " << step;
            ASSERT_EQ(crossings(fabric, scene.solid, t0, t1, x, u), 0) << "seed " << seed << " step " << step;
            const Eigen::Isometry3d toEnd = scene.solid.motion.transform(t1).inverse();
            for (std::size_t v = 0; v < x.size(); ++v) {
                x[v] += u[v];
                ASSERT_GT(scene.solid.shape.distance(toEnd * x[v]), 0.56 * fabric.radius[v]) << "seed " << seed << " step " << step;
            }
        }
    }
    EXPECT_GT(without, 60);  // of 480 moves
}

/// Cloth in a narrow room, in which a thin plate turns about its middle: its corners are drawn to places in the room, so that long faces reach
/// from the plate to the walls, which cannot go with both.
struct Winding {
    explicit Winding(unsigned seed) : noise(seed)
    {
        ClothGrid grid;
        grid.nodes = Vec2i(5, 5);
        grid.spacing = {0.18, 0.18};
        FabricPiece piece = pieceOf(clothGrid(grid), wool(), {0.007, 0.007});
        moveTo(piece, Vec3(0.0, 0.5, 0.0), Mat3::Identity());
        fabric = assembleFabric({&piece, 1});
        ObstacleSettings plate, room;
        plate.shape = Shape::box(Vec3::Zero(), {0.4 + 0.05 * noise(), 0.006 + 0.004 * noise(), 0.3});
        plate.motion.addRotation(0.0, 1.0, {noise.vector().normalized(), Vec3::Zero(), Motion::Frame::Local}, 30.0 + 15.0 * noise(), 0.0, 0.0);
        room.shape = Shape::box(Vec3::Zero(), Vec3::Constant(0.62 + 0.05 * noise())).inverted();
        solids = {plate, room};
        for (std::size_t v = 0; v < fabric.vertexCount(); ++v) drawnTo.push_back(0.8 * noise.vector());
    }
    Noise noise;
    Fabric fabric;
    std::vector<ObstacleSettings> solids;
    std::vector<Vec3> drawnTo;  ///< [cm]
};

TEST(SolidLimiter, NothingIsSqueezedThroughByATurningPlate)
{
    int halved = 0;
    for (unsigned seed = 3; seed <= 6; ++seed) {
        Winding scene(seed);
        SolidLimiter guard(scene.fabric, scene.solids);
        std::vector<Vec3> x = scene.fabric.rest, u(x.size());
        const std::vector<Vec3> still(x.size(), Vec3::Zero());
        const double h = seed % 2 == 0 ? 1.0e-3 : 3.0e-3;
        for (int step = 0; step < 12; ++step) {
            for (std::size_t v = 0; v < u.size(); ++v) u[v] = 0.3 * (scene.drawnTo[v] - x[v]) + 0.02 * scene.noise.vector();
            SolidLimitReport report;
            guard.limitBisected(step * h, h, x, scene.fabric.mass, u, report);
            for (std::size_t v = 0; v < u.size(); ++v) x[v] += u[v];
            halved += report.left > 0;
            const double end = (step + 1) * h;
            for (const ObstacleSettings& solid : scene.solids)
                ASSERT_EQ(crossings(scene.fabric, solid, end, end, x, still), 0) << "seed " << seed << " step " << step;
        }
    }
    EXPECT_GT(halved, 5);  // of 48 steps
}

}  // namespace
}  // namespace sim::testing
