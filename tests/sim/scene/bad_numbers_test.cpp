#include "tests/sim/scene/bad_scene.h"

// Numbers and words.

namespace {

const BadScene kBadScenes[] = {
    {"NumberIsWord", R"(grid: {cell: 0.1}
time: {dt: fast}
liquid: {sources: [{shape: {ball: {center: [0, 0, 0], radius: 1}}}]}
)",
     "bad.yaml:2: time.dt: \"fast\" is no number; needs a time like 0.5 or \"0.5 s\""},
    {"NumberIsList", R"(grid: {cell: 0.1}
time: {dt: [1, 2]}
liquid: {sources: [{shape: {ball: {center: [0, 0, 0], radius: 1}}}]}
)",
     "bad.yaml:2: time.dt: needs a time, not a list of 2"},
    {"NumberIsMap", R"(grid: {cell: 0.1}
time: {dt: {a: 1}}
liquid: {sources: [{shape: {ball: {center: [0, 0, 0], radius: 1}}}]}
)",
     "bad.yaml:2: time.dt: needs a time, not a map"},
    {"NumberIsNull", R"(grid: {cell: 0.1}
time: {dt: }
liquid: {sources: [{shape: {ball: {center: [0, 0, 0], radius: 1}}}]}
)",
     "bad.yaml:2: time.dt: needs a time, not nothing"},
    {"NumberIsBool", R"(grid: {cell: 0.1}
time: {dt: true}
liquid: {sources: [{shape: {ball: {center: [0, 0, 0], radius: 1}}}]}
)",
     "bad.yaml:2: time.dt: \"true\" is no number; needs a time like 0.5 or \"0.5 s\""},
    {"Nan", R"(grid: {cell: 0.1}
time: {dt: nan}
liquid: {sources: [{shape: {ball: {center: [0, 0, 0], radius: 1}}}]}
)",
     "bad.yaml:2: time.dt: \"nan\" is not finite; write a number"},
    {"YamlNan", R"(grid: {cell: 0.1}
time: {dt: .nan}
liquid: {sources: [{shape: {ball: {center: [0, 0, 0], radius: 1}}}]}
)",
     "bad.yaml:2: time.dt: \".nan\" is not finite; write a number"},
    {"Inf", R"(grid: {cell: 0.1}
time: {duration: inf}
liquid: {sources: [{shape: {ball: {center: [0, 0, 0], radius: 1}}}]}
)",
     "bad.yaml:2: time.duration: \"inf\" is not finite; write a number"},
    {"YamlInf", R"(grid: {cell: 0.1}
gravity: [0, -.inf, 0]
liquid: {sources: [{shape: {ball: {center: [0, 0, 0], radius: 1}}}]}
)",
     "bad.yaml:2: gravity: \"-.inf\" is not finite; write a number"},
    {"Huge", R"(grid: {cell: 0.1}
time: {duration: 1e999}
liquid: {sources: [{shape: {ball: {center: [0, 0, 0], radius: 1}}}]}
)",
     "bad.yaml:2: time.duration: \"1e999\" is out of the range of numbers"},
    {"HugeInUnits", R"(grid: {cell: 0.1}
time: {duration: 1e308 Gs}
liquid: {sources: [{shape: {ball: {center: [0, 0, 0], radius: 1}}}]}
)",
     "bad.yaml:2: time.duration: \"1e308 Gs\" is out of the range of numbers"},
    {"NegativeDt", R"(grid: {cell: 0.1}
time:
  dt: -0.1
liquid: {sources: [{shape: {ball: {center: [0, 0, 0], radius: 1}}}]}
)",
     "bad.yaml:3: time.dt: \"-0.1\" is out of range; must be above 0 s"},
    {"ZeroCell", R"(grid: {cell: 0}
liquid: {sources: [{shape: {ball: {center: [0, 0, 0], radius: 1}}}]}
)",
     "bad.yaml:1: grid.cell: \"0\" is out of range; must be above 0 cm"},
    {"NegativeCell", R"(grid: {cell: -1 mm}
liquid: {sources: [{shape: {ball: {center: [0, 0, 0], radius: 1}}}]}
)",
     "bad.yaml:1: grid.cell: \"-1 mm\" is out of range; must be above 0 cm"},
    {"NegativeDuration", R"(grid: {cell: 0.1}
time: {duration: -1}
liquid: {sources: [{shape: {ball: {center: [0, 0, 0], radius: 1}}}]}
)",
     "bad.yaml:2: time.duration: \"-1\" is out of range; must be at least 0 s"},
    {"DtMinAboveDt", R"(grid: {cell: 0.1}
time: {dt: 1.0e-3, dt_min: 1.0e-2}
liquid: {sources: [{shape: {ball: {center: [0, 0, 0], radius: 1}}}]}
)",
     "bad.yaml:2: time.dt_min: must not be above time.dt"},
    {"UnknownMode", R"(grid: {cell: 0.1}
time: {mode: adaptve}
liquid: {sources: [{shape: {ball: {center: [0, 0, 0], radius: 1}}}]}
)",
     "bad.yaml:2: time.mode: \"adaptve\" is unknown (did you mean \"adaptive\"?)"},
    {"ModeIsList", R"(grid: {cell: 0.1}
time: {mode: [fixed]}
liquid: {sources: [{shape: {ball: {center: [0, 0, 0], radius: 1}}}]}
)",
     "bad.yaml:2: time.mode: needs one word of fixed, cfl, adaptive, not a list of 1"},
    {"UnknownIntegrator", R"(grid: {cell: 0.1}
time: {integrator: reflect}
liquid: {sources: [{shape: {ball: {center: [0, 0, 0], radius: 1}}}]}
)",
     "bad.yaml:2: time.integrator: \"reflect\" is unknown (did you mean \"reflected\"?)"},
    {"CurvatureSmoothingNegative", R"(grid: {cell: 0.1}
liquid: {surface_tension_force: true, curvature_smoothing: -1}
)",
     "bad.yaml:2: liquid.curvature_smoothing: -1 is out of range; must be 0 to 1000"},
    {"ModesZero", R"(grid: {cell: 0.1}
transfer: {modes: 0}
liquid: {sources: [{shape: {ball: {center: [0, 0, 0], radius: 1}}}]}
)",
     "bad.yaml:2: transfer.modes: 0 is out of range; must be 1 to 27"},
    {"Modes28", R"(grid: {cell: 0.1}
transfer: {modes: {liquid: 8, fabric: 28}}
liquid: {sources: [{shape: {ball: {center: [0, 0, 0], radius: 1}}}]}
)",
     "bad.yaml:2: transfer.modes.fabric: 28 is out of range; must be 1 to 8"},
    {"ModesOfFabricAboveEight", R"(grid: {cell: 0.1}
transfer: {modes: {liquid: 11, fabric: 11}}
)",
     "bad.yaml:2: transfer.modes.fabric: 11 is out of range; must be 1 to 8"},
    {"PublishedContact", R"(grid: {cell: 0.1}
contact: {obstacle_young: 1.0e+5}
)",
     "bad.yaml:2: contact: how hard solids push fabric follows from its mass and the step, with every solver; remove the section "
     "(fabric.contact: false takes contact away, obstacles[].collide: false that with one solid)"},
    {"Benchmark", R"(grid: {cell: 0.1}
benchmark: {repeat: 3}
)",
     "bad.yaml:2: benchmark: no verb reads it; remove the section (drench bench --scene times a scene)"},
    {"Test", R"(grid: {cell: 0.1}
test: {repeat: 3}
)",
     "bad.yaml:2: test: no verb reads it; remove the section (a scene's checks stand in validate)"},
    {"WickingSubstepsAreAWord", R"(grid: {cell: 0.1}
solver: {wicking_substeps: auto}
)",
     "bad.yaml:2: solver.wicking_substeps: needs a whole number, 1 to 1000, not \"auto\""},
    {"CompareTolerance", R"(grid: {cell: 0.1}
liquid: {sources: [{shape: {ball: {center: [0, 0, 0], radius: 1}}}]}
compare: {tolerance: 0.1}
)",
     "bad.yaml:3: compare.tolerance: needs a map of keys, not \"0.1\""},
    {"MeshCache", R"(grid: {cell: 0.1}
liquid: {sources: [{shape: {mesh: {file: a.obj, cache: a.sdf}}}]}
)",
     "bad.yaml:2: liquid.sources.0.shape.mesh.cache: this version finds the distances of a mesh anew in every run; remove the key (a larger "
     "mesh.cell is faster)"},
    {"ModesFraction", R"(grid: {cell: 0.1}
transfer: {modes: 8.5}
liquid: {sources: [{shape: {ball: {center: [0, 0, 0], radius: 1}}}]}
)",
     "bad.yaml:2: transfer.modes: needs a whole number, 1 to 27, not \"8.5\""},
    {"MethodUnknown", R"(grid: {cell: 0.1}
transfer: apicc
liquid: {sources: [{shape: {ball: {center: [0, 0, 0], radius: 1}}}]}
)",
     "bad.yaml:2: transfer.method: \"apicc\" is unknown (did you mean \"apic\"?)"},
    {"PhaseUnknown", R"(grid: {cell: 0.1}
transfer: {method: {liquid: apic, cloth: pic}}
liquid: {sources: [{shape: {ball: {center: [0, 0, 0], radius: 1}}}]}
)",
     "bad.yaml:2: unknown key \"cloth\" in transfer.method (there is liquid, fabric)"},
    {"FlagIsNumber", R"(grid: {cell: 0.1}
transfer: {damp_modes: 1}
liquid: {sources: [{shape: {ball: {center: [0, 0, 0], radius: 1}}}]}
)",
     "bad.yaml:2: transfer.damp_modes: needs true or false, not \"1\""},
    {"DampingAboveOne", R"(grid: {cell: 0.1}
transfer: {damping: {liquid_affine: 1.1}}
liquid: {sources: [{shape: {ball: {center: [0, 0, 0], radius: 1}}}]}
)",
     "bad.yaml:2: transfer.damping.liquid_affine: \"1.1\" is out of range; must be 0 to 1"},
    {"DampingDtWord", R"(grid: {cell: 0.1}
transfer: {damping_dt: never}
liquid: {sources: [{shape: {ball: {center: [0, 0, 0], radius: 1}}}]}
)",
     "bad.yaml:2: transfer.damping_dt: \"never\" is no number; needs a time like 0.5 or \"0.5 s\""},
    {"VectorTooShort", R"(grid: {cell: 0.1}
gravity: [0, -981]
liquid: {sources: [{shape: {ball: {center: [0, 0, 0], radius: 1}}}]}
)",
     "bad.yaml:2: gravity: needs a list of 3 numbers, like [0, 1, 0], not a list of 2"},
    {"VectorIsNumber", R"(grid: {cell: 0.1}
gravity: -981
liquid: {sources: [{shape: {ball: {center: [0, 0, 0], radius: 1}}}]}
)",
     "bad.yaml:2: gravity: needs a list of 3 numbers, like [0, 1, 0], not \"-981\""},
    {"VectorOfWords", R"(grid: {cell: 0.1}
gravity: [a, b, c]
liquid: {sources: [{shape: {ball: {center: [0, 0, 0], radius: 1}}}]}
)",
     "bad.yaml:2: gravity: \"a\" is no number; needs an acceleration like 0.5 or \"0.5 cm/s^2\""},
    {"WrongDimension", R"(grid: {cell: 0.1}
time: {dt: 3 cm}
liquid: {sources: [{shape: {ball: {center: [0, 0, 0], radius: 1}}}]}
)",
     "bad.yaml:2: time.dt: \"3 cm\" is a length, needs a time (in s)"},
    {"UnknownUnit", R"(grid: {cell: 0.1}
time: {dt: 3 parsec}
liquid: {sources: [{shape: {ball: {center: [0, 0, 0], radius: 1}}}]}
)",
     "bad.yaml:2: time.dt: \"3 parsec\" has the unknown unit \"parsec\"; needs a time like 0.5 or \"0.5 s\""},
    {"UnitOfPlainNumber", R"(grid: {cell: 0.1}
time: {cfl: 3 cm}
liquid: {sources: [{shape: {ball: {center: [0, 0, 0], radius: 1}}}]}
)",
     "bad.yaml:2: time.cfl: \"3 cm\" is a length, needs a plain number"},
    {"StrangeDimension", R"(grid: {cell: 0.1}
time: {dt: 3 g cm}
liquid: {sources: [{shape: {ball: {center: [0, 0, 0], radius: 1}}}]}
)",
     "bad.yaml:2: time.dt: \"3 g cm\" is a different quantity, needs a time (in s)"},
    {"LengthForAngle", R"(grid: {cell: 0.1}
liquid: {contact_angle: 2 cm}
)",
     "bad.yaml:2: liquid.contact_angle: \"2 cm\" is a length, needs an angle (in deg)"},
    {"UnknownPreset", R"(grid: {cell: 0.1}
liquid: {preset: watr}
)",
     "bad.yaml:2: liquid.preset: \"watr\" is unknown (did you mean \"water\"?)"},
    {"FrictionAboveOne", R"(grid: {cell: 0.1}
liquid: {wall_friction: 2}
)",
     "bad.yaml:2: liquid.wall_friction: \"2\" is out of range; must be 0 to 1"},
    {"SpacingZero", R"(grid: {cell: 0.1}
liquid: {particle_spacing: 0}
)",
     "bad.yaml:2: liquid.particle_spacing: \"0\" is out of range; must be above 0, at most 1"},
};

class BadNumbers : public testing::TestWithParam<BadScene> {};

TEST_P(BadNumbers, NameLocationFaultAndRemedy) { expectItsMessage(GetParam()); }

INSTANTIATE_TEST_SUITE_P(LoadScene, BadNumbers, testing::ValuesIn(kBadScenes), [](const auto& scene) { return std::string(scene.param.name); });

}  // namespace
