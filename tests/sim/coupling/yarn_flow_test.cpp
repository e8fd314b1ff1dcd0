#include "sim/coupling/yarn_flow.h"
#include "sim/fabric/pieces/generators.h"
#include "tests/sim/fabric/pieces.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace sim::test {
namespace {

/// C_D of a cylinder, from the drag per volume and speed.
double dragCoefficient(const LiquidSettings& liquid, double diameter, double reynolds)
{
    const double speed = reynolds * liquid.viscosity / (liquid.density * diameter);
    return dragAround(liquid, DragLaw::Nonlinear, diameter, 1.0, speed).across * kPi * diameter / (2.0 * liquid.density * speed);
}

/// White's correlation, and where flow creeps a force in proportion to the speed; the same for any liquid and diameter.
TEST(DragAround, IsThatOfACylinder)
{
    for (const double diameter : {0.01, 0.1, 1.0}) {
        LiquidSettings liquid;
        liquid.viscosity *= 3.0 * diameter;
        EXPECT_NEAR(dragCoefficient(liquid, diameter, 1.0), 11.0, 1.0e-9);
        EXPECT_NEAR(dragCoefficient(liquid, diameter, 1000.0), 1.1, 1.0e-9);
        EXPECT_NEAR(dragCoefficient(liquid, diameter, 0.01), 10.0 * dragCoefficient(liquid, diameter, 0.1), 1.0e-9);
        EXPECT_NEAR(dragCoefficient(liquid, diameter, 0.1000001), dragCoefficient(liquid, diameter, 0.0999999), 1.0e-3);
    }
    const LiquidSettings water;
    EXPECT_EQ(dragAround(water, DragLaw::Off, 0.1, 1.0, 5.0).across, 0.0);
    EXPECT_EQ(dragAround(water, DragLaw::Linear, 0.1, 1.0, 5.0).across, dragAround(water, DragLaw::Linear, 0.1, 1.0, 50.0).across);
    const auto nonlinear = [&](double constriction) { return dragAround(water, DragLaw::Nonlinear, 0.1, constriction, 5.0).across; };
    EXPECT_NEAR(nonlinear(4.0), 4.0 * nonlinear(1.0), 1.0e-9);
}

/// A lone yarn has no neighbours; a row of them 3 diameters apart covers a third of the view; a denser row leaves less. Not the mesh decides.
TEST(Narrowings, GrowWithWhatNeighboursCover)
{
    const auto middleOf = [](double spacing, int segments) {
        std::vector<FabricPiece> pieces;
        for (int n = -20; n <= 20; ++n)
            if (spacing > 0.0 || n == 0)
                pieces.push_back(
                    testing::pieceOf(strand(Vec3(n * spacing, 0.0, -3.0), Vec3(n * spacing, 0.0, 3.0), segments), testing::wool(), {0.05, 0.05}));
        const Fabric fabric = assembleFabric(pieces);
        return constrictions(fabric, yarnDiameters(fabric))[fabric.vertexCount() / 2];
    };
    EXPECT_EQ(middleOf(0.0, 60), 1.0);
    const double wide = middleOf(0.3, 60), dense = middleOf(0.15, 60);
    EXPECT_GT(wide, 1.2);
    EXPECT_LT(wide, 1.0 / (0.67 * 0.67));
    EXPECT_GT(dense, 1.5 * wide);
    EXPECT_NEAR(middleOf(0.15, 120), dense, 0.1 * dense);
}

/// A square weave of yarns s apart has the head of measured screens within a fifth, C_D (1 - α²)/(2 α²) with the open part α = (1 - d/s)² (Blevins 1984
/// with 2 β for C_D): twice d/s of yarns per area, each with C_D times the constriction.
TEST(Narrowings, OfWeavesAreThoseOfScreens)
{
    constexpr double kDiameter = 0.05;
    for (const double spacing : {3.0, 5.0, 10.0}) {
        constexpr int kHalf = 15;
        const double pitch = spacing * kDiameter, end = kHalf * pitch;
        std::vector<FabricPiece> pieces;
        for (int n = -kHalf; n <= kHalf; ++n) {
            pieces.push_back(testing::pieceOf(strand(Vec3(n * pitch, 0.0, -end), Vec3(n * pitch, 0.0, end), 2 * kHalf), testing::wool(),
                                              {0.5 * kDiameter, 0.5 * kDiameter}));
            pieces.push_back(testing::pieceOf(strand(Vec3(-end, 0.0, n * pitch), Vec3(end, 0.0, n * pitch), 2 * kHalf), testing::wool(),
                                              {0.5 * kDiameter, 0.5 * kDiameter}));
        }
        const Fabric fabric = assembleFabric(pieces);
        const std::vector<double> all = constrictions(fabric, yarnDiameters(fabric));
        const auto middle = std::ranges::min_element(fabric.rest, {}, [](const Vec3& x) { return x.norm(); });
        const double alpha = std::pow(1.0 - 1.0 / spacing, 2), screen = (1.0 - alpha * alpha) / (2.0 * alpha * alpha);
        EXPECT_NEAR(2.0 / spacing * all[middle - fabric.rest.begin()], screen, 0.2 * screen) << spacing;
    }
}

}  // namespace
}  // namespace sim::test
