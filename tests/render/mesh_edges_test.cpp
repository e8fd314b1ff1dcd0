#include "render/mesh_edges.h"

#include "tests/render/drawing.h"
#include "tests/render/fake_dam_break.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace {

using namespace render;
using Eigen::Vector3f;

long sharpEdges(const MeshEdges& outline) { return std::ranges::count_if(outline.edges, &MeshEdges::Edge::isSharp); }

TEST(MeshEdges, CubeHasTwelve)
{
    const CubeMesh cube(1.0f);
    const MeshEdges outline = meshEdges(cube.mesh(false));
    EXPECT_EQ(outline.edges.size(), 12u);
    EXPECT_EQ(sharpEdges(outline), 12);
    for (const MeshEdges::Edge& e : outline.edges) EXPECT_NEAR((e.a - e.b).norm(), 2.0f, 1e-6f);
}

TEST(MeshEdges, CornersAtOnePlaceCountAsOne)
{
    const CubeMesh cube(1.0f);
    std::vector<Vector3f> soup;
    std::vector<Eigen::Vector3i> triangles;
    for (const Eigen::Vector3i& t : cube.triangles) {
        const int first = static_cast<int>(soup.size());
        for (int k = 0; k < 3; ++k) soup.push_back(cube.positions[t[k]]);
        triangles.emplace_back(first, first + 1, first + 2);
    }
    EXPECT_EQ(meshEdges({soup, triangles, false}).edges.size(), 12u);
}

TEST(MeshEdges, RoundedBoxHasNoSharpEdgeAndBendsOnlyInItsRoundings)
{
    std::vector<Vector3f> positions;
    std::vector<Eigen::Vector3i> triangles;
    addRoundedBox({-10, -10, -2}, {10, 10, 2}, 0.7f, 5, positions, triangles);
    const MeshEdges outline = meshEdges({positions, triangles, false});
    EXPECT_EQ(sharpEdges(outline), 0);
    ASSERT_EQ(outline.bend.size(), triangles.size());
    int bent = 0;
    for (std::size_t t = 0; t < triangles.size(); ++t) {
        const auto corner = [&](int k) { return positions[triangles[t][k]]; };
        const float area = 0.5f * (corner(1) - corner(0)).cross(corner(2) - corner(0)).norm();
        EXPECT_TRUE(area < 10.0f || outline.bend[t] < 3.0f) << "a flat wall bends";
        bent += outline.bend[t] > 16.0f;
    }
    EXPECT_GT(bent, 100);
}

TEST(MeshEdges, NormalsAreSmoothAcrossRoundingsAndBreakAtCreases)
{
    const CubeMesh cube(1.0f);
    const MeshEdges outline = meshEdges(cube.mesh(false));
    for (const auto& corners : outline.cornerNormals)
        for (const Vector3f& normal : corners) {
            EXPECT_NEAR(normal.cwiseAbs().maxCoeff(), 1.0f, 1e-5f) << "a cube's normals stay those of its faces";
        }
}

TEST(MeshEdges, BorderOfAnOpenSheetIsSharp)
{
    const std::vector<Vector3f> positions = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
    const std::vector<Eigen::Vector3i> triangles = {{0, 1, 2}, {0, 2, 3}};
    EXPECT_EQ(meshEdges({positions, triangles, false}).edges.size(), 4u);
}

}  // namespace
