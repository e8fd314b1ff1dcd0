// No setting is silently without effect: whichever is changed, the run is another one.
#include "sim/scene/load_scene.h"
#include "sim/scene/parameters.h"
#include "sim/simulation.h"

#include <gtest/gtest.h>

#include <map>
#include <string>
#include <vector>

namespace sim::test {
namespace {

/// Water that falls in a tank, on a ball and in part on its walls.
constexpr const char* kPool = R"(
grid: {cell: 0.5}
time: {dt: 1.0e-3, duration: 5.0e-3}
liquid:
  sources: [{shape: {box: {min: [-2, 0, -1], max: [1, 2, 1]}}, velocity: [40, -30, 20]}]
obstacles:
  - {name: tank, shape: {box: {min: [-2, 0, -1], max: [2, 3, 1]}, rotate: {axis: [0, 0, 1], angle: 5}}, inside: true}
)";

/// Wet cloth and yarn over a ball, hung up at one side, stretched and twisted by pins, and a drop on them.
constexpr const char* kWet = R"(
grid: {cell: 0.25}
time: {dt: 1.0e-3, duration: 5.0e-3}
porous: {fibre_diameter: 0.01, volume_fraction: 0.4}
materials:
  wool: {young: 1.0e+6, damping_viscosity: 20}
liquid:
  sources: [{shape: {ball: {center: [0, 0.75, 0], radius: 0.5}}, velocity: [0, -60, 0]}]
fabrics:
  - name: sheet
    cloth_grid: {material: wool, nodes: [7, 7], spacing: [0.2, 0.2], origin: [-0.6, 0, -0.6], u: [1, 0, 0], v: [0, 0, 1], radius: 0.03}
    velocity: [0, -20, 0]
    wetness: 0.9
    pin: [{nodes: [0, 1], motion: {t: [0, 1], translate: [-60, 20, 0]}}]
  - name: other
    cloth_grid: {material: wool, nodes: [5, 5], spacing: [0.2, 0.2], origin: [-0.4, 0.069, -0.4], u: [1, 0, 0], v: [0, 0, 1], radius: 0.03}
    velocity: [10, -20, 0]
    wetness: 0.5
  - name: yarn
    strand: {material: wool, points: [[1, 0, 0], [1.2, 0.1, 0], [1.4, 0, 0.1], [1.6, 0.1, 0.1], [1.8, 0, 0]], radius: [0.05, 0.03]}
    velocity: [0, -20, 30]
    wetness: 1
    pin: [{name: end, nodes: [0], twist: true, motion: {t: [0, 1], rotate: {axis: [1, 0, 0], angle: 9000, origin: [1, 0, 0]}}}]
obstacles:
  - {name: ball, shape: {ball: {center: [0, -1.04, 0], radius: 1}}}
)";

/// Cloth as thick as its material.
constexpr const char* kThick = R"(
grid: {cell: 0.25}
time: {dt: 1.0e-3, duration: 5.0e-3}
materials:
  wool: {young: 1.0e+6, thickness: 0.06}
fabrics:
  - name: sheet
    cloth_grid: {material: wool, nodes: [5, 5], spacing: [0.2, 0.2], origin: [0, 0, 0], u: [1, 0, 0], v: [0, 0, 1]}
    pin: [{nodes: [0, 1]}]
)";

/// Where a setting acts, and to what it is changed where not to a value beside its own.
struct Ground {
    const char* scene = kWet;
    std::vector<std::string> with = {};  ///< overrides without which it is not read
    std::string value = {};
};

const std::string kGridSolver = "fabric.solver=grid";
const std::string kDamped = "transfer.damping.liquid_affine=0.5";

const std::map<std::string, Ground> kGrounds = {
    {"time.dt", {kPool, {}, "5.0e-4"}},
    {"time.start", {kPool, {}, "-1"}},
    {"time.mode", {kPool, {"time.cfl=0.02"}, "cfl"}},
    {"time.cfl", {kPool, {"time.mode=cfl"}, "0.02"}},
    {"time.max_cfl.liquid", {kPool, {}, "0.02"}},
    {"time.max_cfl.fabric", {kWet, {kGridSolver}, "0.01"}},
    {"time.dt_min", {kPool, {"time.max_cfl.liquid=0.02"}, "1.0e-3"}},
    {"time.duration", {kPool}},
    {"time.integrator", {kPool, {}, "plain"}},
    {"transfer.method.liquid", {kPool, {}, "pic"}},
    {"transfer.method.fabric", {kWet, {kGridSolver}, "pic"}},
    {"transfer.modes.liquid", {kPool, {}, "11"}},
    {"transfer.modes.fabric", {kWet, {kGridSolver}, "4"}},
    {"transfer.xi.liquid", {kPool, {}, "affine"}},
    {"transfer.xi.fabric", {kWet, {kGridSolver}, "affine"}},
    {"transfer.flip_ratio", {kPool, {"transfer.method.liquid=flip"}, "0.5"}},
    {"transfer.damping.liquid_affine", {kPool, {}, "0.5"}},
    {"transfer.damping.fabric_stretch", {kWet, {kGridSolver}, "0.5"}},
    {"transfer.damping.fabric_rotation", {kWet, {kGridSolver}, "0.5"}},
    {"transfer.damping.fabric_velocity", {kWet, {kGridSolver}, "0.5"}},
    {"transfer.damping_dt", {kPool, {kDamped}, "step"}},
    {"transfer.damp_modes", {kPool, {kDamped}}},
    {"coupling.capture.published_rate_factor", {kWet, {"coupling.capture.law=published"}, "1"}},
    {"coupling.wicking.rate_scale", {kWet, {}, "0.5"}},
    {"coupling.wicking.suction_exponent", {kWet, {}, "3"}},
    {"coupling.wicking.permeability_exponent", {kWet, {}, "3"}},
    {"coupling.cohesion.strength", {kWet, {}, "0.01"}},
    {"coupling.cohesion.fabric", {kWet, {"coupling.cohesion.strength=0.01"}}},
    {"coupling.cohesion.obstacle", {kWet, {"coupling.cohesion.strength=0.01"}}},
    {"coupling.drip", {kWet, {"fabric.solver=off", "gravity=[1.0e+5, 0, 0]", "liquid.sources.0.fill.spacing=0.1"}}},
    {"solver.pressure_tolerance", {kPool, {}, "0.1"}},
    {"solver.max_iterations", {kPool, {}, "1"}},
    {"solver.viscosity_tolerance", {kPool, {"liquid.solve_viscosity=true", "liquid.viscosity=100"}, "0.1"}},
    {"solver.wicking_substeps", {kWet, {}, "7"}},
    {"liquid.particle_spacing", {kPool, {}, "0.5"}},
    {"liquid.full", {kPool}},
    {"liquid.wall_friction", {kPool, {}, "1"}},
    {"liquid.volume.rate", {kPool, {}, "0"}},
    {"liquid.relax.rate", {kPool, {}, "125"}},
    {"liquid.relax.range", {kPool, {"liquid.relax.rate=500"}, "1"}},
    {"liquid.curvature_smoothing", {kPool, {"liquid.surface_tension_force=true"}, "1"}},
    {"liquid.viscosity_substeps", {kPool, {"liquid.solve_viscosity=true", "liquid.viscosity=100"}, "3"}},
    {"liquid.solve_viscosity", {kPool}},
    {"liquid.surface_order", {kPool, {"obstacles.0.shape.rotate.angle=0"}, "1"}},
    {"liquid.surface_tension_force", {kPool}},
    {"fabric.hinge.constant", {kWet, {"fabric.bending=hinge"}}},
    {"fabric.hinge.measure", {kWet, {"fabric.bending=hinge"}}},
    {"fabric.newton", {kWet, {}, "9"}},
    {"fabric.tolerance", {kWet, {}, "1.0e-9"}},
    {"fabric.max_halvings", {kWet, {"time.dt=5.0e-3", "fabrics.1.velocity=[10, -1000, 0]"}, "0"}},
    {"materials.wool.thickness", {kThick, {}, "0.08"}},
    {"materials.wool.stretch_stiffness", {kWet, {}, "[1.0e+5, 5.0e+4]"}},
    {"materials.wool.shear_stiffness", {kWet, {"materials.wool.stretch_stiffness=[1.0e+5, 5.0e+4]"}, "1.0e+4"}},
    {"materials.wool.bending_stiffness", {kWet, {}, "[1, 0.5]"}},
    {"materials.wool.contact_stiffness", {kWet, {kGridSolver}, "10"}},
    {"materials.wool.pin_stiffness", {kWet, {kGridSolver}}},
};

/// A value that is not the parameter's own.
std::string another(const Parameter& p)
{
    using Kind = Parameter::Kind;
    if (p.kind == Kind::Flag) return p.value == "true" ? "false" : "true";
    if (p.kind == Kind::Word) return p.words[p.words[0] == p.value ? 1 : 0];
    if (p.kind == Kind::Numbers) return "[1, -500, 2]";
    if (p.kind == Kind::Integer) return std::to_string(std::stoi(p.value) + 1);
    const double own = std::stod(p.value);
    for (const double value : {1.3 * own, 0.7 * own, 0.3})
        if (value != own && p.range.contains(value)) return std::to_string(value);
    return "";
}

/// What a run of the scene ends in: its state, or why it did not.
std::string endOf(const char* text, const std::vector<std::string>& set)
{
    const Scene scene = readScene(sceneFileFromText(text, "scene.yaml", {"", set}));
    try {
        Simulation simulation(scene);
        const double end = scene.settings.time.start + scene.settings.time.duration;
        while (simulation.state().time < end) simulation.step(end);
        return std::to_string(stateHash(simulation.state()));
    } catch (const RunError& error) {
        return error.what();
    }
}

TEST(Settings, EachOfThemMakesAnotherRun)
{
    const Scene scene = readScene(sceneFileFromText(kWet, "scene.yaml", {}));
    std::map<std::string, std::string> ends;  // without the change
    int count = 0;
    for (const Parameter& p : parametersOf(scene.settings, scene.materials)) {
        const auto found = kGrounds.find(p.path);
        const Ground ground = found == kGrounds.end() ? Ground() : found->second;
        const std::string value = ground.value.empty() ? another(p) : ground.value;
        ASSERT_FALSE(value.empty()) << p.path;
        std::string key = ground.scene;
        for (const std::string& with : ground.with) key += "\n" + with;
        if (!ends.contains(key)) ends[key] = endOf(ground.scene, ground.with);
        std::vector<std::string> set = ground.with;
        set.push_back(overrideText(p, value));
        EXPECT_NE(ends[key], endOf(ground.scene, set)) << set.back() << " changes nothing";
        ++count;
    }
    EXPECT_GT(count, 70);
    EXPECT_EQ(ends[kWet], endOf(kWet, {})) << "a run is the same every time";
}

/// Likewise those of a solid.
TEST(Settings, OfObstaclesMakeAnotherRun)
{
    const std::string sticky = "coupling.cohesion.strength=0.01";
    for (const std::string change : {"obstacles.0.cohesive=false", "obstacles.0.collide=false", "obstacles.0.friction_angle=3"})
        EXPECT_NE(endOf(kWet, {sticky}), endOf(kWet, {sticky, change})) << change;
}

/// Faces of the domain are no parameters, as they hold for a whole run.
TEST(Settings, KeysOfOpeningsAct)
{
    constexpr const char* kStream = R"(
grid: {cell: 0.5}
time: {dt: 5.0e-3, duration: 0.1}
domain: {box: {min: [0, 0, 0], max: [8, 6, 2]}}
liquid:
  sources: [{shape: {box: {min: [0, 0, 0], max: [8, 2, 2]}}, velocity: [20, 0, 0]}]
  openings: [{name: inlet, face: x-, velocity: 20, level: 2}, {name: outlet, face: x+, level: 2}]
obstacles: [{name: flume, shape: {box: {min: [-4, 0, 0], max: [12, 8, 2]}}, inside: true}]
)";
    const std::string before = endOf(kStream, {});
    const std::vector<std::vector<std::string>> changes = {{"liquid.openings.inlet.velocity=25"},
                                                           {"liquid.openings.inlet.level=1.5"},
                                                           {"liquid.openings.outlet.level=2.5"},
                                                           {"liquid.openings.outlet.velocity=5"},
                                                           {"liquid.openings.outlet.face=y+", "liquid.openings.outlet.level=7"}};
    for (const std::vector<std::string>& set : changes) EXPECT_NE(before, endOf(kStream, set)) << set[0] << " changes nothing";
}

}  // namespace
}  // namespace sim::test
