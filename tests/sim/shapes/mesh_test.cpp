#include "sim/core/check.h"
#include "sim/core/random.h"
#include "sim/core/units.h"
#include "sim/shapes/obj.h"
#include "sim/shapes/shape.h"
#include "sim/shapes/tessellate.h"
#include "sim/shapes/triangle_tree.h"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <map>

namespace sim {
namespace {

Vec3 somePoint(std::uint64_t index, double half)
{
    const CounterRandom random(3, 0);
    return half * Vec3(2.0 * random.uniform(index, 0) - 1.0, 2.0 * random.uniform(index, 1) - 1.0,
                       2.0 * random.uniform(index, 2) - 1.0);
}

double signedVolume(const TriangleMesh& mesh)
{
    return TriangleTree(mesh).signedVolume();
}

double area(const TriangleMesh& mesh)
{
    double sum = 0.0;
    for (const Vec3i& t : mesh.triangles)
        sum +=
            0.5 * (mesh.vertices[t[1]] - mesh.vertices[t[0]]).cross(mesh.vertices[t[2]] - mesh.vertices[t[0]]).norm();
    return sum;
}

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

TriangleMesh ballMesh()
{
    return tessellate(Shape::ball(Vec3::Zero(), 1.0), 0.08);
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

TEST(Tessellate, WhateverIsBoundedIsClosed)
{
    const Shape ball = Shape::ball(Vec3::Zero(), 1.0), box = Shape::box({0.5, 0.5, 0.5}, Vec3::Constant(0.5));
    const Eigen::Isometry3d turn(Eigen::AngleAxisd(0.4, Vec3::UnitZ()));
    for (const Shape& s :
         {Shape::subtract({ball, box}), Shape::unite({ball, box}), Shape::roundedBox(Vec3::Zero(), Vec3::Ones(), 0.25),
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
    EXPECT_THROW(
        tessellate(Shape::unite({Shape::ball(Vec3::Zero(), 1.0), Shape::box(Vec3::Zero(), Vec3::Ones()).inverted()}),
                   0.1),
        InputError);
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

TEST(TriangleTree, WindsOnceAroundTheInside)
{
    const TriangleTree tree(ballMesh());
    for (int p = 0; p < 500; ++p) {
        const Vec3 x = somePoint(p, 1.5);
        if (std::abs(x.norm() - 1.0) < 0.01) continue;
        EXPECT_NEAR(tree.windingNumber(x), x.norm() < 1.0 ? 1.0 : 0.0, 0.06);
    }
}

void expectLikeTheBall(const Shape& shape, double tolerance)
{
    const Shape ball = Shape::ball(Vec3::Zero(), 1.0);
    for (int p = 0; p < 2000; ++p) {
        const Vec3 x = somePoint(p, 1.2);
        if (std::abs(ball.distance(x)) > 0.5) continue;
        EXPECT_NEAR(shape.distance(x), ball.distance(x), tolerance) << x.transpose();
    }
}

TEST(Mesh, OfABallIsLikeTheBall)
{
    const TriangleMesh mesh = ballMesh();
    const Shape shape = Shape::mesh(mesh.vertices, mesh.triangles, 0.06);
    expectLikeTheBall(shape, 0.006);
    for (int p = 0; p < 200; ++p) {
        const Vec3 x = somePoint(p, 2.0);
        if (x.norm() < 0.4) continue;
        const bool onLattice = x.cwiseAbs().maxCoeff() < 1.15;
        EXPECT_GT(shape.normal(x).dot(x.normalized()), onLattice ? 0.98 : 0.8) << x.transpose();
    }
    EXPECT_LT((shape.bounds().sizes() - Vec3::Constant(2.0)).cwiseAbs().maxCoeff(), 0.01);
}

TEST(Mesh, FarAwayTheDistanceIsNoLessThanTrue)
{
    const TriangleMesh mesh = ballMesh();
    const Shape shape = Shape::mesh(mesh.vertices, mesh.triangles, 0.1);
    for (int p = 0; p < 200; ++p) {
        const Vec3 x = somePoint(p, 6.0);
        if (x.norm() < 2.0) continue;
        EXPECT_GE(shape.distance(x), x.norm() - 1.01);
        EXPECT_LE(shape.distance(x), x.norm() + 1.0);
    }
}

TEST(Mesh, HolesDoubledAndTurnedFacesDoNotTurnItInsideOut)
{
    const TriangleMesh whole = ballMesh();
    std::vector<Vec3i> holed, doubled = whole.triangles, turned;
    for (std::size_t t = 0; t < whole.triangles.size(); ++t) {
        const Vec3i& c = whole.triangles[t];
        if (t % 50 != 0) holed.push_back(c);
        if (t % 3 == 0) doubled.push_back(c);
        turned.emplace_back(c[0], c[2], c[1]);
    }
    expectLikeTheBall(Shape::mesh(whole.vertices, doubled, 0.1), 0.012);
    expectLikeTheBall(Shape::mesh(whole.vertices, turned, 0.1), 0.012);
    const Shape shape = Shape::mesh(whole.vertices, holed, 0.1);
    for (int p = 0; p < 2000; ++p) {
        const Vec3 x = somePoint(p, 1.5);
        if (std::abs(x.norm() - 1.0) < 0.15) continue;
        EXPECT_EQ(shape.distance(x) < 0.0, x.norm() < 1.0) << x.transpose();
    }
}

/// A cube of side 2 whose sides have been cut and turned anyhow.
TriangleMesh cubeMesh(int variant)
{
    TriangleMesh mesh = tessellate(Shape::box(Vec3::Zero(), Vec3::Ones()), 0.1);
    const CounterRandom random(29, static_cast<std::uint64_t>(variant));
    const Eigen::AngleAxisd turn(6.0 * random.uniform(0, 0), somePoint(static_cast<std::uint64_t>(variant), 1.0).normalized());
    for (Vec3& v : mesh.vertices) v = turn * v;
    return mesh;
}

/// Each triangle has corners of its own.
TriangleMesh soupOf(const TriangleMesh& mesh)
{
    TriangleMesh soup;
    for (const Vec3i& t : mesh.triangles) {
        for (const int corner : t) soup.vertices.push_back(mesh.vertices[corner]);
        const int n = static_cast<int>(soup.vertices.size());
        soup.triangles.emplace_back(n - 3, n - 2, n - 1);
    }
    return soup;
}

TEST(Mesh, FacesTurnedAtRandomDoubledAndUnsharedAreTheSameSolid)
{
    for (int variant = 0; variant < 20; ++variant) {
        const TriangleMesh whole = cubeMesh(variant);
        const Shape sound = Shape::mesh(whole.vertices, whole.triangles, 0.2);
        const CounterRandom random(31, static_cast<std::uint64_t>(variant));
        TriangleMesh turned = whole, doubled = whole;
        for (std::size_t t = 0; t < whole.triangles.size(); ++t) {
            if (random.uniform(t, 0) < 0.5) std::swap(turned.triangles[t][0], turned.triangles[t][1]);
            if (random.uniform(t, 1) < 0.5) doubled.triangles.push_back(turned.triangles[t]);
        }
        for (const TriangleMesh& mesh : {turned, doubled, soupOf(turned), soupOf(doubled)}) {
            std::vector<std::string> notes;
            const Shape mended = Shape::mesh(mesh.vertices, mesh.triangles, 0.2, &notes);
            for (int p = 0; p < 200; ++p) {
                const Vec3 x = somePoint(static_cast<std::uint64_t>(p), 2.0);
                ASSERT_NEAR(mended.distance(x), sound.distance(x), 1.0e-5) << variant << ": " << x.transpose();
            }
            EXPECT_EQ(notes.size(), 1u) << variant;
        }
    }
}

/// Parts are turned outward one by one; a cavity stays one.
TEST(Mesh, EveryPartIsASolidAndACavityStays)
{
    const TriangleMesh cube = cubeMesh(3);
    const auto add = [](TriangleMesh& mesh, const TriangleMesh& part, double scale, const Vec3& shift, bool isTurned) {
        const int first = static_cast<int>(mesh.vertices.size());
        for (const Vec3& v : part.vertices) mesh.vertices.push_back(scale * v + shift);
        for (const Vec3i& t : part.triangles) {
            const Vec3i face = t.array() + first;
            mesh.triangles.push_back(isTurned ? Vec3i(face[0], face[2], face[1]) : face);
        }
    };
    for (int turns = 0; turns < 4; ++turns) {
        TriangleMesh mesh;
        const bool first = turns & 1, second = turns & 2;
        add(mesh, cube, 1.0, Vec3::Zero(), first);
        add(mesh, cube, 0.5, Vec3::Zero(), !first);  // a cavity
        add(mesh, cube, 1.0, {5.0, 0.0, 0.0}, second);
        const Shape shape = Shape::mesh(mesh.vertices, mesh.triangles, 0.1);
        EXPECT_GT(shape.distance(Vec3::Zero()), 0.3) << turns;
        EXPECT_LT(shape.distance({0.75, 0.0, 0.0}), 0.5) << turns;
        EXPECT_LT(shape.distance({5.0, 0.0, 0.0}), -0.8) << turns;
    }
}

std::string refusalOf(const TriangleMesh& mesh)
{
    try {
        Shape::mesh(mesh.vertices, mesh.triangles, 0.1);
    } catch (const InputError& error) {
        return error.what();
    }
    return "none";
}

TEST(Mesh, OpenOnesAreRefusedWhereTheyAreOpen)
{
    for (int variant = 0; variant < 20; ++variant) {
        TriangleMesh mesh = cubeMesh(variant);
        mesh.triangles.erase(mesh.triangles.begin() + variant % 12);
        EXPECT_NE(refusalOf(mesh).find("not closed"), std::string::npos) << refusalOf(mesh);
        EXPECT_NE(refusalOf(mesh).find("at the edge from vertex "), std::string::npos) << refusalOf(mesh);
        TriangleMesh flat{mesh.vertices, {mesh.triangles[0]}};
        EXPECT_NE(refusalOf(flat).find("not closed"), std::string::npos) << "one face";
        for (Vec3& v : flat.vertices) v *= 0.01;
        EXPECT_NE(refusalOf(flat).find("not closed"), std::string::npos) << "however small";
    }
}

TEST(Mesh, WallsInsideAndOneSidedSurfacesAreRefused)
{
    TriangleMesh fin = cubeMesh(1);
    fin.vertices.push_back({9.0, 9.0, 9.0});
    fin.triangles.emplace_back(fin.triangles[0][0], fin.triangles[0][1], static_cast<int>(fin.vertices.size()) - 1);
    EXPECT_NE(refusalOf(fin), "none");
    // The projective plane of six vertices: closed, and of one side.
    TriangleMesh oneSided;
    for (std::uint64_t v = 0; v < 6; ++v) oneSided.vertices.push_back(somePoint(v, 1.0));
    oneSided.triangles = {{0, 1, 2}, {0, 2, 3}, {0, 3, 4}, {0, 4, 5}, {0, 5, 1}, {1, 2, 4}, {2, 3, 5}, {3, 4, 1}, {4, 5, 2}, {5, 1, 3}};
    EXPECT_NE(refusalOf(oneSided).find("one side only"), std::string::npos) << refusalOf(oneSided);
}

TEST(Mesh, RefusesWhatItCannotSample)
{
    const TriangleMesh mesh = ballMesh();
    EXPECT_THROW(Shape::mesh(mesh.vertices, mesh.triangles, 1.0e-3), InputError);
    EXPECT_THROW(Shape::mesh(mesh.vertices, mesh.triangles, 0.0), InputError);
    EXPECT_THROW(Shape::mesh(mesh.vertices, {Vec3i(0, 1, 1000000)}, 0.1), InputError);
    EXPECT_THROW(Shape::mesh(mesh.vertices, {Vec3i(0, 1, 1)}, 0.1), InputError);
    EXPECT_THROW(Shape::mesh({}, {}, 0.1), InputError);
}

class Obj : public ::testing::Test {
 protected:
    std::filesystem::path write(const std::string& text)
    {
        const auto file = std::filesystem::path(::testing::TempDir()) /
                          (std::string(::testing::UnitTest::GetInstance()->current_test_info()->name()) + ".obj");
        std::ofstream(file) << text;
        return file;
    }
    std::string errorOf(const std::string& text)
    {
        try {
            readObj(write(text));
        } catch (const InputError& e) {
            return e.what();
        }
        return "no error";
    }
};

constexpr const char* kCube =
    "# a cube\nmtllib some.mtl\no cube\n"
    "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 1 0 1\nv 1 1 1\nv 0 1 1\nvn 0 0 1\nvt 0 0\n"
    "f 4 3 2 1\nf 5/1 6/1 7/1 8/1\r\nf 1//1 2//1 6//1 5//1\nf -6/1/1 -5/1/1 -1/1/1 -2/1/1 # top\n\tf 2 3 7 6\nf 1 5 8 "
    "4\n";

TEST_F(Obj, ReadsFacesInAllTheirForms)
{
    const TriangleMesh mesh = readObj(write(kCube));
    EXPECT_EQ(mesh.vertices.size(), 8u);
    EXPECT_EQ(mesh.triangles.size(), 12u);
    EXPECT_EQ(mesh.triangles[0], Vec3i(3, 2, 1));
    EXPECT_EQ(mesh.triangles[1], Vec3i(3, 1, 0));
    EXPECT_EQ(mesh.triangles[6], Vec3i(2, 3, 7));
}

TEST_F(Obj, BecomesAShapeThatStaysWhereItIs)
{
    const Shape cube = shapeFromObj(write(kCube), 2.0, 0.1);
    EXPECT_NEAR(cube.distance(Vec3::Ones()), -1.0, 0.05);
    EXPECT_NEAR(cube.distance({-0.2, 1.0, 1.0}), 0.2, 0.01);
    EXPECT_NEAR(cube.distance({2.1, 1.0, 1.0}), 0.1, 0.01);
}

TEST_F(Obj, ReadsWhatOtherProgramsWrite)
{
    const TriangleMesh plain = readObj(write(kCube));
    const auto expectSame = [&](const std::string& text, const char* what) {
        const TriangleMesh mesh = readObj(write(text));
        EXPECT_EQ(mesh.vertices, plain.vertices) << what;
        EXPECT_EQ(mesh.triangles, plain.triangles) << what;
    };
    const auto replaced = [](std::string text, const std::string& from, const std::string& to) {
        for (std::size_t at = text.find(from); at != std::string::npos; at = text.find(from, at + to.size())) text.replace(at, from.size(), to);
        return text;
    };
    const std::string lf = replaced(kCube, "\r\n", "\n");
    expectSame("\xEF\xBB\xBF" + replaced(lf, "# a cube\nmtllib some.mtl\no cube\n", ""), "a byte-order mark before the first vertex");
    expectSame(replaced(lf, "\n", "\r"), "CR");
    expectSame(replaced(lf, "\n", "\r\n"), "CR and LF");
    expectSame(replaced(lf, " 1", " +1"), "plus signs");
    expectSame(replaced(lf, "f 4 3", "f 4 \\\n3"), "a line that goes on");
    expectSame(replaced(lf, "v 1 1 1", "v 1 \\\r\n 1 \\\r\n 1"), "a line that goes on twice");
    EXPECT_NE(errorOf("v 0 0 \\\n0\nv 0 +x 0\n").find(".obj:3: not a number: \"+x\""), std::string::npos);
    EXPECT_NE(errorOf("v 0 0 0\rv 0 +-1 0\r").find(".obj:2: not a number"), std::string::npos);
}

/// Whatever star is read, turned anyhow and begun at any corner, its triangles cover it once: areas add up to its own
/// and none is turned over.
TEST_F(Obj, PolygonsAreCoveredOnceWhereverTheyAreConcave)
{
    const CounterRandom random(11, 0);
    for (std::uint64_t n = 0; n < 200; ++n) {
        const int count = 4 + static_cast<int>(n % 9);
        const Eigen::AngleAxisd turn(2.0 * kPi * random.uniform(n, 0), somePoint(n, 1.0).normalized());
        std::string text, face = "f";
        std::vector<Vec3> points;
        for (int c = 0; c < count; ++c) {
            const double angle = 2.0 * kPi * c / count, radius = 0.2 + random.uniform(n, 10 + static_cast<std::uint64_t>(c));
            points.push_back(turn * Vec3(radius * std::cos(angle), radius * std::sin(angle), 0.0));
            char line[128];
            std::snprintf(line, sizeof line, "v %.17g %.17g %.17g\n", points.back()[0], points.back()[1], points.back()[2]);
            text += line;
            face += " " + std::to_string((c + static_cast<int>(n)) % count + 1);
        }
        // Around its centre a star is a fan, whose sum is its area.
        Vec3 exact = Vec3::Zero();
        for (int c = 0; c < count; ++c) exact += 0.5 * points[c].cross(points[(c + 1) % count]);
        const std::string header = text;
        const TriangleMesh mesh = readObj(write(header + face + "\n"));
        ASSERT_EQ(mesh.triangles.size(), static_cast<std::size_t>(count - 2));
        EXPECT_NEAR(area(mesh), exact.norm(), 1.0e-12) << n;
    }
}

TEST_F(Obj, SaysWhereAFileIsWrong)
{
    const std::string corners = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
    EXPECT_NE(errorOf("v 0 0\n").find(".obj:1: a vertex needs three"), std::string::npos);
    EXPECT_NE(errorOf("v 0 0 0\nv 0 x 0\n").find(".obj:2: not a number: \"x\""), std::string::npos);
    EXPECT_NE(errorOf("v 0 0 nan\n").find("not a finite number"), std::string::npos);
    EXPECT_NE(errorOf("v 0 0 1e999\n").find(".obj:1: not"), std::string::npos);
    EXPECT_NE(errorOf(corners + "f 1 2 4\n").find(".obj:4: vertex 4 does not exist"), std::string::npos);
    EXPECT_NE(errorOf(corners + "f 1 2 0\n").find(".obj:4: vertex 0"), std::string::npos);
    EXPECT_NE(errorOf(corners + "f 1 2 -4\n").find(".obj:4: vertex -4"), std::string::npos);
    EXPECT_NE(errorOf(corners + "f 1 2\n").find(".obj:4: a face needs three"), std::string::npos);
    EXPECT_NE(errorOf(corners + "f 1 2 c\n").find(".obj:4: not a corner: \"c\""), std::string::npos);
    EXPECT_NE(errorOf(corners).find("has no faces"), std::string::npos);
    EXPECT_THROW(readObj("there/is/no/such/file.obj"), InputError);
    EXPECT_THROW(readObj(::testing::TempDir()), InputError);
}

}  // namespace
}  // namespace sim
