#include "app/frames/snapshot_fabric.h"
#include "app/frames/snapshot_from_state.h"

#include <gtest/gtest.h>

#include <cmath>

namespace {

using namespace app;
using sim::Vec3;

/// A yarn of three vertices along x, the last edge stretched by a fifth and turned by a quarter, and beside it one
/// face, stretched by a half along y.
struct YarnAndFace {
    YarnAndFace()
    {
        fabric.rest = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {0, 5, 0}, {1, 5, 0}, {0, 7, 0}};
        fabric.strands.begin = {0, 3};
        fabric.strands.vertices = {0, 1, 2};
        fabric.strands.material = {1};
        fabric.strands.radius = {{0.1, 0.2}};
        fabric.edges.vertices = {{0, 1}, {1, 2}};
        fabric.edges.strand = {0, 0};
        fabric.edges.restLength = {1.0, 1.0};
        fabric.faces.vertices = {{3, 4, 5}};
        fabric.faces.material = {2};
        fabric.faces.thickness = {0.3};
        state.fabric.x = fabric.rest;
        state.fabric.x[2].x() = 2.2;
        state.fabric.x[5].y() = 8.0;
        state.fabric.v.assign(6, Vec3(3, 4, 0));
        state.fabric.theta = {0.0, 0.5 * sim::kPi};
        state.fabric.tangent.assign(2, Vec3::UnitX());
        state.fabric.reference.assign(2, Vec3::UnitY());
        state.time = 0.5;
    }
    FrameSnapshot snapshot(FabricColorBy colorBy)
    {
        FrameSnapshot taken;
        fillSnapshot(state, fabric, nullptr, 1.0, {.yarns = colorBy, .cloth = colorBy}, taken);
        return taken;
    }
    sim::Fabric fabric;
    sim::State state;
};

TEST(SnapshotFabric, GeometryArrives)
{
    FrameSnapshot taken = YarnAndFace().snapshot(FabricColorBy::Material);
    const render::FrameView view = taken.view();
    ASSERT_EQ(3u, view.yarns.positions.size());
    EXPECT_FLOAT_EQ(2.2f, view.yarns.positions[2].x());
    EXPECT_EQ(3, view.yarns.begin[1]);
    EXPECT_EQ(1, view.yarns.materials[0]);
    EXPECT_FLOAT_EQ(0.2f, view.yarns.halfAxes[0][1]);
    EXPECT_FLOAT_EQ(2.0f, view.yarns.along[2]) << "at rest";
    ASSERT_EQ(1u, view.cloth.triangles.size());
    EXPECT_FLOAT_EQ(8.0f, view.cloth.positions[5].y());
    EXPECT_FLOAT_EQ(0.3f, view.cloth.thickness[4]);
    EXPECT_EQ(2, view.cloth.materials[3]);
    EXPECT_TRUE(view.yarns.values.empty());
    EXPECT_TRUE(view.cloth.values.empty());
}

/// Of its pores that are full; 0 where all is dry, for the colour bar has a lower end.
TEST(SnapshotFabric, SaturationIsTheFullPartOfThePores)
{
    YarnAndFace scene;
    EXPECT_EQ((std::vector<float>{0, 0, 0}), scene.snapshot(FabricColorBy::Saturation).yarns.values);
    scene.fabric.materials.resize(1);
    scene.fabric.materials[0].volumeFraction = 0.4;
    scene.fabric.vertexMaterial.assign(6, 0);
    scene.fabric.volume.assign(6, 2.0);
    scene.state.fabric.absorbed.assign(6, 0.0);
    const double capacity = poreVolume(scene.fabric, 1);
    EXPECT_GT(capacity, 0.0);
    scene.state.fabric.absorbed[1] = 0.25 * capacity;
    scene.state.fabric.absorbed[4] = 3.0 * capacity;
    const FrameSnapshot taken = scene.snapshot(FabricColorBy::Saturation);
    EXPECT_EQ((std::vector<float>{0, 0.25f, 0}), taken.yarns.values);
    EXPECT_EQ((std::vector<float>{0, 0.25f, 0, 0, 1, 0}), taken.cloth.values);
}

TEST(SnapshotFabric, DirectionsTurnWithTheMaterialFrames)
{
    const FrameSnapshot taken = YarnAndFace().snapshot(FabricColorBy::Material);
    const float half = std::sqrt(0.5f);
    EXPECT_TRUE(taken.yarns.directions[0].isApprox(Eigen::Vector3f(0, 1, 0), 1e-6f));
    EXPECT_TRUE(taken.yarns.directions[1].isApprox(Eigen::Vector3f(0, half, half), 1e-6f)) << "between its edges";
    EXPECT_LT((taken.yarns.directions[2] - Eigen::Vector3f(0, 0, 1)).norm(), 1e-6f);
}

TEST(SnapshotFabric, SpeedColorsEveryVertex)
{
    const FrameSnapshot taken = YarnAndFace().snapshot(FabricColorBy::Speed);
    EXPECT_EQ(std::vector<float>(3, 5.0f), taken.yarns.values);
    EXPECT_EQ(std::vector<float>(6, 5.0f), taken.cloth.values);
}

TEST(SnapshotFabric, StrainIsTheLargestStretchAtTheVertex)
{
    const FrameSnapshot taken = YarnAndFace().snapshot(FabricColorBy::Strain);
    EXPECT_NEAR(0.0, taken.yarns.values[0], 1e-6);
    EXPECT_NEAR(0.2, taken.yarns.values[1], 1e-6);
    EXPECT_NEAR(0.2, taken.yarns.values[2], 1e-6);
    EXPECT_NEAR(0.5, taken.cloth.values[4], 1e-6);
    EXPECT_EQ(0.0f, taken.cloth.values[0]) << "no face there";
}

TEST(SnapshotFabric, StrainDoesNotSeeARotation)
{
    YarnAndFace scene;
    const Eigen::Matrix3d turn = Eigen::AngleAxisd(1.0, Vec3(1, 2, 3).normalized()).toRotationMatrix();
    for (std::size_t v = 0; v < 6; ++v) scene.state.fabric.x[v] = turn * scene.fabric.rest[v];
    for (const float strain : scene.snapshot(FabricColorBy::Strain).cloth.values) EXPECT_NEAR(0.0, strain, 1e-6);
}

TEST(SnapshotFabric, NothingIsLeftOfAnEarlierFrame)
{
    YarnAndFace scene;
    FrameSnapshot taken = scene.snapshot(FabricColorBy::Speed);
    fillSnapshot(sim::State(), sim::Fabric(), nullptr, 1.0, {}, taken);
    const render::FrameView view = taken.view();
    EXPECT_TRUE(view.yarns.begin.empty());
    EXPECT_TRUE(view.yarns.positions.empty());
    EXPECT_TRUE(view.cloth.positions.empty());
    EXPECT_TRUE(view.cloth.triangles.empty());
}

}  // namespace
