#include "sim/core/units.h"
#include "sim/fabric/pieces/generators.h"
#include "sim/simulation.h"
#include "sim/state_hash.h"
#include "tests/sim/fabric/pieces.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include <cmath>

// What friction can hold stays where it is, and what it cannot slides as Coulomb has it: on solids at rest and moving, in any direction,
// at any scale, in any steps, wet and dry, by both solvers (fabric/README.md, Friction).

namespace sim::test {
namespace {

constexpr double kFriction = 0.577350;   ///< of 30 degrees [-]
constexpr double kSize = 2.0;            ///< of the fabric [cm]
constexpr double kLeastCreep = 1.0e-3;   ///< that counts, in sizes per second
constexpr double kShakenCreep = 1.2e-2;  ///< where accelerations change or steps are long: 2.4e-3 with solver vertex, 1e-2 with grid

/// A sheet or a yarn on a slope.
struct Slope {
    FabricSolver solver = FabricSolver::Vertex;
    bool isYarn = false;
    double steepness = 0.9;  ///< tangent of the slope relative to that of the friction angle [-]
    double scale = 1.0;      ///< of lengths and gravity: times stay [-]
    double h = 2.0e-3;       ///< [s]
    Eigen::Quaterniond turn = Eigen::Quaterniond::Identity();
    int nodes = 7;                    ///< along each side
    double height = 0.0, tilt = 0.0;  ///< above where contact begins [sizes], about an axis downhill [rad]
    double wetness = 0.0;             ///< [-]
    Vec3 velocity = Vec3::Zero();     ///< of the fabric at the start, before the turn [cm/s]
    Motion motion;                    ///< of the slope

    double angle() const { return std::atan(steepness * kFriction); }
    double gravity() const { return scale * kEarthGravity; }
    /// Down the slope, when it slides [cm/s²].
    double coulomb() const { return gravity() * (std::sin(angle()) - kFriction * std::cos(angle())); }
};

std::string nameOf(const Slope& slope)
{
    return std::string(slope.solver == FabricSolver::Grid ? "grid" : "vertex") + (slope.isYarn ? " yarn" : " cloth") + " steepness " +
           std::to_string(slope.steepness) + " scale " + std::to_string(slope.scale) + " step " + std::to_string(slope.h);
}

/// The slope is the plane y = 0, turned; downhill is x.
Scene sceneOf(const Slope& slope)
{
    const double s = slope.scale, radius = 0.03 * s, half = 0.5 * kSize * s, above = 1.25 * radius;
    Scene scene;
    scene.name = "slope";
    scene.settings.cell = 0.25 * s;
    scene.settings.fabric.solver = slope.solver;
    scene.settings.time.mode = TimeMode::Fixed;
    scene.settings.time.dt = slope.h;
    scene.settings.gravity = slope.turn * (slope.gravity() * Vec3(std::sin(slope.angle()), -std::cos(slope.angle()), 0.0));
    ClothGrid grid;
    grid.nodes = Vec2i(slope.nodes, slope.nodes);
    grid.spacing = {kSize * s / (slope.nodes - 1), kSize * s / (slope.nodes - 1)};
    grid.origin = Vec3(-half, above, -half);
    const Vec3 end(0.8 * half, above, 0.6 * half);
    FabricPiece piece = testing::pieceOf(slope.isYarn ? strand(-end + 2.0 * above * Vec3::UnitY(), end, slope.nodes + 1) : clothGrid(grid),
                                         testing::wool(), {radius, radius});
    piece.material.frictionAngle = std::atan(kFriction);
    piece.material.young *= s * s;
    const Eigen::AngleAxisd tilt(slope.tilt, Vec3::UnitX());
    const Vec3 lift = (slope.height * kSize + half * std::abs(std::sin(slope.tilt)) / s) * s * Vec3::UnitY();
    for (Vec3& x : piece.points) x = slope.turn * (tilt * x + lift);
    piece.velocity = slope.turn * slope.velocity;
    piece.wetness = slope.wetness;
    scene.fabrics.push_back(piece);
    ObstacleSettings plane;
    plane.name = "plane";
    plane.motion = slope.motion;
    plane.shape = Shape::box(Vec3(0.0, -10.0 * s, 0.0), Vec3(1000.0 * s, 10.0 * s, 1000.0 * s)).moved(Eigen::Isometry3d(slope.turn));
    scene.obstacles.push_back(plane);
    return scene;
}

struct SlopeRun {
    explicit SlopeRun(const Slope& of) : slope(of), run(sceneOf(of)) {}

    void until(double t)
    {
        while (run.state().time < t) run.step(t);
    }
    /// Middle of the fabric on the slope, as the slope's scene has it [cm].
    Vec3 place() const { return slope.turn.conjugate() * (slope.motion.transform(run.state().time).inverse() * mean(run.state().fabric.x)); }
    /// Its speed downhill [cm/s].
    double speed() const { return (slope.turn.conjugate() * mean(run.state().fabric.v)).x(); }
    Vec3 mean(const std::vector<Vec3>& of) const
    {
        Vec3 sum = Vec3::Zero();
        double mass = 0.0;
        for (std::size_t v = 0; v < of.size(); ++v) sum += run.fabric().mass[v] * of[v], mass += run.fabric().mass[v];
        return sum / mass;
    }

    Slope slope;
    Simulation run;
};

/// How far fabric creeps once it has come to rest, in its sizes per second.
double creepOf(const Slope& slope)
{
    SlopeRun run(slope);
    run.until(0.6);
    const Vec3 before = run.place();
    run.until(0.9);
    return (run.place() - before).norm() / (0.3 * kSize * slope.scale);
}

/// Acceleration downhill relative to Coulomb's.
double slideOf(const Slope& slope)
{
    SlopeRun run(slope);
    run.until(0.15);
    const double before = run.speed();
    run.until(0.35);
    return (run.speed() - before) / 0.2 / slope.coulomb();
}

/// Holds below the friction angle, and slides as Coulomb has it above.
void expectCoulomb(Slope slope, double below, double above, double creep = kLeastCreep, double share = 0.03)
{
    slope.steepness = below;
    EXPECT_LT(creepOf(slope), creep) << nameOf(slope);
    slope.steepness = above;
    EXPECT_NEAR(slideOf(slope), 1.0, share) << nameOf(slope);
}

template <class Body>
void forEachKind(Body&& body)
{
    for (FabricSolver solver : {FabricSolver::Vertex, FabricSolver::Grid})
        for (bool isYarn : {false, true}) {
            Slope slope;
            slope.solver = solver;
            slope.isYarn = isYarn;
            body(slope);
        }
}

TEST(StaticFriction, WhatItCanHoldStaysInAnyDirection)
{
    testing::Noise random(1);
    forEachKind([&](Slope slope) {
        for (double steepness : {0.5, 0.8, 0.97}) {
            slope.steepness = steepness;
            slope.turn = Eigen::Quaterniond(random(), random(), random(), random()).normalized();
            EXPECT_LT(creepOf(slope), kLeastCreep) << nameOf(slope);
        }
    });
}

/// Dropped from any height, tilted, at any scale, in any mesh and steps: what falls on a gentle slope comes to rest for good.
TEST(StaticFriction, WhatItCanHoldComesToRestFromAnyState)
{
    testing::Noise random(5);
    const auto between = [&](double least, double most) { return least + 0.5 * (random() + 1.0) * (most - least); };
    for (int i = 0; i < 4; ++i)
        forEachKind([&](Slope slope) {
            slope.steepness = between(0.1, 0.6);
            slope.scale = std::exp(between(-3.0, 3.0));
            slope.h = std::exp(between(std::log(5.0e-4), std::log(4.0e-3)));
            slope.turn = Eigen::Quaterniond(random(), random(), random(), random()).normalized();
            slope.nodes = static_cast<int>(between(4.0, 12.0));
            slope.height = between(0.0, 0.08);
            slope.tilt = between(-0.04, 0.04);
            EXPECT_LT(creepOf(slope), kLeastCreep) << nameOf(slope) << " nodes " << slope.nodes << " height " << slope.height;
        });
}

TEST(StaticFriction, WhatItCannotHoldSlidesAsCoulombHasIt)
{
    testing::Noise random(2);
    forEachKind([&](Slope slope) {
        for (double steepness : {1.05, 1.3, 2.0}) {
            slope.steepness = steepness;
            slope.turn = Eigen::Quaterniond(random(), random(), random(), random()).normalized();
            EXPECT_NEAR(slideOf(slope), 1.0, 0.03) << nameOf(slope);
        }
    });
}

TEST(StaticFriction, KnowsNoScale)
{
    forEachKind([&](Slope slope) {
        for (double scale : {0.01, 100.0}) {
            slope.scale = scale;
            expectCoulomb(slope, 0.95, 1.2);
        }
    });
}

TEST(StaticFriction, IsTheSameInStepsOfAnyLength)
{
    forEachKind([&](Slope slope) {
        for (double h : {5.0e-4, 4.0e-3}) {
            slope.h = h;
            // Solver grid looks at friction once per step, where it expects to be: 5 % more than Coulomb's in long steps.
            expectCoulomb(slope, 0.95, 1.3, kLeastCreep, slope.solver == FabricSolver::Grid ? 0.06 : 0.03);
        }
    });
}

TEST(StaticFriction, HoldsWetFabric)
{
    forEachKind([&](Slope slope) {
        slope.wetness = 0.5;
        expectCoulomb(slope, 0.9, 1.5);
    });
}

/// Fabric that starts with its slope stays on it: at a constant velocity, swung by 0.7 of what friction bears, and turned about a point far
/// away, where the way around is no straight line.
TEST(StaticFriction, GoesWithAMovingSolid)
{
    forEachKind([&](Slope slope) {
        slope.steepness = 0.8;
        const Vec3 velocity(20.0, 5.0, -30.0);
        slope.velocity = velocity;
        slope.motion.addTranslation(0.0, 10.0, 10.0 * velocity, 0.0, 0.0);
        EXPECT_LT(creepOf(slope), kShakenCreep) << "drifting " << nameOf(slope);

        slope.motion = {};
        slope.steepness = 0.0;
        constexpr double kFrequency = 4.0, kRate = 2.0 * kPi * kFrequency;  // 1/s
        const double amplitude = 0.7 * kFriction * kEarthGravity / (kRate * kRate);
        slope.velocity = amplitude * kRate * Vec3::UnitZ();
        slope.motion.addOscillation(0.0, 10.0, Vec3::UnitZ(), amplitude, kFrequency);
        EXPECT_LT(creepOf(slope), kShakenCreep) << "swung " << nameOf(slope);

        slope.motion = {};
        const Vec3 center(0.0, 0.0, 12.0);
        slope.velocity = Vec3::Zero();
        slope.motion.addRotation(0.0, 10.0, {Vec3::UnitY(), center}, 10.0, 0.2, 0.2);
        EXPECT_LT(creepOf(slope), kShakenCreep) << "turned " << nameOf(slope);
    });
}

/// The friction that is held is part of the state: a run that is gone on with from there is the same to the last bit.
TEST(StaticFriction, IsPartOfTheState)
{
    forEachKind([&](Slope slope) {
        slope.steepness = 0.95;
        SlopeRun whole(slope);
        whole.until(0.1);
        ASSERT_FALSE(whole.run.state().fabric.onObstacles.between.empty());
        State forgetful = whole.run.state();
        forgetful.fabric.onObstacles.clear();
        EXPECT_NE(stateHash(forgetful), stateHash(whole.run.state()));
        Simulation resumed(sceneOf(slope), whole.run.state());
        for (int i = 0; i < 20; ++i) {
            whole.run.step(1.0);
            resumed.step(1.0);
        }
        EXPECT_EQ(stateHash(resumed.state()), stateHash(whole.run.state())) << nameOf(slope);
    });
}

/// Where contact ends the spring is forgotten.
TEST(StaticFriction, EndsWithContact)
{
    forEachKind([&](Slope slope) {
        slope.motion.addTranslation(0.1, 0.2, -5.0 * Vec3::UnitY(), 0.0, 0.0);  // away from under it
        SlopeRun run(slope);
        run.until(0.09);
        EXPECT_FALSE(run.run.state().fabric.onObstacles.between.empty()) << nameOf(slope);
        run.until(0.15);
        EXPECT_TRUE(run.run.state().fabric.onObstacles.between.empty()) << nameOf(slope);
    });
}

}  // namespace
}  // namespace sim::test
