#include "tests/physics/fabric_runs.h"

#include <gtest/gtest.h>

#include <numeric>
#include <optional>

// Coulomb friction of fabric on obstacles and on fabric, and how far it reaches into them (fabric/README.md, Friction).

namespace sim::test {
namespace {

using testing::pieceOf;

constexpr double kPi180 = kPi / 180.0;

ObstacleSettings obstacle(const Shape& shape)
{
    ObstacleSettings o;
    o.name = "obstacle";
    o.shape = shape;
    return o;
}

/// A sheet that lies on a plane, which is tilted by tilting gravity.
struct Incline {
    Incline(double degrees, double friction)
    {
        ClothGrid grid;
        grid.nodes = Vec2i(6, 6);
        grid.spacing = {0.2, 0.2};
        grid.origin = Vec3(0.0, 1.25 * 0.05, 0.0);  // where contact begins
        FabricPiece piece = pieceOf(clothGrid(grid), testing::wool(), {0.05, 0.05});
        piece.material.frictionAngle = std::atan(friction);
        run.emplace(piece, FabricSettings{}, std::vector{obstacle(Shape::box(Vec3(0.0, -2.0, 0.0), Vec3(50.0, 2.0, 50.0)))});
        run->gravity = kEarthGravity * Vec3(std::sin(degrees * kPi180), -std::cos(degrees * kPi180), 0.0);
    }
    double speed() const { return run->momentum().x() / totalMass(); }
    double totalMass() const
    {
        double m = 0.0;
        for (double v : run->fabric.mass) m += v;
        return m;
    }
    std::optional<FabricRun> run;
};

TEST(Incline, RestsBelowTheFrictionAngleAndSlidesAboveIt)
{
    constexpr double kAngle = 30.0, h = 5.0e-5;
    Incline below(kAngle - 1.0, std::tan(kAngle * kPi180)), above(kAngle + 1.0, std::tan(kAngle * kPi180));
    below.run->steps(2000, h);
    const double creep = below.speed();
    below.run->steps(1000, h);
    EXPECT_LT(below.speed(), 1.0);
    EXPECT_NEAR(below.speed(), creep, 0.02);

    for (Vec3& v : above.run->state.v) v.x() = 100.0;
    above.run->steps(200, h);
    const double first = above.speed();
    above.run->steps(2000, h);
    const double a = (kAngle + 1.0) * kPi180, exact = kEarthGravity * (std::sin(a) - std::tan(kAngle * kPi180) * std::cos(a));
    EXPECT_NEAR((above.speed() - first) / (2000 * h), exact, 0.02 * exact);
    RecordProperty("creep", std::to_string(below.speed()) + " above " + std::to_string((above.speed() - first) / (2000 * h) / exact));
}

/// g (sin α − μ cos α) = 235.6 cm/s² at 30 degrees, μ = 0.3.
TEST(Incline, SlidesAtCoulombsAcceleration)
{
    Incline incline(30.0, 0.3);
    incline.run->steps(300, 1.0e-3);  // fast against the 0.24 cm/s of a step by which the lagged friction is late
    const double before = incline.speed();
    incline.run->steps(200, 1.0e-3);
    EXPECT_NEAR((incline.speed() - before) / 0.2, 235.6, 0.005 * 235.6);
    RecordProperty("acceleration", std::to_string((incline.speed() - before) / 0.2));
}

/// The same on cloth that is held: a small sheet slides down a long one.
struct ClothOnCloth {
    ClothOnCloth(double degrees, double friction)
    {
        ClothGrid grid;
        grid.nodes = Vec2i(41, 11);
        grid.spacing = {0.25, 0.25};
        FabricPiece lower = pieceOf(clothGrid(grid), testing::wool(), {0.05, 0.05});
        std::vector<int> all(lower.points.size());
        std::iota(all.begin(), all.end(), 0);
        lower.pins.push_back(pinned(all));
        held = static_cast<int>(all.size());
        grid.nodes = Vec2i(6, 6);
        grid.spacing = {0.2, 0.2};
        grid.origin = Vec3(0.57, 2.2 * 0.05, 0.73);
        FabricPiece upper = pieceOf(clothGrid(grid), testing::wool(), {0.05, 0.05});
        lower.material.frictionAngle = upper.material.frictionAngle = std::atan(friction);
        FabricSettings settings;
        run.emplace(std::vector{lower, upper}, settings);
        run->gravity = kEarthGravity * Vec3(std::sin(degrees * kPi180), -std::cos(degrees * kPi180), 0.0);
    }
    double speed() const
    {
        double momentum = 0.0, sum = 0.0;
        for (std::size_t v = held; v < run->state.v.size(); ++v) momentum += run->fabric.mass[v] * run->state.v[v].x(), sum += run->fabric.mass[v];
        return momentum / sum;
    }
    std::optional<FabricRun> run;
    int held = 0;
};

TEST(ClothOnCloth, SlidesAtCoulombsAcceleration)
{
    for (double h : {1.0e-3, 2.0e-4}) {
        ClothOnCloth cloth(30.0, 0.3);
        cloth.run->steps(static_cast<int>(0.05 / h), h);
        const double before = cloth.speed();
        cloth.run->steps(static_cast<int>(0.1 / h), h);
        // Where edges meet at a slant their normal forces add up to more than the weight: up to 5 % of it in this mesh, by the place.
        const double steepness = std::sin(30.0 * kPi180), perNormal = 0.3 * std::cos(30.0 * kPi180);
        const double friction = steepness - (cloth.speed() - before) / 0.1 / kEarthGravity;
        EXPECT_NEAR(friction, 1.03 * perNormal, 0.04 * perNormal) << h;
    }
}

/// Friction takes its force times the way, from obstacles and from fabric alike (sim/README.md, Energy).
TEST(Incline, FrictionTakesItsForceTimesTheWay)
{
    Incline incline(30.0, 0.3);
    incline.run->steps(300, 1.0e-3);
    incline.run->solver.bookEnergy();
    const double from = incline.run->state.x[0].x(), before = incline.run->energies().total();
    EnergyChanges all;
    for (int i = 0; i < 200; ++i) all += *incline.run->step(1.0e-3).energyChanges;
    const double weight = incline.totalMass() * kEarthGravity * std::cos(30.0 * kPi180), way = incline.run->state.x[0].x() - from;
    EXPECT_NEAR(all[EnergyChange::Obstacles], -0.3 * weight * way, 0.01 * 0.3 * weight * way);
    const double unbooked = incline.run->energies().total() - before - std::accumulate(all.of.begin(), all.of.end(), 0.0);
    EXPECT_LT(std::abs(unbooked), 0.01 * 0.3 * weight * way);
}

TEST(ClothOnCloth, FrictionTakesItsForceTimesTheWay)
{
    ClothOnCloth cloth(30.0, 0.3);
    cloth.run->steps(50, 1.0e-3);
    cloth.run->solver.bookEnergy();
    const double before = cloth.run->energies().total(), potential = cloth.run->energies().potential, from = cloth.speed();
    EnergyChanges all;
    for (int i = 0; i < 100; ++i) all += *cloth.run->step(1.0e-3).energyChanges;
    const double given = potential - cloth.run->energies().potential;
    // Of what gravity gives friction takes tan 17°/tan 30°, and up to 7 % more (see above).
    EXPECT_NEAR(-all[EnergyChange::Friction] / given, 1.03 * 0.3 / std::tan(30.0 * kPi180), 0.04 * 0.52) << from;
    const double unbooked = cloth.run->energies().total() - before - std::accumulate(all.of.begin(), all.of.end(), 0.0);
    EXPECT_LT(std::abs(unbooked), 0.01 * given);
}

/// A yarn drawn over half a fixed cylinder, a mass on its other end: the tensions differ by e^{μψ}.
TEST(Capstan, HoldsByTheExponentialOfItsAngle)
{
    constexpr double kRadius = 2.0, kYarn = 0.02, kFriction = 0.3, kEdge = 0.1, kSpeed = 10.0;
    const double around = kRadius + kYarn;
    // Up on one side, over the top, down on the other; at rest it is straight and bends with next to no resistance.
    std::vector<Vec3> path;
    const int legs = 30, arc = static_cast<int>(std::lround(kPi * around / kEdge));
    for (int i = legs; i > 0; --i) path.emplace_back(-around, -kEdge * i, 0.0);
    for (int i = 0; i <= arc; ++i) path.emplace_back(-around * std::cos(kPi * i / arc), around * std::sin(kPi * i / arc), 0.0);
    for (int i = 1; i <= legs; ++i) path.emplace_back(around, -kEdge * i, 0.0);
    FabricPiece piece = pieceOf(strand(path), solidFibre(1.0e7), {kYarn, kYarn});
    piece.material.frictionAngle = std::atan(kFriction);
    const int last = static_cast<int>(path.size()) - 1;
    Motion draw;
    draw.addTranslation(0.0, 10.0, Vec3(0.0, -10.0 * kSpeed, 0.0), 0.0, 0.0);
    piece.pins.push_back(pinned({last}, false, draw));
    const double hung = 0.5;  // g; the yarn itself has 0.02
    FabricRun run(piece, FabricSettings{}, {obstacle(Shape::cylinder(Vec3::Zero(), Vec3::UnitZ(), kRadius, 5.0, 0.0))},
                  [&](Fabric& fabric) { fabric.mass[0] += hung; });
    // Means while the yarn moves by several edges.
    run.steps(200, 5.0e-4);
    double before = 0.0, after = 0.0;
    for (int i = 0; i < 200; ++i) {
        run.step(5.0e-4);
        before += run.tension(2);
        after += run.tension(last - 3);
    }
    EXPECT_NEAR(after / before, std::exp(kFriction * kPi), 0.03 * std::exp(kFriction * kPi));
    RecordProperty("ratio", std::to_string(after / before) + " T1/mg " + std::to_string(before / 200 / (hung * kEarthGravity)));
}

/// Cloth dropped on a ball comes to lie on it, deeper than its thickness nowhere by more than contact's reach.
TEST(ClothOnABall, RestsWithinTheReachOfContact)
{
    for (double friction : {0.0, 0.6}) {
        constexpr int kNodes = 21;
        ClothGrid grid;
        grid.nodes = Vec2i(kNodes, kNodes);
        grid.spacing = {0.15, 0.15};
        grid.origin = Vec3(-1.3, 1.1, -1.5);
        FabricPiece piece = pieceOf(clothGrid(grid), testing::wool(), {0.03, 0.03});
        piece.material.frictionAngle = std::atan(friction);
        FabricRun run(piece, FabricSettings{}, {obstacle(Shape::ball(Vec3::Zero(), 1.0))});
        double deepest = -1.0;
        for (int i = 0; i < 250; ++i) {
            run.step(1.0e-3);
            deepest = std::max(deepest, run.solver.deepestInObstacles(run.state));
        }
        EXPECT_LT(deepest, 0.25 * 0.03) << friction;
        RecordProperty("deepest" + std::to_string(friction),
                       std::to_string(deepest) + " middle " + std::to_string(run.state.x[kNodes * kNodes / 2].y()));
    }
}

/// An upright blade, thinner than the meshes of what falls on it, stands between two rows of vertices: the middles of edges hang on it.
TEST(FabricOnABlade, DoesNotFallThrough)
{
    constexpr int kNodes = 12;
    constexpr double kSpacing = 0.15, kRadius = 0.03, kFirst = -0.5 * (kNodes - 1) * kSpacing;
    ClothGrid grid;
    grid.nodes = Vec2i(kNodes, kNodes);
    grid.spacing = {kSpacing, kSpacing};
    grid.origin = Vec3(kFirst, 0.1, kFirst);
    const FabricPiece pieces[] = {pieceOf(clothGrid(grid), testing::wool(), {kRadius, kRadius}),
                                  pieceOf(strand(Vec3(kFirst, 0.1, 0.0), Vec3(-kFirst, 0.1, 0.0), kNodes - 1), testing::wool(), {kRadius, kRadius})};
    for (FabricPiece piece : pieces) {
        piece.material.frictionAngle = std::atan(0.6);
        FabricRun run(piece, FabricSettings{}, {obstacle(Shape::box(Vec3(0.0, -2.0, 0.0), Vec3(0.01, 2.0, 3.0)))});
        double deepest = -1.0;
        for (int i = 0; i < 300; ++i) {
            run.step(1.0e-3);
            deepest = std::max(deepest, run.solver.deepestInObstacles(run.state));
        }
        EXPECT_LT(deepest, kRadius) << run.fabric.vertexCount();  // the blade's edge comes nowhere through
        RecordProperty("deepest" + std::to_string(run.fabric.vertexCount()), std::to_string(deepest));
    }
}

}  // namespace
}  // namespace sim::test
