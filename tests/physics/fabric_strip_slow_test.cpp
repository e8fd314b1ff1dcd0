#include "tests/physics/fabric_runs.h"

#include <gtest/gtest.h>

// Strips of cloth that bend like beams, whatever the direction of their threads (model-fabric T7).

namespace sim::test {
namespace {

using testing::pieceOf;

constexpr double kLength = 10.0, kThickness = 0.5;  // cm; the strain under the weight is 2e-4
constexpr int kCells = 20;                          // along the strip
constexpr double kCell = kLength / kCells;

/// A strip along x, clamped left of x = 0 with one more row of its mesh. Without Poisson's effect its width does not matter.
struct Strip {
    FabricPiece piece;
    double effectiveLength = 0.0;
    int tip = 0;

    /// Threads along the strip.
    static Strip straight(int cellsAcross)
    {
        ClothGrid grid;
        grid.nodes = Vec2i(kCells + 2, cellsAcross + 1);
        grid.spacing = {kCell, kCell};
        grid.origin = Vec3(-kCell, 0.0, 0.0);
        Strip strip;
        strip.effectiveLength = kLength + 0.5 * kCell;
        strip.tip = (cellsAcross / 2) * (kCells + 2) + kCells + 1;
        strip.make(clothGrid(grid));
        return strip;
    }
    /// Threads at 45 degrees, the diagonals of the mesh along the strip: right triangles with their long sides along x.
    static Strip bias(int trianglesAcross)
    {
        FabricGeometry mesh;
        std::vector<int> first;
        for (int j = 0; j <= trianglesAcross; ++j) {  // rows half a cell apart; odd ones begin half a cell earlier
            first.push_back(static_cast<int>(mesh.points.size()));
            const double shift = j % 2 == 0 ? 0.0 : -0.5 * kCell;
            for (int i = 0; i < kCells + 2; ++i) mesh.points.emplace_back(-kCell + shift + kCell * i, 0.0, 0.5 * kCell * j);
        }
        for (int j = 0; j < trianglesAcross; ++j)
            for (int i = 0; i + 1 < kCells + 2; ++i) {
                const int a = first[j] + i, b = first[j + 1] + i;
                if (j % 2 == 0) {
                    mesh.faces.emplace_back(b, a, b + 1);
                    mesh.faces.emplace_back(a, a + 1, b + 1);
                } else {
                    mesh.faces.emplace_back(a, a + 1, b);
                    mesh.faces.emplace_back(a + 1, b + 1, b);
                }
            }
        Strip strip;
        strip.effectiveLength = kLength + 0.25 * kCell;  // folds begin between the last clamped points, half of them half a cell back
        strip.tip = first[2 * (trianglesAcross / 4)] + kCells + 1;
        strip.make(mesh);
        return strip;
    }
    /// Of a material with wL³/D = 1 where w = ρ t g, D = E t³/12.
    void make(const FabricGeometry& mesh)
    {
        const double young = 12.0 * 1.3 * kEarthGravity * std::pow(effectiveLength, 3) / (kThickness * kThickness);
        piece = pieceOf(mesh, solidFibre(young, 0.0), {0.5 * kThickness, 0.5 * kThickness});
        std::vector<int> clamped;
        for (int v = 0; v < static_cast<int>(mesh.points.size()); ++v)
            if (mesh.points[v].x() < 1.0e-9) clamped.push_back(v);
        piece.pins.push_back(pinned(clamped));
    }
};

/// How many times stiffer than the plate a strip bends: from its drop by the heavy elastica, drop/L = Γ/8 − 0.00153 Γ³ up to Γ = 1
/// (model-fabric T6).
double stiffness(const Strip& strip, const FabricSettings& settings)
{
    FabricRun run(strip.piece, settings);
    EXPECT_TRUE(run.settle(2.0e-3, 40.0, 0.01));
    const double eighth = -run.state.x[strip.tip].y() / strip.effectiveLength;
    return 1.0 / (8.0 * (eighth + 0.00153 * std::pow(8.0 * eighth, 3)));
}

/// Triangles at the free edges have a fold less and are too stiff or too soft; their share falls with the strip's width.
template <class Make>
double stiffnessOfAWideStrip(Make&& make, int narrow, const FabricSettings& settings)
{
    return 2.0 * stiffness(make(2 * narrow), settings) - stiffness(make(narrow), settings);
}

TEST(ClothStrip, BendsAsAPlateAlongTheThreadsAndOnTheBias)
{
    const double straight = stiffnessOfAWideStrip(Strip::straight, 2, withoutContact());
    const double bias = stiffnessOfAWideStrip(Strip::bias, 4, withoutContact());
    RecordProperty("strip", std::to_string(straight) + " " + std::to_string(bias));
    EXPECT_NEAR(straight, 1.0, 0.03);
    EXPECT_NEAR(bias, 1.0, 0.03);
}

TEST(ClothStrip, PublishedHingesAreThreeAndNineTimesTooStiff)
{
    FabricSettings settings = withoutContact();
    settings.bending = BendingModel::Hinge;
    settings.hingeConstant = 3.0;
    const double straight = stiffnessOfAWideStrip(Strip::straight, 2, settings);
    const double bias = stiffnessOfAWideStrip(Strip::bias, 4, settings);
    RecordProperty("hinge", std::to_string(straight) + " " + std::to_string(bias));
    EXPECT_NEAR(straight, 3.0, 0.09);
    EXPECT_NEAR(bias, 9.0, 0.27);
}

}  // namespace
}  // namespace sim::test
