#include "sim/fabric/solids/guard.h"
#include "tests/sim/fabric/encounter.h"

#include <gtest/gtest.h>

namespace sim::testing {
namespace {

TEST(SolidGuard, NoMoveGetsThroughASolid)
{
    int without = 0;
    for (unsigned seed = 1; seed <= 60; ++seed) {
        const Encounter scene(seed, 500.0);
        Noise noise(1000 + seed);
        const Fabric fabric = assembleFabric(scene.pieces);
        SolidGuard guard(fabric, {&scene.solid, 1});
        std::vector<Vec3> x = fabric.rest, u(x.size());
        for (int step = 0; step < 8; ++step) {
            const double t0 = 2.0e-3 * step, t1 = t0 + 2.0e-3;
            for (Vec3& move : u) move = 2.0e-3 * scene.pieces[0].velocity + 0.05 * noise.vector();
            guard.moveTo(t0, t1);
            without += crossings(fabric, scene.solid, t0, t1, x, u) > 0;
            GuardReport report;
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

}  // namespace
}  // namespace sim::testing
