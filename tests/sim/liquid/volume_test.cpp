#include "sim/liquid/volume.h"

#include "sim/liquid/cells.h"
#include "tests/sim/liquid/grid_scene.h"

#include <gtest/gtest.h>

#include <random>

namespace sim::test {
namespace {

constexpr double kStrength = 0.2, kStep = 1.0e-3;  // [-], [s]
const Vec3 kGravity(0.0, -981.0, 0.0);

Settings under(const Vec3& gravity)
{
    Settings settings;
    settings.gravity = gravity;
    return settings;
}

/// A tank of 10 × 12 × 9 cells, filled to 8 cells above its floor.
GridScene tank()
{
    GridScene scene({-3, -3, -3}, {13, 15, 12});
    scene.add(tankOfCells(scene, {0, 0, 0}, {10, 12, 9}));
    const double surface = scene.corner({0, 8, 0}).y() - 1.0e-6 * scene.grid.dx;
    scene.fill([&](const Vec3& x) { return x.y() - surface; });
    scene.forEachCell([&](const Vec3i& c) { scene.liquid.fill.block(scene.at(c).block)[scene.at(c).cell] = scene.isInside(c) ? 1.0 : 0.0; });
    return scene;
}

/// Net displacement out of a cell, relative to its volume.
double expansion(const GridScene& scene, const VolumeWorkspace& work, const Vec3i& c)
{
    double sum = 0.0;
    for (int a = 0; a < kAxes; ++a) {
        const CellRef low = scene.at(c), high = scene.at(c + Vec3i::Unit(a));
        sum += scene.open(a, c + Vec3i::Unit(a)) * work.displacement.block(high.block, a)[high.cell] -
               scene.open(a, c) * work.displacement.block(low.block, a)[low.cell];
    }
    return sum / scene.grid.dx;
}

/// Mean over the open faces of a cell, relative to that of faces amid liquid.
double roomOfOpenFaces(const GridScene& scene, const Vec3i& cell)
{
    double room = 0.0;
    int open = 0;
    for (int a = 0; a < kAxes; ++a)
        for (const Vec3i& face : {cell, Vec3i(cell + Vec3i::Unit(a))}) {
            if (scene.open(a, face) == 0.0) continue;
            room += scene.field.room(scene.at(face).block, a)[scene.at(face).cell];
            ++open;
        }
    return room / open;
}

TEST(Volume, CellsExpandByWhatTheyHoldTooMuchAndHolesClose)
{
    for (const auto& [cell, fill] : {std::pair(Vec3i(4, 3, 4), 1.3), {Vec3i(0, 0, 0), 1.2}, {Vec3i(5, 2, 8), 0.6}, {Vec3i(5, 7, 4), 1.1}}) {
        GridScene scene = tank();
        scene.liquid.fill.block(scene.at(cell).block)[scene.at(cell).cell] = fill;
        VolumeWorkspace work;
        EXPECT_TRUE(correctVolume(scene.cut(), under(kGravity), kStrength, scene.system(kStep), work).converged);
        const double noise = kVolumeNoise + kCutOffNoise * std::pow(scene.liquid.pitch, 3) * (1.0 / roomOfOpenFaces(scene, cell) - 1.0);
        const double expected = kStrength * (fill - 1.0 - std::copysign(noise, fill - 1.0));
        scene.forEachCell([&](const Vec3i& c) {
            if (!scene.isInside(c)) return;
            // To the tolerance of the solve, 1 % of the largest source.
            EXPECT_NEAR(expansion(scene, work, c), c == cell ? expected : 0.0, 0.0101 * std::abs(expected)) << c.transpose();
        });
    }
}

TEST(Volume, NoiseOfPositionsIsNotCorrected)
{
    GridScene scene = tank();
    std::mt19937 random(11);
    std::uniform_real_distribution<double> noise(-kVolumeNoise, kVolumeNoise);
    scene.forEachCell([&](const Vec3i& c) {
        double& fill = scene.liquid.fill.block(scene.at(c).block)[scene.at(c).cell];
        if (scene.isInside(c)) fill = 1.0 + noise(random);
    });
    VolumeWorkspace work;
    correctVolume(scene.cut(), under(kGravity), kStrength, scene.system(kStep), work);
    scene.forEachFace([&](int a, const Vec3i& c) { EXPECT_EQ(work.displacement.block(scene.at(c).block, a)[scene.at(c).cell], 0.0); });
}

TEST(Volume, ThinSurfaceLayersAreNotCorrected)
{
    GridScene scene = tank();
    for (int j = 6; j < 8; ++j) scene.liquid.fill.block(scene.at({4, j, 4}).block)[scene.at({4, j, 4}).cell] = j == 7 ? 0.3 : 0.85;
    VolumeWorkspace work;
    correctVolume(scene.cut(), under(kGravity), kStrength, scene.system(kStep), work);
    scene.forEachFace([&](int a, const Vec3i& c) { EXPECT_EQ(work.displacement.block(scene.at(c).block, a)[scene.at(c).cell], 0.0); });
}

TEST(Volume, DetachingLiquidIsNotPulledBackToTheCeiling)
{
    std::mt19937 random(4);
    std::uniform_real_distribution<double> unit(-1.0, 1.0);
    for (int n = 0; n < 20; ++n) {
        // Two or three layers of cells on the side y = 0 of a tank. The first has come off in part.
        GridScene scene({-3, -3, -3}, {13, 15, 12});
        scene.add(tankOfCells(scene, {0, 0, 0}, {10, 12, 9}));
        const double surface = scene.corner({0, n % 4 < 2 ? 2 : 3, 0}).y() - 1.0e-6 * scene.grid.dx;
        scene.fill([&](const Vec3& x) { return std::max({x.y() - surface, 1.0 - x.x(), x.x() - 2.0, 1.0 - x.z(), x.z() - 2.0}); });
        scene.forEachCell([&](const Vec3i& c) {
            scene.liquid.fill.block(scene.at(c).block)[scene.at(c).cell] = scene.isInside(c) ? 0.55 + 0.2 * unit(random) : 0.0;
        });
        const Vec3 gravity(unit(random), n % 2 == 0 ? 1.01 + unit(random) : -1.01 - unit(random), unit(random));
        VolumeWorkspace work;
        correctVolume(scene.cut(), under(gravity), kStrength, scene.system(kStep), work);
        double largest = 0.0;
        scene.forEachFace(
            [&](int a, const Vec3i& c) { largest = std::max(largest, std::abs(work.displacement.block(scene.at(c).block, a)[scene.at(c).cell])); });
        if (n % 2 == 0) EXPECT_EQ(largest, 0.0) << "state " << n;
        else EXPECT_GT(largest, 1.0e-3 * scene.grid.dx) << "holes at a floor close: state " << n;
    }
}

TEST(Volume, NothingMovesFartherThanTheLargestCorrection)
{
    GridScene scene = tank();
    scene.forEachCell([&](const Vec3i& c) {
        if (scene.isInside(c)) scene.liquid.fill.block(scene.at(c).block)[scene.at(c).cell] = 50.0;
    });
    VolumeWorkspace work;
    correctVolume(scene.cut(), under(kGravity), 1.0, scene.system(kStep), work);
    double largest = 0.0;
    scene.forEachFace(
        [&](int a, const Vec3i& c) { largest = std::max(largest, std::abs(work.displacement.block(scene.at(c).block, a)[scene.at(c).cell])); });
    EXPECT_EQ(largest, kLargestCorrection * scene.grid.dx);
}

}  // namespace
}  // namespace sim::test
