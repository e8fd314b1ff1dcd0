#include "drench/simulation.h"

#include "app/library/scene_parts.h"
#include "app/library/simulation_parts.h"
#include "sim/scene/load_scene.h"
#include "sim/simulation.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numeric>

namespace drench::test {
namespace {

constexpr const char* kText = R"(
time: {dt: 2.0e-3}
grid: {cell: 0.5}
transfer: {method: polypic, modes: 11}
gravity: [0, -900, 0]
liquid:
  sources:
    - {shape: {ball: {center: [0, 3, 0], radius: 1}}, velocity: [0, -50, 0]}
    - {name: pool, shape: {box: {min: [-2, 0, -2], max: [2, 1, 2]}}, fill: jittered}
obstacles:
  - {name: tank, shape: {box: {min: [-2, 0, -2], max: [2, 6, 2]}}, inside: true}
materials: {wool: {young: 6.6e+6, density: 1.3}}
fabrics:
  - name: rag
    cloth_grid: {material: wool, nodes: [5, 5], spacing: 0.4, origin: [-0.8, 2, -0.8], u: [1, 0, 0], v: [0, 0, 1], radius: 0.02}
    pin: {corners: all}
)";

/// The same, in the words of the face.
Scene inWords()
{
    Scene scene;
    scene.set("time.dt", 2.0e-3);
    scene.set("grid.cell", 0.5);
    scene.set("transfer", "polypic");
    scene.set("transfer.modes", 11);
    scene.set("gravity", {0, -900, 0});
    scene.add({.shape = ball({0, 3, 0}, 1), .velocity = {0, -50, 0}});
    scene.add({.shape = box({-2, 0, -2}, {2, 1, 2}), .name = "pool", .more = "fill: jittered"});
    scene.add("tank", {.shape = box({-2, 0, -2}, {2, 6, 2}), .inside = true});
    scene.set("materials.wool", "{young: 6.6e+6, density: 1.3}");
    scene.addFabric("rag",
                    "{cloth_grid: {material: wool, nodes: [5, 5], spacing: 0.4, origin: [-0.8, 2, -0.8], u: [1, 0, 0], v: [0, 0, 1], radius: 0.02}, "
                    "pin: {corners: all}}");
    return scene;
}

/// Water at rest in a tank, with a plate under it that a motion may move.
Scene pool(const Motion& motion = {}, const std::string& more = "")
{
    Scene scene("pool");
    scene.set("grid.cell", 0.5);
    scene.set("time.dt", 2.0e-3);
    scene.add({.shape = box({-2, 0, -2}, {2, 3, 2})});
    scene.add("tank", {.shape = box({-2, 0, -2}, {2, 6, 2}), .inside = true});
    scene.add("ball", {.shape = ball({0, 1.5, 0}, 0.8), .motion = motion, .more = more});
    return scene;
}

std::uint64_t hashAt(double time, const Scene& scene, int threads = 0)
{
    Simulation simulation(scene, threads);
    simulation.advanceTo(time);
    return simulation.stateHash();
}

constexpr double kTime = 0.02;

TEST(Library, RunsAsTheSimulationDoes)
{
    sim::Simulation plain(sim::readScene(sim::sceneFileFromText(kText, "scene")));
    while (plain.state().time < kTime) plain.step(kTime);
    EXPECT_EQ(hashAt(kTime, Scene::parse(kText)), sim::stateHash(plain.state()));
}

TEST(Library, ScenesInWordsAreThoseOfFiles)
{
    EXPECT_EQ(inWords().resolved(), Scene::parse(kText).resolved());
    EXPECT_EQ(hashAt(kTime, inWords()), hashAt(kTime, Scene::parse(kText)));
}

TEST(Library, AnyNumberOfThreadsGivesTheSameBits)
{
    const std::uint64_t one = hashAt(kTime, inWords(), 1);
    for (const int threads : {2, 3, 0}) EXPECT_EQ(hashAt(kTime, inWords(), threads), one) << threads;
}

TEST(Library, StepsAreThoseOfAdvanceTo)
{
    Simulation simulation(inWords());
    while (simulation.time() < kTime) simulation.step(kTime);
    EXPECT_EQ(simulation.time(), kTime);
    EXPECT_EQ(simulation.stateHash(), hashAt(kTime, inWords()));
    const std::int64_t steps = simulation.steps();
    simulation.advanceTo(kTime);
    EXPECT_EQ(simulation.steps(), steps);
}

TEST(Library, ScenesAreCopied)
{
    const Scene scene = inWords();
    Scene other = scene;
    Simulation simulation(other);
    other.set("gravity", Vec3{});
    EXPECT_NE(hashAt(kTime, other), hashAt(kTime, scene));
    simulation.advanceTo(kTime);
    EXPECT_EQ(simulation.stateHash(), hashAt(kTime, scene));
}

TEST(Library, ReadsWhatTheStateHolds)
{
    Simulation simulation(inWords());
    double longest = 0.0;
    for (int n = 0; n < 3; ++n) {
        const sim::State& state = simulation.parts().real().state();
        const Particles liquid = simulation.particles();
        ASSERT_EQ(liquid.size(), state.liquid.count);
        for (std::size_t p = 0; p < liquid.size(); ++p) {
            ASSERT_EQ(toSim(liquid.position(p)), state.liquid.position(p));
            ASSERT_EQ(toSim(liquid.velocity(p)), state.liquid.velocity(p));
            ASSERT_EQ(liquid.id[p], state.liquid.id[p]);
        }
        EXPECT_NEAR(std::accumulate(liquid.mass.begin(), liquid.mass.end(), 0.0), simulation.read("liquid_mass"), 1.0e-9);
        const Fabric fabric = simulation.fabric();
        ASSERT_EQ(fabric.size(), 25u);
        ASSERT_EQ(fabric.triangles.size(), 32u);
        for (std::size_t v = 0; v < fabric.size(); ++v) {
            ASSERT_EQ(toSim(fabric.position[v]), state.fabric.x[v]);
            ASSERT_EQ(toSim(fabric.velocity[v]), state.fabric.v[v]);
        }
        EXPECT_EQ(std::accumulate(fabric.absorbed.begin(), fabric.absorbed.end(), 0.0), simulation.read("absorbed"));
        EXPECT_NEAR(simulation.energies().total(), simulation.read("energy"), 1.0e-9 * std::abs(simulation.read("energy")));
        const Step step = simulation.step(1.0);
        EXPECT_NEAR(step.energies.total(), simulation.energies().total(), 1.0e-9 * std::abs(step.energies.total()));
        longest = std::max(longest, step.dt);
    }
    EXPECT_LE(longest, 2.0e-3);
    EXPECT_GT(longest, 0.0);
}

TEST(Library, OwnMotionsMoveAsThoseOfScenes)
{
    Scene byKeys = pool({}, "motion: [{keys: [[0, 0, 0, 0], [1, 10, 0, 0]], interp: linear}]");
    const Motion same = [](double t) { return Pose{.shift = {10.0 * t, 0, 0}}; };
    EXPECT_EQ(hashAt(kTime, pool(same)), hashAt(kTime, byKeys));
    EXPECT_NE(hashAt(kTime, pool(same)), hashAt(kTime, pool()));
}

TEST(Library, OwnMotionsTurnAboutTheirPoint)
{
    const Pose quarter = {.shift = {0, 5, 0}, .turn = {0, 0, std::acos(0.0)}, .about = {1, 0, 0}};
    const sim::Scene scene = pool([&](double) { return quarter; }).parts().read();
    EXPECT_LT((scene.obstacles[1].motion.transform(0.3) * sim::Vec3(3, 0, 0) - sim::Vec3(1, 7, 0)).norm(), 1.0e-14);
}

/// Of what is in the water the pressure carries the weight that the water would have there; the tank carries all that it weighs.
TEST(Library, ForcesAreThoseOfWaterAtRest)
{
    Simulation simulation(pool());
    EXPECT_EQ(simulation.on("ball").force, Vec3{});
    simulation.advanceTo(0.2);
    const double weight = 981.0 * simulation.read("liquid_mass"), buoyancy = 981.0 * 4.0 / 3.0 * std::acos(-1.0) * std::pow(0.8, 3);
    const double onBall = simulation.on("ball").force.y, onTank = simulation.on("tank").force.y;
    EXPECT_NEAR(onBall, buoyancy, 0.1 * buoyancy);
    EXPECT_NEAR(onBall + onTank, -weight, 0.02 * weight);
    EXPECT_EQ(onBall, simulation.read("force_y(\"ball\")"));
}

TEST(Library, FormulasReadAtAPlace)
{
    Simulation simulation(pool());
    simulation.advanceTo(0.1);
    EXPECT_NEAR(simulation.read("pressure(x, y, z)", {1.5, 1, 1.5}), 981.0 * 2.0, 981.0 * 0.3);  // within half a cell of depth
    EXPECT_EQ(simulation.read("pressure(x, y, z)", {1.5, 1, 1.5}), simulation.read("pressure(1.5, 1, 1.5)"));
    EXPECT_EQ(simulation.read("t"), simulation.time());
    EXPECT_TRUE(std::isnan(simulation.read("velocity_x(0, 50, 0)")));  // no liquid there
}

/// What a call throws, which must be one line.
template <class Mistake>
std::string told(const std::function<void()>& call)
{
    try {
        call();
    } catch (const Mistake& mistake) {
        const std::string what = mistake.what();
        EXPECT_EQ(what.find('\n'), std::string::npos) << what;
        return what;
    }
    return "nothing was thrown";
}

TEST(Library, MistakesAreToldInOneLine)
{
    const auto wrong = [](const std::function<void(Scene&)>& change) {
        Scene scene = pool();
        return told<InputError>([&] {
            change(scene);
            scene.check();
        });
    };
    EXPECT_EQ(wrong([](Scene& s) { s.set("liquid.viscocity", 1.0); }),
              "--set liquid.viscocity=1: unknown key \"viscocity\" in liquid (did you mean \"viscosity\"?)");
    EXPECT_EQ(wrong([](Scene& s) { s.set("grid.cell", -1.0); }), "--set grid.cell=-1: grid.cell: \"-1\" is out of range; must be above 0 cm");
    EXPECT_EQ(wrong([](Scene& s) {
                  s.add({.shape = ball({0, 0, 0}, -1), .name = "drop"});
              }),
              "source drop: liquid.sources.drop.shape.ball.radius: \"-1\" is out of range; must be above 0, at most 10000000 cm");
    EXPECT_EQ(wrong([](Scene& s) { s.add("ball", {.shape = ball({0, 0, 0}, 1)}); }), "obstacle ball: obstacles: two are named \"ball\"; rename one");
    EXPECT_EQ(wrong([](Scene& s) { s.add("wall", {.shape = {"{bal: }"}}); }),
              "obstacle wall: unknown key \"bal\" in obstacles.wall.shape (did you mean \"ball\"?)");
    EXPECT_EQ(wrong([](Scene& s) { s.addFabric("rag", "cotton"); }), "fabric rag: needs keys, like {cloth_grid: {...}}, not \"cotton\"");
    EXPECT_EQ(told<InputError>([] { Scene("empty").check(); }),
              "scene empty: grid is missing; it is where the size of cells stands, like grid: {cell: 0.288}");
    EXPECT_EQ(told<InputError>([] { Scene::load("no_such.yaml"); }), "no_such.yaml: there is no file \"no_such.yaml\"");
    Simulation simulation(pool());
    EXPECT_EQ(told<InputError>([&] { simulation.read("presure(0, 0, 0)"); }),
              "\"presure(0, 0, 0)\": Unexpected token \"presure\" found at position 0.");
    EXPECT_EQ(told<InputError>([&] { simulation.on("paddle"); }), "\"force_x(\"paddle\")\": there is no obstacle and no fabric \"paddle\"");
}

TEST(Library, RunsThatCannotGoOnTellWhy)
{
    Simulation simulation(pool([](double t) { return Pose{.shift = {t > 0.01 ? std::nan("") : 0.0, 0, 0}}; }));
    ASSERT_GT(simulation.particles().size(), 0u);
    EXPECT_EQ(told<RunError>([&] { simulation.advanceTo(1.0); }),
              "scene pool, step 6, t = 0.01 s, stage obstacles: the motion of obstacle ball is not finite at t = 0.012 s");
    EXPECT_LE(simulation.time(), 0.01 + 2.0e-3);
    const Particles liquid = simulation.particles();
    ASSERT_EQ(liquid.size(), simulation.parts().real().state().liquid.count);
    for (std::size_t p = 0; p < liquid.size(); ++p) ASSERT_EQ(toSim(liquid.velocity(p)), simulation.parts().real().state().liquid.velocity(p));
}

TEST(Library, MistakesOfItsUserPassThrough)
{
    struct Own {};
    Simulation simulation(pool([](double t) { return t > 0.01 ? throw Own() : Pose{}; }));
    EXPECT_THROW(simulation.advanceTo(1.0), Own);
}

}  // namespace
}  // namespace drench::test
