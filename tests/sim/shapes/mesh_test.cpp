#include "tests/sim/shapes/meshes.h"

#include "sim/core/check.h"
#include "sim/shapes/shape.h"

#include <gtest/gtest.h>

#include <cmath>

namespace sim::test {
namespace {

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

}  // namespace
}  // namespace sim::test
