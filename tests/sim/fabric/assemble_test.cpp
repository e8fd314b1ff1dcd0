#include "sim/core/check.h"
#include "sim/fabric/fabric.h"
#include "sim/fabric/pieces/generators.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

namespace {

using sim::Fabric;
using sim::FabricPiece;
using sim::FabricState;
using sim::kPi;
using sim::Vec2i;
using sim::Vec3;

constexpr double kDensity = 1.32, kFraction = 0.4;

FabricPiece pieceOf(const sim::FabricGeometry& geometry, double a, double b)
{
    FabricPiece piece;
    piece.name = "piece";
    piece.material.young = 1.0e6;
    piece.material.density = kDensity;
    piece.material.volumeFraction = kFraction;
    piece.radius = {a, b};
    piece.points = geometry.points;
    piece.strands = geometry.strands;
    piece.faces = geometry.faces;
    return piece;
}

Fabric assemble(const FabricPiece& piece) { return sim::assembleFabric({&piece, 1}); }

double total(const std::vector<double>& values) { return std::accumulate(values.begin(), values.end(), 0.0); }

FabricPiece cloth() { return pieceOf(sim::clothGrid({.nodes = {11, 6}, .spacing = {0.1, 0.2}}), 0.0165, 0.018); }

FabricPiece yarnSheet() { return pieceOf(sim::wovenYarns({.yarns = {20, 30}, .spacing = 0.144, .amplitude = 0.072}), 0.048, 0.018); }

FabricPiece helix()
{
    std::vector<Vec3> points;
    for (int i = 0; i < 40; ++i) points.emplace_back(std::cos(0.3 * i), 0.1 * i, std::sin(0.3 * i));
    return pieceOf(sim::strand(points), 0.05, 0.02);
}

TEST(AssembleFabric, ClothWeighsItsAreaTimesThickness)
{
    const Fabric fabric = assemble(cloth());
    const double volume = 1.0 * 1.0 * 0.0345;
    EXPECT_NEAR(volume, total(fabric.volume), 1.0e-14);
    EXPECT_NEAR(volume * kDensity * kFraction, total(fabric.mass), 1.0e-14);
    EXPECT_NEAR(0.1 * 0.2 * 0.0345, fabric.volume[1 * 11 + 1], 1.0e-15);  // inside: a whole cell
    EXPECT_NEAR(0.1 * 0.2 / 6.0 * 0.0345, fabric.volume[0], 1.0e-15);     // the corner of one triangle
    for (const double thickness : fabric.faces.thickness) EXPECT_DOUBLE_EQ(0.0345, thickness);
    for (const double radius : fabric.radius) EXPECT_DOUBLE_EQ(0.01725, radius);
}

TEST(AssembleFabric, YarnWeighsItsLengthTimesSection)
{
    const Fabric fabric = assemble(pieceOf(sim::strand(Vec3(0, 0, 0), Vec3(0, 5, 0), 10), 0.048, 0.018));
    const double section = kPi * 0.048 * 0.018, lineDensity = section * kDensity * kFraction;
    EXPECT_NEAR(5.0 * lineDensity, total(fabric.mass), 1.0e-15);
    EXPECT_NEAR(0.5 * section, fabric.volume[4], 1.0e-15);
    EXPECT_NEAR(0.25 * section, fabric.volume[0], 1.0e-15);
    EXPECT_NEAR(0.25 * section, fabric.volume[10], 1.0e-15);
    EXPECT_DOUBLE_EQ(std::sqrt(0.048 * 0.018), fabric.radius[3]);
    for (std::size_t e = 0; e < fabric.edges.size(); ++e) {
        EXPECT_DOUBLE_EQ(0.5, fabric.edges.restLength[e]);
        EXPECT_NEAR(0.25 * 0.5 * lineDensity * (0.048 * 0.048 + 0.018 * 0.018), fabric.edges.twistInertia[e], 1.0e-18);
    }
}

/// J = ¼ m (a² + b²) of an elliptic section, whatever fills it: m is the water of the edge's half on either side.
TEST(AssembleFabric, WaterIsInTheInertiaOfTwist)
{
    const Fabric fabric = assemble(pieceOf(sim::strand(Vec3(0, 0, 0), Vec3(0, 5, 0), 10), 0.048, 0.018));
    const std::size_t last = fabric.edges.size() - 1;
    std::vector<double> absorbed(fabric.vertexCount(), 0.0);
    absorbed[4] = 3.0e-4, absorbed[10] = 1.0e-4;  // g
    const double perMass = 0.25 * (0.048 * 0.048 + 0.018 * 0.018), dry = fabric.edges.twistInertia[0];
    EXPECT_DOUBLE_EQ(dry, twistInertia(fabric, absorbed, 0));
    EXPECT_NEAR(dry + perMass * 1.5e-4, twistInertia(fabric, absorbed, 3), 1.0e-18);
    EXPECT_NEAR(dry + perMass * 1.5e-4, twistInertia(fabric, absorbed, 4), 1.0e-18);
    EXPECT_NEAR(dry + perMass * 1.0e-4, twistInertia(fabric, absorbed, last), 1.0e-18) << "the end of a yarn has one edge";
    for (std::size_t v = 0; v < absorbed.size(); ++v) absorbed[v] = 2.0 * fabric.mass[v];
    for (std::size_t e = 0; e <= last; ++e) EXPECT_NEAR(3.0 * dry, twistInertia(fabric, absorbed, e), 1.0e-17);
}

/// Of a yarn that is sewn to cloth the cloth has its share of the water.
TEST(AssembleFabric, WaterOfClothTwistsNoYarn)
{
    FabricPiece both = cloth();
    both.strands.push_back({0, 1, 2});
    const Fabric fabric = assemble(both), yarn = assemble(pieceOf(sim::strand(both.points[0], both.points[1], 1), both.radius[0], both.radius[1]));
    std::vector<double> absorbed(fabric.vertexCount(), 0.0);
    absorbed[0] = fabric.volume[0];  // as much per volume in all of the vertex
    const auto [a, b] = both.radius;
    EXPECT_NEAR(twistInertia(fabric, absorbed, 0) - fabric.edges.twistInertia[0], 0.25 * (a * a + b * b) * yarn.volume[0], 1.0e-18);
    EXPECT_GT(fabric.volume[0], 1.01 * yarn.volume[0]);
}

TEST(AssembleFabric, SharedVerticesCountEachYarnOnce)
{
    const FabricPiece piece = yarnSheet();
    const Fabric fabric = assemble(piece);
    double length = 0.0;
    for (const auto& strand : piece.strands) {
        for (std::size_t j = 0; j + 1 < strand.size(); ++j) length += (piece.points[strand[j + 1]] - piece.points[strand[j]]).norm();
    }
    EXPECT_NEAR(length, total(fabric.edges.restLength), 1.0e-9);
    EXPECT_NEAR(length * kPi * 0.048 * 0.018, total(fabric.volume), 1.0e-9);
    EXPECT_NEAR(total(fabric.volume) * kDensity * kFraction, total(fabric.mass), 1.0e-12);
    // The first vertex of a yarn along x: half its own first edge, and half of both border edges it lies on.
    double around = 0.0;
    for (std::size_t e = 0; e < fabric.edges.size(); ++e) {
        const Vec2i& edge = fabric.edges.vertices[e];
        if (edge[0] == 30 || edge[1] == 30) around += 0.5 * fabric.edges.restLength[e];
    }
    EXPECT_NEAR(around * kPi * 0.048 * 0.018, fabric.volume[30], 1.0e-15);
}

TEST(AssembleFabric, PiecesStandOneBehindTheOther)
{
    const std::vector<FabricPiece> pieces = {helix(), cloth(), yarnSheet()};
    const Fabric fabric = sim::assembleFabric(pieces);
    const Fabric alone[] = {assemble(pieces[0]), assemble(pieces[1]), assemble(pieces[2])};
    ASSERT_EQ(alone[0].vertexCount() + alone[1].vertexCount() + alone[2].vertexCount(), fabric.vertexCount());
    EXPECT_EQ(1 + alone[2].strands.count(), fabric.strands.count());
    EXPECT_EQ(alone[1].faces.size(), fabric.faces.size());
    const int firstOfSheet = static_cast<int>(alone[0].vertexCount() + alone[1].vertexCount());
    EXPECT_EQ(firstOfSheet + alone[2].strands.vertex(5, 7), fabric.strands.vertex(6, 7));
    EXPECT_EQ(alone[1].faces.vertices[3] + sim::Vec3i::Constant(40), fabric.faces.vertices[3]);
    EXPECT_EQ(alone[2].mass[17], fabric.mass[firstOfSheet + 17]);
    EXPECT_EQ(3u, fabric.materials.size());
    EXPECT_EQ(0, fabric.vertexMaterial[0]);
    EXPECT_EQ(1, fabric.faces.material[0]);
    EXPECT_EQ(2, fabric.strands.material[1]);
    for (int s = 0; s < fabric.strands.count(); ++s) {
        for (int j = 0; j + 1 < fabric.strands.size(s); ++j) {
            const int e = fabric.strands.edgeBegin(s) + j;
            ASSERT_EQ(s, fabric.edges.strand[e]);
            ASSERT_EQ(Vec2i(fabric.strands.vertex(s, j), fabric.strands.vertex(s, j + 1)), fabric.edges.vertices[e]);
        }
    }
}

sim::PinGroup pin(const std::vector<int>& vertices, const sim::Motion& motion = {}, bool twist = false)
{
    sim::PinGroup group;
    group.vertices = vertices;
    group.motion = motion;
    group.twist = twist;
    return group;
}

TEST(AssembleFabric, PinsAscendAndKeepTheirMotions)
{
    std::vector<FabricPiece> pieces = {helix(), helix()};
    sim::Motion up;
    up.addTranslation(0.0, 1.0, Vec3(0, 1, 0), 0.1, 0.1);
    pieces[0].pins = {pin({38, 39}, up), pin({0, 1})};
    pieces[1].pins = {pin({39}, {}, true)};
    const Fabric fabric = sim::assembleFabric(pieces);
    EXPECT_EQ((std::vector<int>{0, 1, 38, 39, 79}), fabric.pins.vertex);
    EXPECT_EQ((std::vector<int>{1, 1, 0, 0, 2}), fabric.pins.motion);
    ASSERT_EQ(3u, fabric.pins.motions.size());
    EXPECT_FALSE(fabric.pins.motions[0].isStatic());
    EXPECT_TRUE(fabric.pins.motions[1].isStatic());
    EXPECT_TRUE(fabric.pinned[38]);
    EXPECT_FALSE(fabric.pinned[37]);
    for (std::size_t e = 0; e < fabric.edges.size(); ++e) EXPECT_EQ(e == 77, fabric.edges.twistHeld[e] != 0) << e;
}

TEST(AssembleFabric, HeldTwistReachesBothSidesOfAVertex)
{
    FabricPiece piece = helix();
    piece.pins = {pin({7}, {}, true)};
    const Fabric fabric = assemble(piece);
    for (std::size_t e = 0; e < fabric.edges.size(); ++e) EXPECT_EQ(e == 6 || e == 7, fabric.edges.twistHeld[e] != 0) << e;
}

void expectRefused(const FabricPiece& piece, const std::string& what)
{
    try {
        assemble(piece);
        FAIL() << "put together: " << what;
    } catch (const sim::InputError& e) {
        EXPECT_NE(std::string::npos, std::string(e.what()).find(what)) << e.what();
    }
}

TEST(AssembleFabric, RefusesWhatIsNoFabric)
{
    FabricPiece piece = helix();
    piece.points.push_back(Vec3(9, 9, 9));
    expectRefused(piece, "vertex 40 is on no yarn and no face");
    piece = helix();
    piece.points[5] = piece.points[4];
    expectRefused(piece, "vertices 4 and 5 of a yarn are at one place");
    piece = helix();
    piece.points[6] = piece.points[4];
    expectRefused(piece, "turns straight back at vertex 5");
    piece = helix();
    piece.strands[0][3] = 40;
    expectRefused(piece, "there is no vertex 40; there are 40");
    piece = helix();
    piece.strands.push_back({3});
    expectRefused(piece, "has 1 vertices");
    piece = cloth();
    piece.faces[2] = {0, 1, 2};
    expectRefused(piece, "the face 0, 1, 2 has no area");
    piece = cloth();
    piece.faces[2] = {0, 1, -1};
    expectRefused(piece, "there is no vertex -1");
}

TEST(InitialState, FramesAreOrthonormalAndParallel)
{
    const std::vector<FabricPiece> pieces = {helix(), yarnSheet()};
    const Fabric fabric = sim::assembleFabric(pieces);
    const FabricState state = sim::initialState(fabric, pieces);
    ASSERT_EQ(fabric.edges.size(), state.reference.size());
    for (std::size_t e = 0; e < fabric.edges.size(); ++e) {
        ASSERT_NEAR(1.0, state.tangent[e].norm(), 1.0e-14);
        ASSERT_NEAR(1.0, state.reference[e].norm(), 1.0e-14);
        ASSERT_NEAR(0.0, state.reference[e].dot(state.tangent[e]), 1.0e-14);
        if (e == 0 || fabric.edges.strand[e] != fabric.edges.strand[e - 1]) continue;
        // Nothing turns about the axis across both edges: its component of the frame stays what it was.
        const Vec3 axis = state.tangent[e - 1].cross(state.tangent[e]).normalized();
        ASSERT_NEAR(axis.dot(state.reference[e - 1]), axis.dot(state.reference[e]), 1.0e-12);
        const Vec3 before = axis.cross(state.tangent[e - 1]), after = axis.cross(state.tangent[e]);
        ASSERT_NEAR(before.dot(state.reference[e - 1]), after.dot(state.reference[e]), 1.0e-12);
    }
}

TEST(InitialState, FirstFrameLeavesTheSmallestComponentOfTheTangent)
{
    const FabricPiece yarn = pieceOf(sim::strand(Vec3(0, 0, 0), Vec3(3, 1, 2), 4), 0.1, 0.1);
    const Fabric fabric = assemble(yarn);
    const FabricState state = sim::initialState(fabric, {&yarn, 1});
    const Vec3 t = Vec3(3, 1, 2).normalized();
    const Vec3 expected = (Vec3::UnitY() - t[1] * t).normalized();
    for (const Vec3& u : state.reference) EXPECT_TRUE(u.isApprox(expected, 1.0e-13));
}

TEST(InitialState, StartsAtThePiecesVelocitiesWithoutTwist)
{
    std::vector<FabricPiece> pieces = {helix(), cloth()};
    pieces[0].velocity = Vec3(1, 2, 3);
    pieces[0].pins = {pin({4})};
    const Fabric fabric = sim::assembleFabric(pieces);
    const FabricState state = sim::initialState(fabric, pieces);
    ASSERT_EQ(fabric.vertexCount(), state.v.size());
    EXPECT_EQ(Vec3(1, 2, 3), state.v[39]);
    EXPECT_EQ(Vec3(0, 0, 0), state.v[4]);
    EXPECT_EQ(Vec3(0, 0, 0), state.v[40]);
    EXPECT_EQ(fabric.rest, state.x);
    for (std::size_t e = 0; e < fabric.edges.size(); ++e)
        EXPECT_TRUE(state.theta[e] == 0.0 && state.omega[e] == 0.0 && state.referenceTwist[e] == 0.0);
}

TEST(InitialState, OfNothingIsNothing)
{
    const Fabric fabric = sim::assembleFabric({});
    EXPECT_TRUE(fabric.empty());
    EXPECT_EQ(0, fabric.strands.count());
    EXPECT_TRUE(sim::initialState(fabric, {}).x.empty());
}

}  // namespace
