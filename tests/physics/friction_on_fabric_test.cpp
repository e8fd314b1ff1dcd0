#include "sim/core/units.h"
#include "sim/fabric/pieces/generators.h"
#include "sim/simulation.h"
#include "tests/physics/fabric_runs.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include <cmath>
#include <numeric>
#include <string>

// What friction of fabric on fabric can hold stays where it is, and what it cannot slides as Coulomb has it: in any direction against the
// gravity and against the mesh, at any scale, in steps of any length, wet and dry, with solver vertex (fabric/README.md, Friction). With solver grid
// fabric meets fabric on the faces of the grid, where what is in one cell moves nearly as one.

namespace sim::test {
namespace {

constexpr double kFriction = 0.577350;  ///< of 30 degrees [-]
constexpr double kSize = 2.0;           ///< of the fabric above [cm]

/// A sheet or a yarn on a slope of cloth that is held.
struct ClothSlope {
    bool isYarn = false;
    double steepness = 0.9;                                    ///< tangent of the slope relative to that of the friction angle [-]
    double scale = 1.0;                                        ///< of lengths and gravity: times stay [-]
    double h = 2.0e-3;                                         ///< [s]
    Eigen::Quaterniond turn = Eigen::Quaterniond::Identity();  ///< of all
    double yaw = 0.0;                                          ///< of the fabric above about the normal of the slope [rad]
    double wetness = 0.0;                                      ///< of the fabric above [-]

    double angle() const { return std::atan(steepness * kFriction); }
    double gravity() const { return scale * kEarthGravity; }
    double radius() const { return 0.03 * scale; }
    /// Down the slope, when it slides [cm/s²].
    double coulomb() const { return gravity() * (std::sin(angle()) - kFriction * std::cos(angle())); }
};

std::string nameOf(const ClothSlope& slope)
{
    return std::string(slope.isYarn ? "yarn" : "cloth") + " steepness " + std::to_string(slope.steepness) + " scale " + std::to_string(slope.scale) +
           " step " + std::to_string(slope.h) + " yaw " + std::to_string(slope.yaw) + " wetness " + std::to_string(slope.wetness);
}

FabricPiece held(const ClothSlope& slope)
{
    ClothGrid grid;
    grid.nodes = Vec2i(29, 11);
    const double spacing = 0.25 * slope.scale;
    grid.spacing = {spacing, spacing};
    grid.origin = Vec3(-5.3 * spacing, -2.2 * slope.radius(), -5.4 * spacing);
    FabricPiece piece = testing::pieceOf(clothGrid(grid), testing::wool(), {slope.radius(), slope.radius()});
    std::vector<int> all(piece.points.size());
    std::iota(all.begin(), all.end(), 0);
    piece.pins.push_back(pinned(all));
    return piece;
}

/// Where contact with the slope, the plane y = −2.2 radii, begins.
FabricPiece above(const ClothSlope& slope)
{
    constexpr int kNodes = 7;
    const double half = 0.5 * kSize * slope.scale;
    ClothGrid grid;
    grid.nodes = Vec2i(kNodes, kNodes);
    grid.spacing = {2.0 * half / (kNodes - 1), 2.0 * half / (kNodes - 1)};
    grid.origin = Vec3(-half, 0.0, -half);
    const Vec3 end(0.8 * half, 0.0, 0.6 * half);
    FabricPiece piece =
        testing::pieceOf(slope.isYarn ? strand(-end, end, kNodes + 1) : clothGrid(grid), testing::wool(), {slope.radius(), slope.radius()});
    for (Vec3& x : piece.points) x = Eigen::AngleAxisd(slope.yaw, Vec3::UnitY()) * x;
    piece.wetness = slope.wetness;
    return piece;
}

Scene sceneOf(const ClothSlope& slope)
{
    Scene scene;
    scene.name = "slope of cloth";
    scene.settings.cell = 0.25 * slope.scale;
    scene.settings.fabric.solver = FabricSolver::Vertex;
    scene.settings.time.mode = TimeMode::Fixed;
    scene.settings.time.dt = slope.h;
    scene.settings.gravity = slope.turn * (slope.gravity() * Vec3(std::sin(slope.angle()), -std::cos(slope.angle()), 0.0));
    for (FabricPiece piece : {above(slope), held(slope)}) {
        piece.material.frictionAngle = std::atan(kFriction);
        piece.material.young *= slope.scale * slope.scale;
        for (Vec3& x : piece.points) x = slope.turn * x;
        scene.fabrics.push_back(piece);
    }
    return scene;
}

struct ClothSlopeRun {
    explicit ClothSlopeRun(const ClothSlope& of) : slope(of), run(sceneOf(of)), count(above(of).points.size()) {}

    void until(double t)
    {
        while (run.state().time < t) run.step(t);
    }
    /// Mean of what the vertices of the fabric above have, as the slope's scene has it.
    Vec3 mean(const std::vector<Vec3>& of) const
    {
        Vec3 sum = Vec3::Zero();
        double mass = 0.0;
        for (std::size_t v = 0; v < count; ++v) sum += run.fabric().mass[v] * of[v], mass += run.fabric().mass[v];
        return slope.turn.conjugate() * (sum / mass);
    }

    ClothSlope slope;
    Simulation run;
    std::size_t count;
};

/// How far the fabric creeps once it has come to rest, in its sizes per second.
double creepOf(const ClothSlope& slope)
{
    ClothSlopeRun run(slope);
    run.until(0.3);
    const Vec3 before = run.mean(run.run.state().fabric.x);
    run.until(0.6);
    return (run.mean(run.run.state().fabric.x) - before).norm() / (0.3 * kSize * slope.scale);
}

/// Acceleration downhill relative to Coulomb's.
double slideOf(const ClothSlope& slope)
{
    ClothSlopeRun run(slope);
    run.until(0.05);
    const double before = run.mean(run.run.state().fabric.v).x();
    run.until(0.15);
    return (run.mean(run.run.state().fabric.v).x() - before) / 0.1 / slope.coulomb();
}

TEST(FrictionOnFabric, HoldsAndSlidesAsCoulombHasIt)
{
    testing::Noise random(7);
    const auto between = [&](double least, double most) { return least + 0.5 * (random() + 1.0) * (most - least); };
    for (int i = 0; i < 8; ++i) {
        ClothSlope slope;
        slope.isYarn = i % 2 == 1;
        slope.scale = std::exp(between(-3.0, 3.0));
        slope.h = std::exp(between(std::log(5.0e-4), std::log(4.0e-3)));
        slope.turn = Eigen::Quaterniond(random(), random(), random(), random()).normalized();
        slope.yaw = between(-kPi, kPi);
        slope.wetness = i % 4 < 2 ? 0.0 : 0.5;
        slope.steepness = between(0.3, 0.95);
        EXPECT_LT(creepOf(slope), 1.0e-3) << nameOf(slope);
        slope.steepness = between(1.3, 2.5);
        // Friction agrees with the normal forces to kFrictionError; near its angle that is more of what is left to accelerate.
        EXPECT_NEAR(slideOf(slope), 1.0, 0.08) << nameOf(slope);
    }
}

}  // namespace
}  // namespace sim::test
