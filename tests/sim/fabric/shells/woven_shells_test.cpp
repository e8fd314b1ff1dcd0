#include "sim/fabric/shells/shells.h"
#include "tests/sim/fabric/pieces.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>

// Cloth whose warp and weft differ (fabric/shells/README.md, Warp and weft).

namespace sim {
namespace {

constexpr double kThickness = 0.04;  // cm
constexpr double kSpacing = 0.1;     // cm

/// Cut along x from cloth whose warp is at an angle to it.
Fabric stripOf(const FabricMaterial& material, double angle, Vec2i nodes)
{
    FabricPiece piece =
        testing::pieceOf(clothGrid({.nodes = nodes, .spacing = {kSpacing, kSpacing}}), material, {0.5 * kThickness, 0.5 * kThickness});
    piece.warp = Vec3(std::cos(angle), 0.0, std::sin(angle));
    return testing::fabricOf(piece);
}

FabricMaterial denim()
{
    FabricMaterial m = testing::wool();
    m.poisson = 0.2;
    m.stretchStiffness = {1.0e6, 2.0e5};
    m.shearStiffness = 5.0e4;
    m.bendingStiffness = {640.0, 200.0};
    return m;
}

std::vector<Vec3> gradientOf(Shells& shells, const Fabric& fabric, std::span<const Vec3> x)
{
    std::vector<int> slot;
    for (std::size_t v = 0; v < x.size(); ++v) slot.push_back(static_cast<int>(v / kLanes * 3 * kLanes + v % kLanes));
    std::vector<double> packed((x.size() + kLanes) * 3, 0.0);
    shells.startStep(x).forces(x, 1.0, slot, packed, nullptr);
    std::vector<Vec3> gradient(fabric.vertexCount());
    for (std::size_t v = 0; v < x.size(); ++v)
        for (int a = 0; a < 3; ++a) gradient[v][a] = packed[slot[v] + a * kLanes];
    return gradient;
}

/// With the numbers of a plate of one material it is that plate, wherever its warp points.
TEST(WovenShells, AlikeInAllDirectionsTheyAreIsotropic)
{
    const FabricMaterial plain = testing::wool();
    FabricMaterial woven = plain;
    woven.stretchStiffness.fill(plain.packing() * plain.young * kThickness);
    woven.bendingStiffness.fill(plain.packing() * plain.young * std::pow(kThickness, 3) / (12.0 * (1.0 - plain.poisson * plain.poisson)));
    for (const double angle : {0.0, 0.6, 2.5}) {
        const Fabric one = stripOf(plain, angle, {6, 5}), other = stripOf(woven, angle, {6, 5});
        Shells isotropic(one, FabricSettings{}), likewise(other, FabricSettings{});
        testing::Noise noise(7);
        std::vector<Vec3> x = one.rest;
        for (Vec3& p : x) p += 0.02 * noise.vector();
        const auto a = isotropic.energies(x), b = likewise.energies(x);
        EXPECT_NEAR(a[0], b[0], 1.0e-12 * a[0]);
        EXPECT_NEAR(a[1], b[1], 1.0e-12 * a[1]);
        const std::vector<Vec3> f = gradientOf(isotropic, one, x), g = gradientOf(likewise, other, x);
        for (std::size_t v = 0; v < f.size(); ++v) EXPECT_LT((f[v] - g[v]).norm(), 1.0e-11 * f[v].norm());
    }
}

/// Strains along x, along z and sheared (engineering) by a stress of 1 along x, of cloth whose warp is at an angle to x [cm/dyn].
Vec3 compliance(const FabricMaterial& m, double angle)
{
    const auto [warp, weft] = m.stretchStiffness;
    const double cross = -m.poisson / std::sqrt(warp * weft), c = std::cos(angle), s = std::sin(angle);
    Mat3 byAxes;
    byAxes << 1.0 / warp, cross, 0.0, cross, 1.0 / weft, 0.0, 0.0, 0.0, 1.0 / m.shearStiffness;
    const Vec3 stress(c * c, s * s, -c * s);  // along warp, along weft, sheared
    const Vec3 strain = byAxes * stress;
    return {c * c * strain[0] + s * s * strain[1] - c * s * strain[2], s * s * strain[0] + c * c * strain[1] + c * s * strain[2],
            2.0 * c * s * (strain[0] - strain[1]) + (c * c - s * s) * strain[2]};
}

/// Strained as the theory has it a strip is in balance, and pulls at its ends with that stress: it has the theory's modulus.
TEST(WovenShells, StripsHaveTheModulusOfTheirDirection)
{
    const FabricMaterial m = denim();
    constexpr double kStress = 10.0;  // dyn/cm
    std::array<double, 3> modulus{};
    for (int n = 0; n < 3; ++n) {
        const double angle = 0.25 * kPi * n;
        const Vec3 strain = kStress * compliance(m, angle);
        const Vec2i nodes(13, 7);
        const Fabric fabric = stripOf(m, angle, nodes);
        std::vector<Vec3> x = fabric.rest;
        for (Vec3& p : x) p = Vec3((1.0 + strain[0]) * p.x() + 0.5 * strain[2] * p.z(), 0.0, 0.5 * strain[2] * p.x() + (1.0 + strain[1]) * p.z());
        Shells shells(fabric, FabricSettings{});
        const std::vector<Vec3> force = gradientOf(shells, fabric, x);
        const double width = kSpacing * (nodes[1] - 1);
        Vec3 atEnd = Vec3::Zero(), elsewhere = Vec3::Zero();
        for (std::size_t v = 0; v < force.size(); ++v) {
            const auto column = static_cast<int>(v) % nodes[0];
            if (column == nodes[0] - 1) atEnd += force[v];
            else if (column > 0) elsewhere = elsewhere.cwiseMax(force[v].cwiseAbs());
        }
        EXPECT_NEAR(atEnd.x(), kStress * width, 1.0e-3 * kStress * width) << angle;
        EXPECT_LT(atEnd.tail<2>().norm() + elsewhere.norm(), 1.0e-3 * kStress * width) << angle;
        modulus[static_cast<std::size_t>(n)] = kStress / strain[0];
    }
    EXPECT_NEAR(modulus[0], m.stretchStiffness[0], 1.0e-9 * modulus[0]);
    EXPECT_NEAR(modulus[2], m.stretchStiffness[1], 1.0e-9 * modulus[2]);
    EXPECT_LT(modulus[1], 0.8 * modulus[2]);  // on the bias cloth gives way by shearing
}

/// Energy of a sheet rolled about z, without its borders, over ½ κ² and its area [dyn cm].
double rolledStiffness(const FabricMaterial& material, double angle)
{
    const double curvature = 1.0e-2;
    double energy = 0.0, area = 0.0;
    for (int length : {12, 24})
        for (int width : {10, 20}) {
            const double sign = (length == 12) == (width == 10) ? 1.0 : -1.0;
            const Fabric fabric = stripOf(material, angle, {length + 1, width + 1});
            std::vector<Vec3> x = fabric.rest;
            for (Vec3& p : x) p.y() = 0.5 * curvature * p.x() * p.x();
            energy += sign * Shells(fabric, FabricSettings{}).energies(x)[1];
            area += sign * kSpacing * kSpacing * length * width;
        }
    return energy / (0.5 * curvature * curvature * area);
}

TEST(WovenShells, StripsBendAsTheirDirectionAsks)
{
    const FabricMaterial m = denim();
    const double mean = std::sqrt(m.bendingStiffness[0] * m.bendingStiffness[1]);
    for (const double angle : {0.0, 0.25 * kPi, 0.5 * kPi, 1.1}) {
        const double c = std::cos(angle) * std::cos(angle), s = 1.0 - c;
        const double d12 = m.poisson * mean, d66 = 0.5 * (1.0 - m.poisson) * mean;
        const double expected = c * c * m.bendingStiffness[0] + s * s * m.bendingStiffness[1] + (2.0 * d12 + 4.0 * d66) * c * s;
        EXPECT_NEAR(rolledStiffness(m, angle), expected, 2.0e-3 * expected) << angle;
    }
}

TEST(WovenShells, AWarpThroughAFaceIsRefused)
{
    FabricPiece piece = testing::pieceOf(clothGrid({.nodes = {3, 3}, .spacing = {1.0, 1.0}}), denim(), {0.1, 0.1});
    piece.warp = Vec3::UnitY();
    EXPECT_ANY_THROW(testing::fabricOf(piece));
    piece.material = testing::wool();
    EXPECT_NO_THROW(testing::fabricOf(piece));
}

}  // namespace
}  // namespace sim
