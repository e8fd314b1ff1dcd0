#include "tests/physics/fabric_runs.h"

#include <gtest/gtest.h>

// Yarns and cloth that bend under their weight (fabric/rods/README.md, Energies; fabric/shells/README.md, Bending).

namespace sim::test {
namespace {

using testing::pieceOf;

// Thick, so that stretching is not too stiff beside bending; the strain under the weight is still below 1e-4.
constexpr double kRadius = 0.2, kLength = 10.0;  // cm
constexpr double kStep = 2.0e-3;                 // s

/// Young's modulus with which a yarn of length L has wL³/EI = Γ.
double youngFor(double gamma, double length) { return 4.0 * 1.3 * kEarthGravity * std::pow(length, 3) / (gamma * kRadius * kRadius); }

TEST(YarnCantilever, SmallDeflectionIsThatOfABeamHalfAnEdgeLonger)
{
    // The measured ratios δ / (wL⁴/8EI), of which (1 + 1/2n)⁴ is the limit for long beams.
    const std::vector<std::pair<int, double>> measured = {{5, 1.44}, {10, 1.210}, {20, 1.1025}, {40, 1.0506}};
    for (const auto& [n, ratio] : measured) {
        const double gamma = 1.0e-3;  // so that the deflection is 1e-4 of the length: geometry is linear
        Cantilever beam(n, kLength / n, kRadius, youngFor(1.0, kLength));
        FabricRun run(beam.piece);
        run.gravity *= gamma;
        ASSERT_TRUE(run.settle(kStep, 30.0, 1.0e-8));
        const double drop = -run.state.x[beam.tip].y(), slender = gamma * kLength / 8.0;
        EXPECT_NEAR(drop / slender, ratio, 0.0005 * ratio + (n == 5 ? 0.005 : 0.0005)) << n << " edges";  // digits given
        RecordProperty("ratio" + std::to_string(n), std::to_string(drop / slender));
    }
}

struct Elastica {
    double gamma, x, drop, degrees;
};
const std::vector<Elastica> kElastica = {{1.0, 0.99125, 0.12347, 9.460}, {5.0, 0.84666, 0.49591, 39.935}, {20.0, 0.44523, 0.82988, 76.75}};

TEST(YarnCantilever, FollowsTheHeavyElastica)
{
    constexpr int kEdges = 40;
    for (const Elastica& exact : kElastica) {
        const double l = kLength / kEdges;
        Cantilever beam(kEdges, l, kRadius, youngFor(exact.gamma, (kEdges + 0.5) * l));
        FabricRun run(beam.piece);
        ASSERT_TRUE(run.settle(kStep, 20.0));
        const Vec3 tip = (run.state.x[beam.tip] - beam.clamp) / beam.effectiveLength;
        const Vec3 last = run.state.x[beam.tip] - run.state.x[beam.tip - 1];
        const double degrees = std::atan2(-last.y(), last.x()) * 180.0 / kPi;
        EXPECT_NEAR(tip.x(), exact.x, 0.02 * exact.x) << exact.gamma;
        EXPECT_NEAR(-tip.y(), exact.drop, 0.02 * exact.drop) << exact.gamma;
        EXPECT_NEAR(degrees, exact.degrees, 0.02 * exact.degrees) << exact.gamma;
        RecordProperty("tip" + std::to_string(int(exact.gamma)),
                       std::to_string(tip.x()) + " " + std::to_string(-tip.y()) + " " + std::to_string(degrees));
    }
}

/// A step of gravity alone takes the yarn several radii, its stiffness takes it back: Newton's last iteration must not leave a part of
/// that for the next step, or the yarn hangs lower, for as long as it is watched.
TEST(YarnCantilever, HangsAsHighAfterLongStepsAsAfterShortOnes)
{
    constexpr int kEdges = 10;
    const double l = kLength / kEdges;
    Cantilever beam(kEdges, l, kRadius, youngFor(1.0, (kEdges + 0.5) * l));
    beam.piece.material.dampingViscosity = 4.0e6;  // P: as good as at rest after 3 s
    const auto sag = [&](double h, bool contact) {
        FabricSettings settings;
        settings.contact = contact;
        FabricRun run(beam.piece, settings);
        run.steps(static_cast<int>(std::lround(3.0 / h)), h);
        return run.largestIn(10, h, [&] { return -run.state.x[beam.tip].y(); });
    };
    const double known = sag(2.0e-3, false);
    EXPECT_NEAR(sag(2.0e-2, false), known, 0.01 * known);
    EXPECT_NEAR(sag(2.0e-2, true), known, 0.01 * known);
    EXPECT_NEAR(sag(5.0e-2, false), known, 0.01 * known);
}

/// A yarn sewn along the middle of a strip: both bend together, like a beam with the stiffness and the weight of both.
TEST(ClothStrip, YarnSewnOnAddsItsStiffnessAndItsWeight)
{
    constexpr int kEdges = 20;
    constexpr double kWidth = 0.5;
    ClothGrid grid;
    const double l = kLength / kEdges;
    grid.nodes = Vec2i(kEdges + 2, 3);
    grid.spacing = {l, 0.5 * kWidth};
    grid.origin = Vec3(-l, 0.0, 0.0);
    FabricGeometry mesh = clothGrid(grid);
    std::vector<int> middle;
    for (int i = 0; i < kEdges + 2; ++i) middle.push_back(kEdges + 2 + i);
    mesh.strands.push_back(middle);
    FabricPiece piece = pieceOf(mesh, solidFibre(5.0e8, 0.0), {kRadius, kRadius});  // cloth of thickness 0.4
    piece.pins.push_back(pinned({0, 1, kEdges + 2, kEdges + 3, 2 * kEdges + 4, 2 * kEdges + 5}));
    const double thickness = 2.0 * kRadius, length = kLength + 0.5 * l;
    const double stiffness = bendingStiffness(piece) + piece.material.young * std::pow(thickness, 3) / 12.0 * kWidth;
    const double weight = (lineDensity(piece) + piece.material.density * thickness * kWidth) * kEarthGravity;
    FabricRun run(piece);
    ASSERT_TRUE(run.settle(kStep, 40.0, 0.01));
    const double gamma = weight * std::pow(length, 3) / stiffness, exact = gamma / 8.0;
    ASSERT_LT(gamma, 0.5);  // for which Γ/8 is right to 0.4 %
    const double drop = -run.state.x[2 * kEdges + 3].y() / length;
    EXPECT_NEAR(drop, exact, 0.02 * exact);
    RecordProperty("drop", std::to_string(drop / exact));
}

}  // namespace
}  // namespace sim::test
