#include "sim/step_check.h"

#include "sim/fabric/pieces/generators.h"
#include "sim/simulation.h"
#include "tests/physics/runs.h"
#include "tests/sim/fabric/pieces.h"

#include <gtest/gtest.h>

#include <limits>

// What a step is reproached with.

namespace sim::test {
namespace {

/// A pool at rest and a sheet above it, a state and a report of a step of 1e-3 s in which nothing went wrong.
struct Sample {
    Scene scene = tankScene(kPoly8, 1.0, {8.0, 8.0, 8.0}, {0.0, 0.0, 0.0}, {8.0, 4.0, 8.0});
    std::optional<Simulation> simulation;
    std::optional<StepCheck> check;
    StepReport report;
    State state;  ///< at the end of the step, with the memory of before

    explicit Sample(const Motion& pinMotion = {})
    {
        scene.settings.time.mode = TimeMode::Adaptive;
        scene.settings.time.integrator = TimeIntegrator::Plain;  // one step of 1e-3 s, not two
        scene.settings.time.dt = 1.0e-3;
        FabricPiece cloth = testing::pieceOf(clothGrid({{5, 5}, {0.5, 0.5}, Vec3(3.0, 6.0, 3.0)}), testing::wool(), {0.01, 0.01});
        cloth.name = "sheet";
        PinGroup corner;
        corner.vertices = {0};
        corner.motion = pinMotion;
        cloth.pins.push_back(corner);
        scene.fabrics.push_back(cloth);
        simulation.emplace(scene);
        check.emplace(simulation->scene(), simulation->fabric());
        const StepHistory before = simulation->state().memory;
        report = simulation->step(1.0e-3);
        state = simulation->state();
        state.memory = before;
    }
    std::optional<StepFailure> rejectionReason() const { return check->rejectionReason(state, report); }
    std::optional<StepFailure> violatedInvariant() const { return check->violatedInvariant(state, report); }
};

TEST(StepCheck, FindsNothingInAGoodStep)
{
    const Sample good;
    EXPECT_FALSE(good.violatedInvariant());
    EXPECT_FALSE(good.rejectionReason());
}

TEST(StepCheck, FindsSpuriousEnergy)
{
    Sample sample;
    const double mass = sample.report.liquidMass;
    sample.report.energies.kinetic = 0.5 * mass * 20.0 * 20.0;  // all at 20 cm/s after a thousandth of a second
    ASSERT_TRUE(sample.rejectionReason());
    EXPECT_EQ(sample.rejectionReason()->stage, Stage::GridToParticles);
    EXPECT_NE(sample.rejectionReason()->what.find("particle "), std::string::npos);

    Sample cloth;
    cloth.report.energies.fabric.membrane = 1.0e6;
    ASSERT_TRUE(cloth.rejectionReason());
    EXPECT_EQ(cloth.rejectionReason()->stage, Stage::FabricSolve);
    EXPECT_NE(cloth.rejectionReason()->what.find(" of sheet at "), std::string::npos) << cloth.rejectionReason()->what;
}

TEST(StepCheck, LetsGravityAndSourcesGiveEnergy)
{
    Sample sample;
    const double mass = sample.report.liquidMass, speed = 981.0 * 1.0e-3;
    sample.report.energies.kinetic = 0.5 * mass * speed * speed;  // free fall from rest
    EXPECT_FALSE(sample.rejectionReason());
    sample.report.energies.kinetic = sample.report.emittedKinetic = 1.0e6;
    EXPECT_FALSE(sample.rejectionReason());
}

TEST(StepCheck, LetsContactGiveBackWhatItTook)
{
    Sample sample;
    StepReport fast = sample.report;
    fast.energies.fabric.kinetic = 1.0e6;
    StepCheck::accept(fast, sample.state.memory);
    for (int step = 0; step < 5; ++step) StepCheck::accept(sample.report, sample.state.memory);
    sample.report.energies.fabric.kinetic = 1.0e6;
    EXPECT_FALSE(sample.rejectionReason());
    sample.report.energies.fabric.kinetic = 1.2e6;
    EXPECT_TRUE(sample.rejectionReason());
}

TEST(StepCheck, LetsPinsDrive)
{
    Motion pull;
    pull.addTranslation(0.0, 1.0, {100.0, 0.0, 0.0}, 0.0, 0.0);
    Sample driven(pull);
    driven.report.energies.fabric.membrane += 1.0e6;  // wound up by the pin
    EXPECT_FALSE(driven.rejectionReason());
    driven.report.energies.fabric.kinetic += 1.0e8;  // far more than being thrown at the pin's speed
    EXPECT_TRUE(driven.rejectionReason());
}

/// Leaves what is not a number where the next functions have their variables.
[[gnu::noinline]] void spoilStack()
{
    volatile double spoilt[4096];
    for (volatile double& x : spoilt) x = std::numeric_limits<double>::quiet_NaN();
}

TEST(StepCheck, FindsNothingWhereNothingIsLeft)
{
    Scene scene = tankScene(kPoly8, 1.0, {8.0, 8.0, 8.0}, {0.0, 0.0, 0.0}, {8.0, 4.0, 8.0});
    scene.settings.time.mode = TimeMode::Adaptive;
    ObstacleSettings plate;
    plate.name = "plate";
    plate.shape = Shape::box(Vec3(4.0, 4.0, 4.0), Vec3(1.0, 0.1, 1.0));
    plate.motion.addRotation(0.0, 1.0, {Vec3::UnitX(), Vec3(4.0, 4.0, 4.0)}, 3.0, 0.0, 0.0);
    scene.obstacles.push_back(plate);
    const Fabric none;
    const StepCheck check(scene, none);
    State state;
    state.time = 0.5;
    StepReport report;
    report.dt = 1.0e-3;
    check.start(report.energies, state.memory);
    spoilStack();
    const std::optional<StepFailure> fault = check.rejectionReason(state, report);
    EXPECT_FALSE(fault) << fault->what;
}

TEST(StepCheck, FindsTooLargeDisplacements)
{
    Sample sample;
    sample.report.maxSpeed = 3000.0;  // 3 cells in the step that was to be at most 1 of them
    ASSERT_TRUE(sample.rejectionReason());
    EXPECT_NE(sample.rejectionReason()->what.find("crossed 3 cells"), std::string::npos) << sample.rejectionReason()->what;
}

TEST(StepCheck, FindsFabricThatJumpsIntoObstacles)
{
    Sample sample;
    sample.report.fabric.deepest = 0.3;
    EXPECT_FALSE(sample.rejectionReason()) << "where it begins is the scene's business";
    sample.report.fabric.deepest = 0.0;
    StepCheck::accept(sample.report, sample.state.memory);
    sample.report.fabric.deepest = 0.2;
    EXPECT_FALSE(sample.rejectionReason());
    sample.report.fabric.deepest = 0.3;
    ASSERT_TRUE(sample.rejectionReason());
    EXPECT_EQ(sample.rejectionReason()->stage, Stage::FabricContact);
    sample.report.fabric.deepest = 0.2;
    StepCheck::accept(sample.report, sample.state.memory);
    sample.report.fabric.deepest = 0.3;
    EXPECT_FALSE(sample.rejectionReason()) << "it is squeezed there little by little";
}

TEST(StepCheck, FindsLostLiquid)
{
    Sample sample;
    sample.report.liquidMass *= 1.0 - 1.0e-8;
    ASSERT_TRUE(sample.violatedInvariant());
    EXPECT_NE(sample.violatedInvariant()->what.find("are not accounted for"), std::string::npos);
}

TEST(StepCheck, NamesWhatIsNotFinite)
{
    Sample sample;
    State state = sample.simulation->state();
    state.liquid.mode(1, 0)[7] = std::numeric_limits<double>::quiet_NaN();
    sample.report.failure = "velocities are not finite";
    const auto fault = sample.check->violatedInvariant(state, sample.report);
    ASSERT_TRUE(fault);
    EXPECT_NE(fault->what.find("particle " + std::to_string(state.liquid.id[7]) + " at "), std::string::npos) << fault->what;
}

}  // namespace
}  // namespace sim::test
