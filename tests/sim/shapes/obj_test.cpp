#include "tests/sim/shapes/meshes.h"

#include "sim/core/check.h"
#include "sim/core/units.h"
#include "sim/shapes/obj.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>

namespace sim::test {
namespace {

class Obj : public ::testing::Test {
 protected:
    std::filesystem::path write(const std::string& text)
    {
        const auto file =
            std::filesystem::path(::testing::TempDir()) / (std::string(::testing::UnitTest::GetInstance()->current_test_info()->name()) + ".obj");
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
}  // namespace sim::test
