// Liquid over solids that stand on the floor of a tank rests.
#include "tests/physics/runs.h"

#include <gtest/gtest.h>

namespace sim::test {
namespace {

struct Solid {
    std::string name;
    Shape shape;
};

/// Solids on a floor in the plane y = 0, none of them along the grid or in its planes.
std::vector<Solid> solids()
{
    const auto turned = [](const Shape& shape, double angle, const Vec3& axis) {
        return shape.moved(Eigen::Isometry3d(Eigen::Translation3d(1.9, 0.0, 1.6) * Eigen::AngleAxisd(angle, axis.normalized())));
    };
    return {{"cap lower than a cell", Shape::ball({2.9, -0.45, 2.1}, 0.9)},
            {"ball in the floor", Shape::ball({2.9, 0.7, 2.1}, 1.3)},
            {"step within cells", Shape::box({1.9, 0.0, 1.6}, {0.8, 0.93, 0.9})},
            {"turned block", turned(Shape::box(Vec3::Zero(), {0.9, 1.1, 1.0}), 0.4, Vec3(0.3, 1.0, 0.2))},
            {"pillar", Shape::cylinder({2.6, 0.0, 1.9}, Vec3(0.2, 1.0, 0.1).normalized(), 0.7, 6.0, 0.0)}};
}

struct Found {
    double speed = 0.0;   ///< root of the mean square, of all modes [cm/s]
    double gained = 0.0;  ///< energy above that at the start, relative to the potential energy above the floor [-]
};

/// @param isFull  liquid fills the tank up to a lid
Found afterTwoSeconds(const Solid& solid, const Transfer& transfer, double cell, double depth, bool isFull = false)
{
    Scene scene = tankScene(transfer, cell, Vec3(6.0, isFull ? depth : 8.0, 4.0) / cell, Vec3::Zero(), Vec3(6.0, depth, 4.0) / cell);
    scene.settings.time.mode = TimeMode::Fixed;
    scene.settings.time.dt = 2.0e-3;
    scene.settings.liquid.full = isFull;
    scene.obstacles.push_back(obstacle(solid.name, solid.shape));
    Simulation simulation(scene);
    const double start = simulation.energies().total(), mass = simulation.state().ledger.emittedMass;
    Energies now;
    while (simulation.state().time < 2.0) now = simulation.step(2.0).energies;
    return {std::sqrt(2.0 * (now.kinetic + now.modal) / mass), (now.total() - start) / (0.5 * mass * kEarthGravity * depth)};
}

TEST(Rest, OfAPoolOverSolidsLasts)
{
    for (const Solid& solid : solids())
        for (const auto& [transfer, cell, depth] : {std::tuple(kPoly8, 0.5, 3.0), {kPoly27, 0.5, 2.8}, {kApic, 0.4, 3.1}}) {
            const Found found = afterTwoSeconds(solid, transfer, cell, depth);
            std::printf("%-22s %-10s cell %.1f cm: %.4f cm/s, gained %.1e\n", solid.name.c_str(), transfer.name.c_str(), cell, found.speed,
                        found.gained);
            EXPECT_LT(found.speed, 0.05) << solid.name << ", " << transfer.name;
            EXPECT_LT(found.gained, 1.0e-3) << solid.name << ", " << transfer.name;  // particles settle round corners within cells: 5.6e-4
        }
}

/// So does liquid that fills a box without air.
TEST(Rest, OfAFullBoxWithSolidsLasts)
{
    for (const Solid& solid : solids()) {
        const Found found = afterTwoSeconds(solid, kPoly27, 0.5, 4.0, true);
        std::printf("%-22s full: %.1e cm/s\n", solid.name.c_str(), found.speed);
        EXPECT_LT(found.speed, 1.0e-3) << solid.name;
    }
}

/// Nor do modes grow in a pool alone, which they did by e in 1.2 s next to its floor.
TEST(Rest, OfAPoolOfManyModesLastsLonger)
{
    for (const double depth : {4.0, 6.0, 6.3}) {
        Scene scene = tankScene(kPoly27, 0.5, {8.0, 16.0, 8.0}, Vec3::Zero(), {8.0, depth, 8.0});
        scene.settings.time.mode = TimeMode::Fixed;
        scene.settings.time.dt = 2.0e-3;
        Simulation simulation(scene);
        Energies now;
        while (simulation.state().time < 8.0) now = simulation.step(8.0).energies;
        const double mass = simulation.state().ledger.emittedMass;
        std::printf("%.1f cells deep: %.4f cm/s, modes %.4f\n", depth, std::sqrt(2.0 * now.kinetic / mass), std::sqrt(2.0 * now.modal / mass));
        EXPECT_LT(std::sqrt(2.0 * now.modal / mass), 5.0e-3) << depth;
    }
}

}  // namespace
}  // namespace sim::test
