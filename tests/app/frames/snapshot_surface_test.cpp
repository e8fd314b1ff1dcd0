#include "app/frames/snapshot_surface.h"

#include "app/frames/sample_pressure.h"
#include "app/frames/snapshot_from_state.h"

#include <gtest/gtest.h>

namespace app::test {
namespace {

using sim::Vec3;
using sim::Vec3i;

/// A cube of water of 8³ particles that rises at 7 cm/s, in a block with a pressure of 50 dyn/cm² per cm of height.
struct Cube {
    Cube()
    {
        state.grid.dx = 0.5;
        state.grid.setBlocks(std::array{Vec3i(0, 0, 0)});
        state.pressure.resize(1);
        state.step = 1;
        for (int c = 0; c < sim::kBlockCells; ++c) state.pressure.block(0)[c] = 50.0 * state.grid.dx * ((c >> 3 & 7) + 0.5);
        for (int n = 0; n < 512; ++n)
            state.liquid.add(Vec3::Constant(1.0) + 0.25 * Vec3(n & 7, n >> 3 & 7, n >> 6), 0.25 * 0.25 * 0.25, n, {0, 7, 0});
    }
    sim::State state;
};

TEST(SnapshotSurface, IsThereWhereItIsAskedFor)
{
    const Cube cube;
    FrameSnapshot snapshot;
    fillSnapshot(cube.state, {}, nullptr, 1.0, {.surface = true}, snapshot);
    const FrameSnapshot::Surface& surface = snapshot.surface;
    ASSERT_GT(surface.triangles.size(), 200u);
    ASSERT_EQ(surface.positions.size(), surface.normals.size());
    ASSERT_EQ(surface.positions.size(), surface.values.size());
    for (std::size_t v = 0; v < surface.values.size(); ++v) {
        EXPECT_NEAR(surface.values[v], 7.0f, 0.01f);
        EXPECT_NEAR(surface.normals[v].norm(), 1.0f, 1.0e-5f);
        EXPECT_LT((surface.positions[v] - Eigen::Vector3f::Constant(1.875f)).cwiseAbs().maxCoeff(), 1.2f);
    }
    EXPECT_EQ(snapshot.view().surface.triangles.data(), surface.triangles.data());
    fillSnapshot(cube.state, {}, nullptr, 1.0, {}, snapshot);
    EXPECT_TRUE(surface.positions.empty() && surface.normals.empty() && surface.values.empty() && surface.triangles.empty());
}

TEST(SnapshotSurface, ValuesArePressuresWhereTheyAreAskedFor)
{
    const Cube cube;
    FrameSnapshot::Surface surface;
    takeSurface(cube.state, 1.0, {.pressure = true, .surface = true}, surface);
    ASSERT_GT(surface.values.size(), 100u);
    for (std::size_t v = 0; v < surface.values.size(); ++v) EXPECT_NEAR(surface.values[v], 50.0f * surface.positions[v].y(), 0.01f);
}

}  // namespace
}  // namespace app::test
