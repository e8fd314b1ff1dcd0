// Galileo: free liquid goes its way whatever happens in it, and a flow is the same seen from a frame that moves.
#include "tests/physics/random_vector.h"
#include "tests/physics/runs.h"

#include <gtest/gtest.h>

#include <vector>

namespace sim::test {
namespace {

/// Velocities that strain and turn a body, by a quadratic polynomial of the position [cm/s].
struct Flow {
    Mat3 gradient;  ///< [1/s]
    Vec3 bend;      ///< [1/(cm s)]
    Vec3 mean;      ///< [cm/s]

    Vec3 operator()(const Vec3& x) const { return mean + gradient * x + bend.cwiseProduct(x.cwiseProduct(x)); }
};

Flow randomFlow(Random& random)
{
    Flow flow;
    for (int a = 0; a < kAxes; ++a) flow.gradient.col(a) = anywhere(10.0, random);
    flow.gradient -= flow.gradient.trace() / 3.0 * Mat3::Identity();
    flow.bend = anywhere(3.0, random);
    flow.mean = anywhere(60.0, random);
    return flow;
}

/// A ball and a box of liquid, near enough to meet, far from everything else.
Scene freeLiquid(const Transfer& transfer, TimeIntegrator integrator, Random& random)
{
    Scene scene;
    scene.name = "free liquid";
    scene.settings.cell = 0.25;
    scene.settings.gravity = anywhere(600.0, random);
    scene.settings.transfer.method = transfer.method;
    scene.settings.transfer.modes = transfer.modes;
    scene.settings.transfer.flipRatio = 1.0;
    scene.settings.time.integrator = integrator;
    const Shape shapes[] = {Shape::ball(anywhere(0.1, random), between(0.6, 0.9, random)),
                            Shape::box(Vec3(1.5, 0.0, 0.0) + anywhere(0.2, random), Vec3::Constant(0.4) + anywhere(0.1, random))};
    for (const Shape& shape : shapes) {
        SourceSettings source;
        source.shape = shape;
        source.emissions.push_back({});
        scene.sources.push_back(source);
    }
    return scene;
}

/// The scene's liquid moving with `flow`, which every particle knows with its gradient.
Simulation movingWith(const Scene& scene, const Flow& flow)
{
    return moving(scene, [&](const Vec3& x) { return flow(x); });
}

struct Centre {
    Vec3 x = Vec3::Zero(), v = Vec3::Zero();
};

Centre centreOf(const State& state)
{
    Centre sum;
    double mass = 0.0;
    for (std::size_t p = 0; p < state.liquid.count; ++p) {
        sum.x += state.liquid.mass[p] * state.liquid.position(p);
        sum.v += state.liquid.mass[p] * state.liquid.velocity(p);
        mass += state.liquid.mass[p];
    }
    return {sum.x / mass, sum.v / mass + state.memory.sinceMidstep};
}

TEST(Galileo, CentreOfMassOfFreeLiquidIsBallistic)
{
    Random random(30);
    for (const Transfer& transfer : kTransfers)
        for (const TimeMode mode : {TimeMode::Fixed, TimeMode::Cfl}) {
            Scene scene = freeLiquid(transfer, TimeIntegrator::Reflected, random);
            scene.settings.time.mode = mode;
            scene.settings.time.dt = mode == TimeMode::Fixed ? 1.5e-3 : 1.0;
            scene.settings.time.cfl = between(0.3, 1.0, random);
            Simulation simulation = movingWith(scene, randomFlow(random));
            const Centre start = centreOf(simulation.state());
            while (simulation.state().time < 0.04) simulation.step(0.04);
            const double t = simulation.state().time;
            const Vec3 expected = start.x + t * start.v + 0.5 * t * t * scene.settings.gravity;
            const double way = (expected - start.x).norm();
            const Centre now = centreOf(simulation.state());
            const Vec3 gained = t * scene.settings.gravity;
            EXPECT_LT((now.x - expected).norm(), 1.0e-10 * way) << transfer.name << ", mode " << static_cast<int>(mode);
            EXPECT_LT((now.v - start.v - gained).norm(), 1.0e-10 * gained.norm()) << transfer.name << ", mode " << static_cast<int>(mode);
        }
}

/// A pool on a floor that bears it has no velocity, and no more than weight is reckoned beyond what particles hold where a drop hits the pool.
TEST(Galileo, MeanVelocityHasWhatActsAgainstWeight)
{
    for (const Transfer& transfer : kTransfers)
        for (const double dt : {1.0e-3, 4.0e-3}) {
            Scene pool = tankScene(transfer, 0.5, {12.0, 10.0, 8.0}, {0.0, 0.0, 0.0}, {12.0, 5.0, 8.0});
            Scene hit = ballIntoPool(transfer);
            for (Scene* scene : {&pool, &hit}) {
                scene->settings.time.mode = TimeMode::Fixed;
                scene->settings.time.dt = dt;
            }
            const double fall = dt * kEarthGravity;
            Simulation resting(pool), splashing(hit);
            for (int n = 0; n < 20; ++n) {
                resting.step(1.0);
                const double speed = resting.state().reflected ? 0.0 : centreOf(resting.state()).v.norm();
                EXPECT_LT(speed, 1.0e-3 * fall) << transfer.name << ", step " << n;
                splashing.step(1.0);
                EXPECT_LE(splashing.state().memory.sinceMidstep.norm(), fall) << transfer.name << ", step " << n;
            }
        }
}

/// Where the particles are after some steps, in the order of their numbers [cm].
std::vector<Vec3> placesAfter(int steps, Simulation simulation)
{
    for (int n = 0; n < steps; ++n) simulation.step(1.0e9);
    const LiquidParticles& liquid = simulation.state().liquid;
    std::vector<Vec3> places(liquid.count);
    for (std::size_t p = 0; p < liquid.count; ++p) places[liquid.id[p]] = liquid.position(p);
    return places;
}

/// A frame that moves on by whole cells in a step has the same grid: nothing but rounding may differ.
TEST(Galileo, BoostByWholeCellsIsExact)
{
    constexpr int kSteps = 8;
    constexpr double kDt = 2.0e-3;
    Random random(31);
    for (const Transfer& transfer : kTransfers)
        for (const TimeIntegrator integrator : {TimeIntegrator::Reflected, TimeIntegrator::Plain}) {
            Scene scene = freeLiquid(transfer, integrator, random);
            scene.settings.time.dt = kDt;
            scene.settings.time.maxCflLiquid = 10.0;
            scene.settings.solver.pressureTolerance = 1.0e-12;
            Flow flow = randomFlow(random);
            flow.mean.setZero();
            const std::vector<Vec3> here = placesAfter(kSteps, movingWith(scene, flow));
            const Vec3 cells(1.0, -2.0, 1.0);
            flow.mean = cells * scene.settings.cell / kDt;
            const std::vector<Vec3> there = placesAfter(kSteps, movingWith(scene, flow));
            ASSERT_EQ(here.size(), there.size());
            double largest = 0.0;
            for (std::size_t p = 0; p < here.size(); ++p)
                largest = std::max(largest, (there[p] - here[p] - kSteps * scene.settings.cell * cells).norm());
            // The corrections of volume and of reflection are solved for to 1e-2 and 1e-3.
            EXPECT_LT(largest, 1.0e-3 * scene.settings.cell) << transfer.name << (integrator == TimeIntegrator::Plain ? ", plain" : ", reflected");
        }
}

/// Liquid in a tank does what the frame of the tank says: one that is carried along sees it slosh as one at rest does.
TEST(Galileo, LiquidInATankThatMovesByCellsSloshesAsInOneAtRest)
{
    constexpr int kSteps = 10;
    constexpr double kDt = 2.0e-3, kCell = 0.25;
    Random random(32);
    for (const Transfer& transfer : kTransfers)
        for (const TimeIntegrator integrator : {TimeIntegrator::Reflected, TimeIntegrator::Plain})
            for (const Vec3& cells : {Vec3(1.0, 0.0, 0.0), Vec3(0.0, -1.0, 1.0)}) {
                Scene scene = freeLiquid(transfer, integrator, random);
                scene.settings.gravity = Vec3(0.0, -981.0, 0.0);
                scene.settings.time.dt = kDt;
                scene.settings.time.maxCflLiquid = 10.0;
                scene.settings.solver.pressureTolerance = 1.0e-12;
                scene.settings.liquid.wallFriction = 1.0;  // with less, walls mirror the liquid where they rest
                scene.sources.resize(1);
                scene.sources[0].shape = Shape::box({0.0, -0.5, 0.0}, {1.0, 0.5, 0.5});
                const Shape tank = Shape::box(Vec3::Zero(), Vec3(1.0, 1.0, 0.5)).inverted();
                Flow flow = randomFlow(random);
                flow.mean.setZero();
                scene.obstacles = {obstacle("tank", tank)};
                const std::vector<Vec3> here = placesAfter(kSteps, movingWith(scene, flow));
                Motion motion;
                const Vec3 way = kSteps * kCell * cells;  // before the start and after it
                motion.addTranslation(-kSteps * kDt, kSteps * kDt, 2.0 * way, 0.0, 0.0);
                scene.obstacles = {obstacle("tank", Shape::box(-way, Vec3(1.0, 1.0, 0.5)).inverted(), motion)};
                flow.mean = cells * kCell / kDt;
                const std::vector<Vec3> there = placesAfter(kSteps, movingWith(scene, flow));
                ASSERT_EQ(here.size(), there.size());
                double largest = 0.0;
                for (std::size_t p = 0; p < here.size(); ++p) largest = std::max(largest, (there[p] - here[p] - kSteps * kCell * cells).norm());
                // What is left is rounding of places in a frame that has gone far, and that the pressure was not solved for.
                EXPECT_LT(largest, 1.0e-7 * kCell) << transfer.name << (integrator == TimeIntegrator::Plain ? ", plain" : ", reflected");
            }
}

}  // namespace
}  // namespace sim::test
