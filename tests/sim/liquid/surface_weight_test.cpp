#include "sim/liquid/surface_weight.h"

#include "tests/sim/liquid/grid_scene.h"

#include <gtest/gtest.h>

#include <random>

namespace sim::test {
namespace {

constexpr int kFloor = 0, kWide = 12;
constexpr double kStep = 1.0e-3;  // [s]
const Vec3 kFall(0.0, -981.0 * kStep, 0.0);

/// Share of the mass of liquid below a level that a quadratic B-spline so many cells below it has: its integral.
double splineBelow(double cells)
{
    constexpr int kParts = 2000;
    double sum = 0.0;
    for (int i = 0; i < kParts; ++i) {
        const double t = std::abs(-1.5 + 3.0 * (i + 0.5) / kParts);
        if (-1.5 + 3.0 * (i + 0.5) / kParts < cells) sum += 3.0 / kParts * (t < 0.5 ? 0.75 - t * t : 0.5 * (1.5 - t) * (1.5 - t));
    }
    return sum;
}

/// Particles of even liquid in a tank leave on its horizontal faces what their splines have below its level.
void spread(GridScene& scene, double level)
{
    for (int j = 1; j < 22; ++j)
        for (int k = 0; k < kWide; ++k)
            for (int i = 0; i < kWide; ++i) {
                const CellRef ref = scene.at({i, j, k});
                const double mass = scene.liquid.fullMass * scene.field.room(ref.block, 1)[ref.cell] * splineBelow(level - j);
                scene.liquid.faces.sums.block(ref.block, FaceFields::kMass + 1)[ref.cell] = mass;
                if (mass > 0.0) scene.liquid.wet.set(ref.block, ref.cell, 1);
            }
}

/// Liquid in a tank, up to a level above its floor or as a block in mid-air [cells], in whose surface layer mass has been moved up or down within
/// columns at random.
GridScene unevenLiquid(bool isHeld, double level, std::mt19937& random)
{
    GridScene scene({-3, -3, -3}, {15, 24, 15});
    scene.add(tankOfCells(scene, {0, kFloor, 0}, {kWide, 22, kWide}));
    const Vec3 from = scene.corner({3, 5, 3}), to = scene.corner({9, 0, 9});
    // Cells whose middle is up to half a cell above the liquid have a pressure (liquid/README.md, Cells).
    const double high = scene.corner({0, kFloor, 0}).y() + (isHeld ? level + 0.5 : level) * scene.grid.dx;
    scene.fill([&](const Vec3& x) {
        const double sides = isHeld ? -1.0e9 : std::max({from.x() - x.x(), x.x() - to.x(), from.z() - x.z(), x.z() - to.z(), from.y() - x.y()});
        return std::max(x.y() - high, sides);
    });
    if (isHeld) spread(scene, level);
    std::uniform_real_distribution<double> unit(-1.0, 1.0);
    const int top = static_cast<int>(std::lround(level));
    for (int k = 0; k < kWide; ++k)
        for (int i = 0; i < kWide; ++i) {
            const auto mass = [&](int j) -> double& {
                const CellRef ref = scene.at({i, j, k});
                return scene.liquid.faces.sums.block(ref.block, FaceFields::kMass + 1)[ref.cell];
            };
            for (int j = std::max(static_cast<int>(level) - 1, 1); j < top; ++j) {
                if (!(mass(j) > 0.0) || !(mass(j + 1) > 0.0)) continue;
                const double moved = 0.12 * unit(random) * std::min(mass(j), mass(j + 1));
                mass(j) -= moved;
                mass(j + 1) += moved;
            }
        }
    scene.setVelocities([](const Vec3&) { return kFall; });
    scene.liquid.unpressed = scene.liquid.faces.velocity;
    return scene;
}

void levelIn(GridScene& scene, const PressureSystem& system)
{
    LiquidOnSolids onSolids;
    onSolids.begin(scene.cut(), scene.liquid.faces);
    FreeLiquid bodies;
    PressureBeyond beyond;
    levelWeight(scene.cut(), findHeldBodies(scene.grid, system, findUnheldFaces(scene.cut(), bodies)), kFall, scene.liquid, &onSolids, beyond);
}

double largestSpeed(GridScene& scene)
{
    double largest = 0.0;
    scene.forEachFace([&](int a, const Vec3i& c) {
        const CellRef ref = scene.at(c);
        if (scene.work.coefficient.block(ref.block, a)[ref.cell] > 0.0) largest = std::max(largest, std::abs(scene.velocity(a, c)));
    });
    return largest;
}

/// However unevenly a surface layer lies, within what one face may bear for another: columns that weigh the same stay at rest, and weigh what they did.
TEST(SurfaceWeight, ColumnsThatWeighTheSameStayAtRest)
{
    std::mt19937 random(21);
    std::uniform_real_distribution<double> levels(1.5, 16.0);
    for (int n = 0; n < 30; ++n) {
        const double level = levels(random);
        GridScene scene = unevenLiquid(true, level, random), asItLies = scene;
        const PressureSystem system = scene.system(kStep);
        levelIn(scene, system);
        for (int k = 0; k < kWide; ++k)
            for (int i = 0; i < kWide; ++i) {
                double moved = 0.0, weight = 0.0;
                for (int j = 1; j < 22; ++j) {
                    const CellRef ref = scene.at({i, j, k});
                    const double mass = scene.liquid.faces.sums.block(ref.block, FaceFields::kMass + 1)[ref.cell];
                    moved += mass * (scene.velocity(1, {i, j, k}) - kFall.y());
                    weight += mass * std::abs(kFall.y());
                    if (mass > 0.0) {
                        EXPECT_LT(scene.velocity(1, {i, j, k}), 1.0e-12) << "weight pulls up, level " << level;
                    }
                    EXPECT_EQ(kFall.y(), scene.liquid.unpressed.block(ref.block, 1)[ref.cell]) << "what pressure and weight do together";
                }
                EXPECT_NEAR(moved, 0.0, 1.0e-12 * weight) << "level " << level;
            }
        scene.project(system);
        asItLies.project(kStep);
        EXPECT_LT(largestSpeed(scene), 1.0e-9 * std::abs(kFall.y())) << "level " << level;
        EXPECT_GT(largestSpeed(asItLies), 1.0e-3 * std::abs(kFall.y())) << "level " << level;
    }
}

/// Whatever the direction of gravity, what faces of even liquid weigh are differences of one pressure: no loop of faces turns the liquid. Columns of them
/// weigh what is below the level.
TEST(SurfaceWeight, OfEvenLiquidTurnsNothing)
{
    std::mt19937 random(23);
    std::uniform_real_distribution<double> unit(-1.0, 1.0);
    const EvenWeight upright(1.0);
    for (int n = 0; n < 500; ++n) {
        const double slope = n < 20 ? 1.0e-3 * n : unit(random);
        const EvenWeight aside(slope);
        // The level over the middle of the lower left of four cells in a square, above it; faces between them are at half integers.
        const double level = 3.0 * unit(random);
        const double left = upright.share(level - 0.5), right = upright.share(level + slope - 0.5);
        const double low = slope * aside.share(level + 0.5 * slope), high = slope * aside.share(level + 0.5 * slope - 1.0);
        EXPECT_NEAR(left + low, right + high, 1.0e-6 * std::abs(slope)) << "slope " << slope << ", level " << level;
        double sum = 0.0;
        for (int face = 0; face < 9; ++face) sum += aside.share(level + 4.5 - face);
        EXPECT_NEAR(sum, level + 5.0, 1.0e-12) << "slope " << slope << ", level " << level;
        const double h = 1.0e-5;
        EXPECT_NEAR(aside.slope(level), (aside.share(level + h) - aside.share(level - h)) / (2.0 * h), 1.0e-4) << "slope " << slope;
    }
}

TEST(SurfaceWeight, OfFreeLiquidIsLeftWhereItIs)
{
    std::mt19937 random(22);
    for (double level : {9.0, 11.3, 14.8}) {
        GridScene scene = unevenLiquid(false, level, random);
        levelIn(scene, scene.system(kStep));
        scene.forEachFace([&](int a, const Vec3i& c) { EXPECT_EQ(scene.velocity(a, c), kFall[a]); });
    }
}

}  // namespace
}  // namespace sim::test
