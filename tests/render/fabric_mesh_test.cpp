#include "render/cloth_mesh.h"
#include "render/tube_mesh.h"
#include "tests/render/fake_fabric.h"

#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include <cmath>
#include <map>
#include <numbers>
#include <stdexcept>

namespace {

using namespace render;
using Eigen::Vector3f;

const TubeColor kBlack = [](float) { return std::array<std::uint8_t, 4>{0, 0, 0, 255}; };
const TubeDetail kNear = {.eye = {0.0f, 0.0f, 10.0f}, .pixelsPerTangent = 1000.0f, .sides = 24};

/// Volume inside, positive if triangles face outwards.
template <class Mesh>
double volume(const Mesh& mesh)
{
    double sum = 0.0;
    for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
        const auto corner = [&](std::size_t k) { return mesh.vertices[mesh.indices[i + k]].position.template cast<double>().eval(); };
        sum += corner(0).dot(corner(1).cross(corner(2))) / 6.0;
    }
    return sum;
}

/// Every edge is met once in each direction, corners at one place counted as one: no hole.
template <class Mesh>
bool isClosed(const Mesh& mesh)
{
    std::map<std::array<long, 6>, int> balance;
    const auto place = [&](std::uint32_t v) { return (1.0e4f * mesh.vertices[v].position).array().round().template cast<long>().eval(); };
    for (std::size_t i = 0; i < mesh.indices.size(); i += 3)
        for (std::size_t k = 0; k < 3; ++k) {
            const auto a = place(mesh.indices[i + k]), b = place(mesh.indices[i + (k + 1) % 3]);
            ++balance[{a[0], a[1], a[2], b[0], b[1], b[2]}];
            --balance[{b[0], b[1], b[2], a[0], a[1], a[2]}];
        }
    return std::ranges::all_of(balance, [](const auto& edge) { return edge.second == 0; });
}

FakeYarns helix(int vertices, float a, float b)
{
    FakeYarns yarns;
    for (int i = 0; i < vertices; ++i) {
        const float t = 6.0f * static_cast<float>(i) / static_cast<float>(vertices - 1);
        yarns.add({std::cos(t), 0.3f * t, std::sin(t)}, {std::cos(t), 0.0f, std::sin(t)});
    }
    yarns.endStrand(a, b);
    return yarns;
}

TEST(TubeMesh, IsAClosedBodyOfTheVolumeOfItsEllipse)
{
    const FakeYarns yarns = helix(40, 0.1f, 0.05f);
    TubeMesh mesh;
    addTube(yarns.view(), 0, kNear, kBlack, mesh);
    EXPECT_TRUE(isClosed(mesh));
    const double length = 6.0 * std::hypot(1.0, 0.3), caps = 4.0 / 3.0 * std::numbers::pi * 0.1 * 0.05 * 0.05;
    const double expected = std::numbers::pi * 0.1 * 0.05 * length + caps;
    EXPECT_NEAR(volume(mesh), expected, 0.02 * expected);
}

TEST(TubeMesh, IsRoundBetweenFewVertices)
{
    // A circle of 12 vertices: without bends the middles of edges would be 3.4 % inside of it.
    FakeYarns yarns;
    for (int i = 0; i <= 12; ++i) {
        const float t = std::numbers::pi_v<float> / 6.0f * static_cast<float>(i);
        yarns.add({std::cos(t), std::sin(t), 0.0f}, Vector3f::UnitZ());
    }
    yarns.endStrand(0.01f, 0.01f);
    TubeMesh mesh;
    addTube(yarns.view(), 0, kNear, kBlack, mesh);
    const float middle = std::cos(std::numbers::pi_v<float> / 12.0f);
    for (const auto& v : mesh.vertices) EXPECT_GT(v.position.head<2>().norm(), middle + 0.01f);
}

TEST(TubeMesh, NormalsStandOnTheEllipse)
{
    FakeYarns yarns;
    for (int i = 0; i < 3; ++i) yarns.add({static_cast<float>(i), 0.0f, 0.0f}, Vector3f::UnitY());
    yarns.endStrand(0.2f, 0.1f);
    TubeMesh mesh;
    addTube(yarns.view(), 0, kNear, kBlack, mesh);
    for (const auto& v : mesh.vertices) {
        if (v.position.x() < 0.001f || v.position.x() > 1.999f) continue;
        const Vector3f gradient(0.0f, v.position.y() / 0.04f, v.position.z() / 0.01f);
        EXPECT_GT(v.normal.dot(gradient.normalized()), 0.9999f);
    }
}

TEST(TubeMesh, IsCoarseWhereItIsSmallInThePicture)
{
    const FakeYarns yarns = helix(40, 0.1f, 0.1f);
    TubeMesh near, far;
    addTube(yarns.view(), 0, kNear, kBlack, near);
    TubeDetail away = kNear;
    away.eye *= 100.0f;
    addTube(yarns.view(), 0, away, kBlack, far);
    EXPECT_FALSE(isThin(yarns.view(), 0, kNear));
    EXPECT_TRUE(isThin(yarns.view(), 0, away));
    EXPECT_LT(5 * far.indices.size(), near.indices.size());
    EXPECT_TRUE(isClosed(far));
}

TEST(TubeMesh, NothingComesOfAStrandWithoutExtent)
{
    FakeYarns yarns;
    yarns.add({0.0f, 0.0f, 0.0f}, Vector3f::UnitY());
    yarns.endStrand(0.1f, 0.1f);
    yarns.add({0.0f, 0.0f, 0.0f}, Vector3f::UnitY());
    yarns.add({1.0f, 0.0f, 0.0f}, Vector3f::UnitY());
    yarns.endStrand(0.0f, 0.1f);
    yarns.add({0.0f, 0.0f, 0.0f}, Vector3f::UnitY());
    yarns.add({std::nanf(""), 0.0f, 0.0f}, Vector3f::UnitY());
    yarns.endStrand(0.1f, 0.1f);
    TubeMesh mesh;
    for (int s = 0; s < 3; ++s) addTube(yarns.view(), s, kNear, kBlack, mesh);
    EXPECT_TRUE(mesh.indices.empty());
}

TEST(ClothMesh, IsAClosedBodyOfItsThickness)
{
    FakeDrape drape(20, 4.0f, 0.1f);
    for (Vector3f& x : drape.positions) x.y() = 0.0f;  // flat again …
    for (int i = 0; i < 400; ++i) drape.positions[i] = {0.2f * static_cast<float>(i % 20), 0.0f, 0.2f * static_cast<float>(i / 20)};
    ClothMesh mesh;
    makeClothMesh(drape.cloth(), mesh);
    EXPECT_TRUE(isClosed(mesh));
    EXPECT_NEAR(std::abs(volume(mesh)), 3.8 * 3.8 * 0.1, 1e-3);  // … a plate
    EXPECT_EQ(mesh.indices.size(), 3u * (2u * 2u * 19u * 19u + 2u * 4u * 19u));
}

TEST(ClothMesh, NormalsAreSmooth)
{
    const FakeDrape drape(40);
    ClothMesh mesh;
    makeClothMesh(drape.cloth(), mesh);
    // On the ball they point from its middle.
    int onBall = 0;
    for (const auto& v : mesh.vertices)
        if (!v.isBack && v.position.y() > 1.6f) {
            EXPECT_GT(v.normal.dot(v.position.normalized()), 0.999f);
            ++onBall;
        }
    EXPECT_GT(onBall, 50);
}

TEST(ClothMesh, RefusesCornersThatAreNotThere)
{
    FakeDrape drape(3);
    drape.triangles.push_back({0, 1, 9});
    ClothMesh mesh;
    EXPECT_THROW(makeClothMesh(drape.cloth(), mesh), std::invalid_argument);
}

}  // namespace
