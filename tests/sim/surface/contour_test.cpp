#include "sim/surface/contour.h"
#include "sim/surface/cube_cases.h"

#include "tests/sim/surface/bodies.h"

#include <gtest/gtest.h>

#include <set>

namespace sim::test {
namespace {

/// A cube of 3³ blocks of cells of 0.1 cm about the origin, nodes −8 … 15 along each axis.
struct Field {
    Field()
    {
        grid.dx = 0.1;
        std::vector<Vec3i> coords;
        for (int n = 0; n < 27; ++n) coords.emplace_back(n % 3 - 1, n / 3 % 3 - 1, n / 9 - 1);
        grid.setBlocks(coords);
        values.resize(grid.count());
    }
    /// value(node, place [cm]) at all nodes but the outermost ones, which stay at 0.
    template <class Value>
    void fill(Value&& value)
    {
        for (int b = 0; b < grid.count(); ++b)
            for (int c = 0; c < kBlockCells; ++c) {
                const Vec3i node = kBlockEdge * grid.coords(b) + Vec3i(c & 7, c >> 3 & 7, c >> 6);
                const bool isOuter = node.minCoeff() == -kBlockEdge || node.maxCoeff() == 2 * kBlockEdge - 1;
                values.block(b)[c] = isOuter ? 0.0f : static_cast<float>(value(node, grid.dx * node.cast<double>()));
            }
    }
    BlockGrid grid;
    BlockArray<float> values;
    Contour contour;
    SurfaceMesh mesh;
};

/// Whichever nodes are inside, every edge has two triangles. At random they make all 256 cases, side by side with
/// others.
TEST(Contour, IsAClosedManifoldWhicheverNodesAreInside)
{
    Field field;
    std::mt19937 random(3);
    std::uniform_real_distribution<double> unit(0.0, 2.0);
    field.fill([&](const Vec3i&, const Vec3&) { return unit(random); });
    field.contour.extract(field.grid, field.values, 1.0f, field.mesh);
    EXPECT_GT(field.mesh.triangles.size(), 20000u);
    EXPECT_TRUE(isClosed(field.mesh));
    EXPECT_GT(enclosedVolume(field.mesh), 0.0);
}

/// Corners that are inside and meet across the diagonal of a face belong to two bodies.
TEST(Contour, KeepsDiagonalNeighboursApart)
{
    Field field;
    field.fill([](const Vec3i& n, const Vec3&) { return n == Vec3i(7, 7, 7) || n == Vec3i(8, 8, 7) ? 1.5 : 0.5; });
    field.contour.extract(field.grid, field.values, 1.0f, field.mesh);
    EXPECT_EQ(12u, field.mesh.positions.size());
    EXPECT_EQ(16u, field.mesh.triangles.size());
    EXPECT_EQ(4, eulerCharacteristic(field.mesh));
}

TEST(Contour, OfADistanceIsItsSphere)
{
    constexpr double kRadius = 0.53;
    const Vec3 center(0.31, 0.36, 0.42);
    Field field;
    field.fill([&](const Vec3i&, const Vec3& x) { return std::max(0.0, 2.0 - (x - center).norm()); });
    field.contour.extract(field.grid, field.values, static_cast<float>(2.0 - kRadius), field.mesh);
    std::vector<Vec3> normals;
    findNormals(field.grid, field.values, field.contour.crossings(), normals);
    ASSERT_GT(field.mesh.positions.size(), 500u);
    EXPECT_EQ(2, eulerCharacteristic(field.mesh));
    for (std::size_t v = 0; v < normals.size(); ++v) {
        const Vec3 away = field.mesh.positions[v] - center;
        // A distance is linear along an edge up to edge² / (8 R), and its differences are exact up to the same power.
        EXPECT_NEAR(kRadius, away.norm(), 0.01 / (8.0 * kRadius));
        EXPECT_GT(normals[v].dot(away.normalized()), 0.999);
    }
    // Triangles lie below the sphere by up to h²/(8 R) of the radius and that twice, since theirs are up to √2 h long.
    const double volume = 4.0 / 3.0 * kPi * std::pow(kRadius, 3);
    EXPECT_LT(enclosedVolume(field.mesh), volume);
    EXPECT_GT(enclosedVolume(field.mesh), (1.0 - 3.0 * 0.02 / (8.0 * kRadius * kRadius)) * volume);
}

TEST(Contour, IsNothingWhereAllIsOutside)
{
    Field field;
    field.fill([](const Vec3i&, const Vec3&) { return 0.5; });
    field.contour.extract(field.grid, field.values, 1.0f, field.mesh);
    EXPECT_TRUE(field.mesh.positions.empty() && field.mesh.triangles.empty());
}

/// Turned inside out a case cuts the same edges, though faces with diagonal neighbours are cut the other way.
TEST(CubeCases, UseTheCutEdgesAndNoOthers)
{
    for (int inside = 0; inside < 256; ++inside) {
        const CubeCase& cube = cubeCases()[inside];
        std::set<int> used;
        for (int t = 0; t < cube.count; ++t) used.insert(cube.triangles[t].begin(), cube.triangles[t].end());
        for (int e = 0; e < 12; ++e) {
            const auto [axis, corner] = kCubeEdges[e];
            const bool isCut = (inside >> corner & 1) != (inside >> (corner | 1 << axis) & 1);
            EXPECT_EQ(isCut, used.contains(e)) << "case " << inside << ", edge " << e;
        }
    }
}

}  // namespace
}  // namespace sim::test
