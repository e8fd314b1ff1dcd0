#include "tests/sim/shapes/meshes.h"

#include "sim/core/check.h"
#include "sim/core/units.h"
#include "sim/shapes/triangle_tree.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>

namespace sim::test {
namespace {

double signedVolume(const TriangleMesh& mesh) { return TriangleTree(mesh).signedVolume(); }

/// Every edge is passed once in each direction.
bool isClosed(const TriangleMesh& mesh)
{
    std::map<std::pair<int, int>, int> edges;
    for (const Vec3i& t : mesh.triangles)
        for (int c = 0; c < 3; ++c) {
            const int a = t[c], b = t[(c + 1) % 3];
            edges[{std::min(a, b), std::max(a, b)}] += a < b ? 1 : 1000;
        }
    for (const auto& [edge, passes] : edges)
        if (passes != 1001) return false;
    return !edges.empty();
}

TEST(Tessellate, ABallIsClosedAndFacesOutward)
{
    const TriangleMesh mesh = ballMesh();
    EXPECT_TRUE(isClosed(mesh));
    EXPECT_NEAR(signedVolume(mesh) / (4.0 / 3.0 * kPi), 1.0, 0.01);
    EXPECT_NEAR(area(mesh) / (4.0 * kPi), 1.0, 0.01);
    for (const Vec3& v : mesh.vertices) EXPECT_NEAR(v.norm(), 1.0, 0.005);
}

TEST(Tessellate, ABoxHasTwelveTriangles)
{
    const TriangleMesh mesh = tessellate(Shape::box({1.0, 2.0, 3.0}, {0.5, 1.0, 1.5}), 0.1);
    EXPECT_EQ(mesh.triangles.size(), 12u);
    EXPECT_TRUE(isClosed(mesh));
    EXPECT_NEAR(signedVolume(mesh), 6.0, 1e-12);
}

TEST(Tessellate, BoundedShapesAreClosed)
{
    const Shape ball = Shape::ball(Vec3::Zero(), 1.0), box = Shape::box({0.5, 0.5, 0.5}, Vec3::Constant(0.5));
    const Eigen::Isometry3d turn(Eigen::AngleAxisd(0.4, Vec3::UnitZ()));
    for (const Shape& s : {Shape::subtract({ball, box}), Shape::unite({ball, box}), Shape::roundedBox(Vec3::Zero(), Vec3::Ones(), 0.25),
                           box.moved(turn), Shape::cylinder(Vec3::Zero(), Vec3::UnitZ(), 1.0, 0.5, 0.0)}) {
        const TriangleMesh mesh = tessellate(s, 0.125);
        EXPECT_TRUE(isClosed(mesh));
        EXPECT_GT(signedVolume(mesh), 0.5);
    }
}

TEST(Tessellate, ARoundedBoxIsClosedOnItsSurfaceAndFacesOutward)
{
    const double round = 0.3;
    const Shape shape = Shape::roundedBox({1.0, -2.0, 0.5}, {2.0, 1.0, 0.5}, round);
    const TriangleMesh mesh = tessellate(shape, 0.05);
    EXPECT_TRUE(isClosed(mesh));
    for (const Vec3& v : mesh.vertices) EXPECT_LT(std::abs(shape.distance(v)), 1.0e-12);
    // Box, three pairs of slabs on its sides, twelve quarters of cylinders and eight eighths of a ball; chords lose a little.
    const double slabs = 2.0 * round * (4.0 * 2.0 + 2.0 * 1.0 + 4.0 * 1.0), rods = kPi * round * round * (4.0 + 2.0 + 1.0);
    const double exact = 4.0 * 2.0 * 1.0 + slabs + rods + 4.0 / 3.0 * kPi * round * round * round;
    EXPECT_NEAR(signedVolume(mesh), exact, 5.0e-3 * exact);
}

TEST(Tessellate, RefusesTheUnbounded)
{
    EXPECT_THROW(tessellate(Shape::ball(Vec3::Zero(), 1.0).inverted(), 0.1), InputError);
    EXPECT_THROW(tessellate(Shape::unite({Shape::ball(Vec3::Zero(), 1.0), Shape::box(Vec3::Zero(), Vec3::Ones()).inverted()}), 0.1), InputError);
    EXPECT_TRUE(tessellate(Shape(), 0.1).triangles.empty());
}

TEST(TriangleTree, FindsTheNearestTriangleWhateverTheGuess)
{
    const TriangleMesh mesh = ballMesh();
    const TriangleTree tree(mesh);
    for (int p = 0; p < 500; ++p) {
        const Vec3 x = somePoint(p, 2.0);
        double nearest = std::abs(x.norm() - 1.0) + 0.01;  // the tessellated ball is no further from the true one
        EXPECT_LE(tree.nearest(x).distance, nearest);
        for (const Vec3& v : mesh.vertices) nearest = std::min(nearest, (v - x).norm());
        EXPECT_LE(tree.nearest(x).distance, nearest * (1.0 + 1.0e-14));  // round-off of two computations, where a corner is nearest
        EXPECT_GE(tree.nearest(x).distance, std::abs(x.norm() - 1.0) - 0.01);
        EXPECT_EQ(tree.nearest(x, p).distance, tree.nearest(x).distance);
    }
}

TEST(TriangleTree, KnowsFacesEdgesAndCornersOfABox)
{
    const Shape box = Shape::box(Vec3::Zero(), {1.0, 0.5, 0.8});
    const TriangleTree tree(tessellate(box, 0.1));
    for (int p = 0; p < 500; ++p) {
        const Vec3 x = somePoint(p, 2.0);
        EXPECT_NEAR(tree.nearest(x).distance, std::abs(box.distance(x)), 1e-12);
    }
}

TEST(TriangleTree, WindingNumberIsOneInside)
{
    const TriangleTree tree(ballMesh());
    for (int p = 0; p < 500; ++p) {
        const Vec3 x = somePoint(p, 1.5);
        if (std::abs(x.norm() - 1.0) < 0.01) continue;
        EXPECT_NEAR(tree.windingNumber(x), x.norm() < 1.0 ? 1.0 : 0.0, 0.06);
    }
}

}  // namespace
}  // namespace sim::test
