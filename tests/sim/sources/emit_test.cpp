#include "sim/sources/emit.h"

#include "sim/core/check.h"
#include "sim/shapes/volume.h"
#include "sim/sources/seed.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>
#include <set>

namespace sim {
namespace {

using Pattern = FillSettings::Pattern;

SourceSettings sourceOf(const std::string& name, const Shape& shape, Pattern pattern, const Emission& emission)
{
    SourceSettings source;
    source.name = name;
    source.shape = shape;
    source.fill.pattern = pattern;
    source.emissions = {emission};
    return source;
}

Scene sceneWith(const Shape& shape, const Emission& emission, Pattern pattern = Pattern::Lattice)
{
    Scene scene;
    scene.file = "pour.yaml";
    scene.settings.cell = 0.288;
    scene.settings.liquid.density = 1.25;
    scene.sources.push_back(sourceOf("jet", shape, pattern, emission));
    return scene;
}

double liquidMass(const State& s) { return std::accumulate(s.liquid.mass.data(), s.liquid.mass.data() + s.liquid.count, 0.0); }

/// Let all particles fly on as they are.
void fly(State& s, double dt)
{
    for (std::size_t p = 0; p < s.liquid.count; ++p)
        for (int a = 0; a < kAxes; ++a) s.liquid.x[a][p] += dt * s.liquid.mode(a, 0)[p];
}

void expectLedgerIsExact(const Scene& scene, const State& s)
{
    const double emitted = std::accumulate(s.emittedVolume.begin(), s.emittedVolume.end(), 0.0);
    EXPECT_NEAR(s.ledger.emittedMass, liquidMass(s), 1e-12 * liquidMass(s));
    EXPECT_NEAR(emitted * scene.settings.liquid.density, liquidMass(s), 1e-12 * liquidMass(s));
    std::set<std::uint32_t> ids(s.liquid.id.data(), s.liquid.id.data() + s.liquid.count);
    EXPECT_EQ(ids.size(), s.liquid.count);
    EXPECT_EQ(s.nextId, s.liquid.count);
}

/// Velocities of a formula, and its gradient in the modes that hold one.
TEST(Emit, ABodyMovesByItsFormulas)
{
    for (const int modes : {1, 4, 8}) {
        Emission emission;
        emission.velocity = {1.0, 2.0, 3.0};
        Scene scene = sceneWith(Shape::ball(Vec3(0.1, 0.2, 0.3), 1.0), emission);
        scene.sources[0].velocityField = VelocityField({"3 * y - x", "sin(pi * x) * z", "x > 0 ? 2 : -1"});
        State s;
        s.grid.dx = scene.settings.cell;
        s.liquid.modeCount = modes;
        emitLiquid(scene, s, 0.0, 0.0);
        ASSERT_GT(s.liquid.count, 100u);
        for (std::size_t p = 0; p < s.liquid.count; ++p) {
            const Vec3 x = s.liquid.position(p);
            const Vec3 expected(1.0 + 3.0 * x.y() - x.x(), 2.0 + std::sin(kPi * x.x()) * x.z(), 3.0 + (x.x() > 0.0 ? 2.0 : -1.0));
            EXPECT_LT((s.liquid.velocity(p) - expected).norm(), 1e-12);
            if (modes < 4 || std::abs(x.x()) < 1.0e-3) continue;
            const Mat3 gradient =
                (Mat3() << -1.0, 3.0, 0.0, kPi * std::cos(kPi * x.x()) * x.z(), 0.0, std::sin(kPi * x.x()), 0.0, 0.0, 0.0).finished();
            for (int a = 0; a < kAxes; ++a)
                for (int b = 0; b < kAxes; ++b) EXPECT_NEAR(s.liquid.mode(a, 1 + b)[p], s.grid.dx * gradient(a, b), 1e-7);
        }
    }
}

TEST(Emit, AFormulaWithoutAValueIsNamed)
{
    Scene scene = sceneWith(Shape::ball(Vec3::Zero(), 1.0), Emission());
    scene.sources[0].velocityField = VelocityField({"0", "1 / (x - x)", "0"});
    State s;
    s.grid.dx = scene.settings.cell;
    try {
        emitLiquid(scene, s, 0.0, 0.0);
        FAIL();
    } catch (const InputError& error) {
        EXPECT_NE(std::string(error.what()).find("pour.yaml: source 1 \"jet\" velocity_field: \"1 / (x - x)\": has no finite value at ("),
                  std::string::npos)
            << error.what();
    }
}

TEST(Emit, ABodyIsLaidOnceAndWhole)
{
    Emission emission;
    emission.velocity = {1.0, 2.0, 3.0};
    const Scene scene = sceneWith(Shape::ball(Vec3::Zero(), 1.0), emission);
    State s;
    s.liquid.modeCount = 4;
    emitLiquid(scene, s, 0.0, 0.0);
    const std::size_t count = s.liquid.count;
    EXPECT_NEAR(s.emittedVolume[0], boundedVolume(scene.sources[0].shape, 0.288), 1e-12);
    expectLedgerIsExact(scene, s);
    EXPECT_TRUE(s.liquid.velocity(count / 2).isApprox(emission.velocity));
    for (int r = 1; r < 4; ++r) EXPECT_EQ(s.liquid.mode(1, r)[count / 2], 0.0);
    for (int step = 0; step < 3; ++step) emitLiquid(scene, s, step * 0.01, (step + 1) * 0.01);
    EXPECT_EQ(s.liquid.count, count);
}

TEST(Emit, ABodyMayComeLater)
{
    Emission emission;
    emission.from = emission.to = 0.02;
    const Scene scene = sceneWith(Shape::ball(Vec3::Zero(), 1.0), emission);
    State s;
    emitLiquid(scene, s, 0.0, 0.0);
    emitLiquid(scene, s, 0.0, 0.015);
    EXPECT_EQ(s.liquid.count, 0u);
    emitLiquid(scene, s, 0.015, 0.03);
    EXPECT_GT(s.liquid.count, 0u);
    expectLedgerIsExact(scene, s);
}

TEST(Emit, AJetGivesItsSpeedTimesItsArea)
{
    // Sides that are no whole numbers of pitches, a length of a few cells.
    const Shape nozzle = Shape::box(Vec3::Zero(), {0.5, 0.33, 0.41});
    for (Pattern pattern : {Pattern::Lattice, Pattern::Jittered, Pattern::Poisson}) {
        Emission emission;
        emission.to = 10.0;
        emission.velocity = {0.0, 0.0, -20.0};
        const Scene scene = sceneWith(nozzle, emission, pattern);
        State s;
        emitLiquid(scene, s, 0.0, 0.0);
        constexpr double kDt = 1.37e-3;
        constexpr int kSteps = 300;
        const double initial = s.emittedVolume[0], flow = 20.0 * 4.0 * 0.5 * 0.33;
        for (int step = 0; step < kSteps; ++step) {
            emitLiquid(scene, s, step * kDt, (step + 1) * kDt);
            fly(s, kDt);
        }
        expectLedgerIsExact(scene, s);
        const double tolerance = pattern == Pattern::Lattice ? 0.01 : 0.03;
        EXPECT_NEAR((s.emittedVolume[0] - initial) / (flow * kSteps * kDt), 1.0, tolerance) << static_cast<int>(pattern);
        EXPECT_NEAR(initial / boundedVolume(nozzle, 0.1), 1.0, 0.12);
    }
}

TEST(Emit, ALatticeJetHasNoGaps)
{
    Emission emission;
    emission.to = 10.0;
    emission.velocity = {30.0, 0.0, 0.0};
    const Scene scene = sceneWith(Shape::box(Vec3::Zero(), {0.3, 0.25, 0.25}), emission);
    State s;
    std::vector<std::size_t> counts;
    for (int step = 0; step < 100; ++step) {
        emitLiquid(scene, s, step * 1e-3, (step + 1) * 1e-3);
        fly(s, 1e-3);
    }
    // One layer after another, a pitch apart.
    std::set<long> layers;
    double first = 1e9;
    for (std::size_t p = 0; p < s.liquid.count; ++p) first = std::min(first, s.liquid.x[0][p]);
    for (std::size_t p = 0; p < s.liquid.count; ++p) {
        const double q = (s.liquid.x[0][p] - first) / 0.1152;
        EXPECT_NEAR(q, std::round(q), 1e-6);
        layers.insert(std::lround(q));
    }
    EXPECT_EQ(layers.size(), static_cast<std::size_t>(*layers.rbegin() + 1));
    EXPECT_EQ(s.liquid.count % layers.size(), 0u);
}

TEST(Emit, StillLiquidInASpringStaysAsItIs)
{
    Emission emission;
    emission.to = 1.0;
    for (Pattern pattern : {Pattern::Lattice, Pattern::Reference, Pattern::Jittered, Pattern::Poisson}) {
        const Scene scene = sceneWith(Shape::ball(Vec3::Zero(), 1.0), emission, pattern);
        State s;
        emitLiquid(scene, s, 0.0, 0.0);
        const std::size_t count = s.liquid.count;
        for (int step = 0; step < 5; ++step) emitLiquid(scene, s, step * 0.01, (step + 1) * 0.01);
        EXPECT_EQ(s.liquid.count, count);
    }
}

TEST(Emit, MaxVolumeIsPassedByLessThanAParticle)
{
    for (Pattern pattern : {Pattern::Lattice, Pattern::Reference}) {
        Emission emission;
        emission.to = 10.0;
        emission.maxVolume = 1.2345;
        emission.velocity = {0.0, -50.0, 0.0};
        const Scene scene = sceneWith(Shape::box(Vec3::Zero(), Vec3::Constant(0.4)), emission, pattern);
        State s;
        for (int step = 0; step < 200; ++step) {
            emitLiquid(scene, s, step * 1e-3, (step + 1) * 1e-3);
            fly(s, 1e-3);
        }
        EXPECT_GE(s.emittedVolume[0], 1.2345);
        EXPECT_LT(s.emittedVolume[0], 1.2345 + 2e-3);
        expectLedgerIsExact(scene, s);
    }
}

TEST(Emit, OverlappingBodiesShareTheirLiquid)
{
    Scene scene = sceneWith(Shape::box(Vec3::Zero(), Vec3::Constant(1.0)), {});
    scene.sources.push_back(sourceOf("other", Shape::box({1.0, 0.1, 0.2}, Vec3::Constant(1.0)), Pattern::Lattice, {}));
    State s;
    emitLiquid(scene, s, 0.0, 0.0);
    const Shape both = Shape::unite({scene.sources[0].shape, scene.sources[1].shape});
    EXPECT_NEAR((s.emittedVolume[0] + s.emittedVolume[1]) / boundedVolume(both, 0.1), 1.0, 0.03);
    expectLedgerIsExact(scene, s);
}

TEST(Emit, ObstaclesKeepTheirPlaceWhereverTheyHaveMoved)
{
    Emission emission;
    emission.from = emission.to = 1.0;
    Scene scene = sceneWith(Shape::box(Vec3::Zero(), Vec3::Constant(1.0)), emission);
    ObstacleSettings obstacle;
    obstacle.shape = Shape::ball({-5.0, 0.0, 0.0}, 0.5);
    obstacle.motion.addTranslation(0.0, 0.5, {5.0, 0.0, 0.0}, 0.1, 0.1);
    scene.obstacles.push_back(obstacle);
    State s;
    emitLiquid(scene, s, 0.99, 1.01);
    EXPECT_GT(s.liquid.count, 1000u);
    for (std::size_t p = 0; p < s.liquid.count; ++p) EXPECT_GT(s.liquid.position(p).norm(), 0.5);
}

TEST(Emit, SaysWhichSourceHasNoRoom)
{
    Scene scene = sceneWith(Shape::ball(Vec3::Zero(), 0.001).moved(Eigen::Isometry3d(Eigen::Translation3d(0.0, 1.0, 0.0))), {});
    ObstacleSettings floor;
    floor.shape = Shape::box({0.0, 1.0, 0.0}, Vec3::Ones());
    scene.obstacles.push_back(floor);
    State s;
    try {
        emitLiquid(scene, s, 0.0, 0.0);
        FAIL() << "an empty source was accepted";
    } catch (const InputError& e) {
        EXPECT_NE(std::string(e.what()).find("pour.yaml: source 1 \"jet\" has no room"), std::string::npos) << e.what();
    }
    scene.obstacles.clear();
    scene.sources[0].shape = Shape::ball(Vec3::Zero(), 1.0).inverted();
    try {
        emitLiquid(scene, s, 0.0, 0.0);
        FAIL() << "an unbounded source was accepted";
    } catch (const InputError& e) {
        EXPECT_NE(std::string(e.what()).find("pour.yaml: source 1 \"jet\" is unbounded"), std::string::npos) << e.what();
    }
}

}  // namespace
}  // namespace sim
