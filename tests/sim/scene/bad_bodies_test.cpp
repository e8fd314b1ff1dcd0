#include "tests/sim/scene/bad_scene.h"

// Sources and shapes.

namespace {

const BadScene kBadScenes[] = {
    {"NoSources", "grid: {cell: 0.1}\n",
     "bad.yaml:1: liquid.sources: a scene needs at least one source, like - shape: {ball: {center: [0, 5, 0], radius: 1}}"},
    {"EmptySources", R"(grid: {cell: 0.1}
liquid: {sources: []}
)",
     "bad.yaml:2: liquid.sources: a scene needs at least one source, like - shape: {ball: {center: [0, 5, 0], radius: 1}}"},
    {"SourcesIsMap", R"(grid: {cell: 0.1}
liquid: {sources: {column: 1}}
)",
     "bad.yaml:2: liquid.sources: needs a list like [{shape: …}], not a map"},
    {"SourceIsWord", R"(grid: {cell: 0.1}
liquid: {sources: [ball]}
)",
     "bad.yaml:2: liquid.sources.0: needs a map of keys, not \"ball\""},
    {"SourceWithoutShape", R"(grid: {cell: 0.1}
liquid:
  sources:
    - name: drop
)",
     "bad.yaml:4: liquid.sources.drop.shape is missing; it is what the liquid fills, like shape: {ball: {center: [0, 5, 0], radius: 1}}"},
    {"VelocityFieldIsNoFormula", R"(grid: {cell: 0.1}
liquid: {sources: [{shape: {ball: {center: [0,0,0], radius: 1}}, velocity_field: ["-y", "2 * w", "0"]}]}
)",
     "bad.yaml:2: liquid.sources.0.velocity_field: \"2 * w\": Unexpected token \"w\" found at position 4."},
    {"VelocityFieldOfTwo", R"(grid: {cell: 0.1}
liquid: {sources: [{shape: {ball: {center: [0,0,0], radius: 1}}, velocity_field: ["-y", "x"]}]}
)",
     "bad.yaml:2: liquid.sources.0.velocity_field: needs three formulas of x, y, z like [\"-y\", \"x\", \"0\"], not 2"},
    {"VelocityFieldOfAJet", R"(grid: {cell: 0.1}
liquid: {sources: [{shape: {ball: {center: [0,0,0], radius: 1}}, velocity_field: ["-y", "x", "0"], emit: [{to: 1}]}]}
)",
     "bad.yaml:2: liquid.sources.0.velocity_field: goes without emit: it is that of the initial body"},
    {"VelocityFieldInMetres", R"(units: si
grid: {cell: 0.1}
liquid: {sources: [{shape: {ball: {center: [0,0,0], radius: 1}}, velocity_field: ["-y", "x", "0"]}]}
)",
     "bad.yaml:3: liquid.sources.0.velocity_field: knows centimetres only; write the file in units: cgs"},
    {"SourceNamesTwice", R"(grid: {cell: 0.1}
liquid:
  sources:
    - {name: a, shape: {ball: {center: [0,0,0], radius: 1}}}
    - {name: a, shape: {ball: {center: [0,0,0], radius: 1}}}
)",
     "bad.yaml:5: liquid.sources: two are named \"a\"; rename one"},
    {"SourceNameWithDot", R"(grid: {cell: 0.1}
liquid: {sources: [{name: a.b, shape: {ball: {center: [0,0,0], radius: 1}}}]}
)",
     "bad.yaml:2: liquid.sources.0.name: \"a.b\" may have letters, digits, _ and - only"},
    {"OpeningWithoutFace", R"(grid: {cell: 0.1}
domain: {box: {min: [0, 0, 0], max: [4, 2, 1]}}
liquid: {openings: [{name: to, level: 1}], sources: [{shape: {box: {min: [0, 0, 0], max: [4, 1, 1]}}}]}
)",
     "bad.yaml:3: liquid.openings.to.face is missing; it is the face of the domain that liquid passes, like face: x+"},
    {"OpeningWithoutDomain", R"(grid: {cell: 0.1}
liquid: {openings: [{name: to, face: x+, level: 1}], sources: [{shape: {box: {min: [0, 0, 0], max: [4, 1, 1]}}}]}
)",
     "bad.yaml:2: liquid.openings.to: is in a face of the domain, which must be a box for that, like domain: {box: {min: [0, 0, 0], max: [40, 10, "
     "5]}}"},
    {"OpeningInABall", R"(grid: {cell: 0.1}
domain: {ball: {center: [2, 1, 1], radius: 5}}
liquid: {openings: [{name: to, face: x+, level: 1}], sources: [{shape: {box: {min: [0, 0, 0], max: [4, 1, 1]}}}]}
)",
     "bad.yaml:3: liquid.openings.to: is in a face of the domain, which must be a box for that, like domain: {box: {min: [0, 0, 0], max: [40, 10, "
     "5]}}"},
    {"OpeningsInAShortDomain", R"(grid: {cell: 0.1}
domain: {box: {min: [0, 0, 0], max: [0.5, 2, 1]}}
liquid: {openings: [{name: to, face: x+, level: 1}], sources: [{shape: {box: {min: [0, 0, 0], max: [4, 1, 1]}}}]}
)",
     "bad.yaml:3: liquid.openings.to: the domain is 5 cells long there, and openings need 8; make it longer, or grid.cell smaller"},
    {"OutletWithoutLevel", R"(grid: {cell: 0.1}
domain: {box: {min: [0, 0, 0], max: [4, 2, 1]}}
liquid: {openings: [{name: to, face: x+}], sources: [{shape: {box: {min: [0, 0, 0], max: [4, 1, 1]}}}]}
)",
     "bad.yaml:3: liquid.openings.to: needs a velocity at which liquid comes in, or the level of the liquid that it goes out to, like level: 4"},
    {"LevelWithoutGravity", R"(gravity: [0, 0, 0]
grid: {cell: 0.1}
domain: {box: {min: [0, 0, 0], max: [4, 2, 1]}}
liquid: {openings: [{name: to, face: x+, level: 1}], sources: [{shape: {box: {min: [0, 0, 0], max: [4, 1, 1]}}}]}
)",
     "bad.yaml:4: liquid.openings.to.level: without gravity liquid has no level; leave it out"},
    {"LevelBelowTheDomain", R"(grid: {cell: 0.1}
domain: {box: {min: [0, 0, 0], max: [4, 2, 1]}}
liquid: {openings: [{name: to, face: x+, level: -1}], sources: [{shape: {box: {min: [0, 0, 0], max: [4, 1, 1]}}}]}
)",
     "bad.yaml:3: liquid.openings.to.level: is below the domain, which begins at 0 cm; raise it"},
    {"LevelWithSlantedGravity", R"(gravity: [1, -900, 0]
grid: {cell: 0.1}
domain: {box: {min: [0, 0, 0], max: [4, 2, 1]}}
liquid: {openings: [{name: to, face: x+, level: 1}], sources: [{shape: {box: {min: [0, 0, 0], max: [4, 1, 1]}}}]}
)",
     "bad.yaml:4: liquid.openings.to.level: needs gravity along an axis; turn the scene"},
    {"OpeningsInOneFace", R"(grid: {cell: 0.1}
domain: {box: {min: [0, 0, 0], max: [4, 2, 1]}}
liquid: {openings: [{name: a, face: x+, level: 1}, {name: b, face: x+, level: 1}], sources: [{shape: {box: {min: [0, 0, 0], max: [4, 1, 1]}}}]}
)",
     "bad.yaml:3: liquid.openings.b: a is in that face already; choose another"},
    {"OpeningThatIsClosed", R"(grid: {cell: 0.1}
domain: {box: {min: [0, 0, 0], max: [4, 2, 1]}}
liquid: {openings: [{name: to, face: x+, level: 1}], sources: [{shape: {box: {min: [0, 0, 0], max: [4, 1, 1]}}}]}
obstacles: [{name: box, inside: true, shape: {box: {min: [0, 0, 0], max: [3, 2, 1]}}}]
)",
     "bad.yaml:3: liquid.openings.to: obstacles close all of the face below its level; leave liquid a way to it"},
    {"LevelBelowAllOfTheFace", R"(grid: {cell: 0.1}
domain: {box: {min: [0, 0, 0], max: [4, 2, 1]}}
liquid: {openings: [{name: to, face: y+, level: 1}], sources: [{shape: {box: {min: [0, 0, 0], max: [4, 1, 1]}}}]}
)",
     "bad.yaml:3: liquid.openings.to.level: is below all of the face; raise it"},
    {"OpeningOfAFullBox", R"(grid: {cell: 0.1}
domain: {box: {min: [0, 0, 0], max: [4, 2, 1]}}
liquid: {openings: [{name: to, face: x+, level: 1}], full: true, sources: [{shape: {box: {min: [0, 0, 0], max: [4, 1, 1]}}}]}
)",
     "bad.yaml:3: liquid.openings.to: liquid.full is a closed box; leave full out, an outlet sets the pressure"},
    {"ShapeUnknown", R"(grid: {cell: 0.1}
liquid:
  sources:
    - shape: {bal: {center: [0, 0, 0], radius: 1}}
)",
     "bad.yaml:4: unknown key \"bal\" in liquid.sources.0.shape (did you mean \"ball\"?)"},
    {"ShapeWithoutBody", R"(grid: {cell: 0.1}
liquid:
  sources:
    - shape: {translate: [1, 0, 0]}
)",
     "bad.yaml:4: liquid.sources.0.shape: names no body; it takes one of box, rounded_box, ball, capsule, cylinder, mesh, union, "
     "intersect, subtract, invert"},
    {"ShapeWithTwoBodies", R"(grid: {cell: 0.1}
liquid:
  sources:
    - shape: {ball: {center: [0, 0, 0], radius: 1}, box: {center: [0, 0, 0], half: [1, 1, 1]}}
)",
     "bad.yaml:4: liquid.sources.0.shape: has both box and ball; put them into a union"},
    {"ShapeIsWord", R"(grid: {cell: 0.1}
liquid:
  sources:
    - shape: ball
)",
     "bad.yaml:4: liquid.sources.0.shape: needs a shape like {ball: {center: [0, 5, 0], radius: 1}}, not \"ball\""},
    {"NegativeRadius", R"(grid: {cell: 0.1}
liquid:
  sources:
    - shape: {ball: {center: [0, 0, 0], radius: -1}}
)",
     "bad.yaml:4: liquid.sources.0.shape.ball.radius: \"-1\" is out of range; must be above 0, at most 10000000 cm"},
    {"NoRadius", R"(grid: {cell: 0.1}
liquid:
  sources:
    - shape: {ball: {center: [0, 0, 0]}}
)",
     "bad.yaml:4: liquid.sources.0.shape.ball.radius is missing; it is the size of the ball, like radius: 1.44"},
    {"NanCenter", R"(grid: {cell: 0.1}
liquid:
  sources:
    - shape: {ball: {center: [0, .nan, 0], radius: 1}}
)",
     "bad.yaml:4: liquid.sources.0.shape.ball.center: \".nan\" is not finite; write a number"},
    {"FarCenter", R"(grid: {cell: 0.1}
liquid:
  sources:
    - shape: {ball: {center: [0, 1.0e+9, 0], radius: 1}}
)",
     "bad.yaml:4: liquid.sources.0.shape.ball: lies beyond 10000000 cm"},
    {"BoxNegative", R"(grid: {cell: 0.1}
liquid:
  sources:
    - shape: {box: {center: [0, 0, 0], half: [1, -1, 1]}}
)",
     "bad.yaml:4: liquid.sources.0.shape.box.half: must be above 0 cm in every direction"},
    {"BoxInsideOut", R"(grid: {cell: 0.1}
liquid:
  sources:
    - shape: {box: {min: [0, 0, 0], max: [1, 0, 1]}}
)",
     "bad.yaml:4: liquid.sources.0.shape.box.max: must be above min in every direction"},
    {"BoxHalfGiven", R"(grid: {cell: 0.1}
liquid:
  sources:
    - shape: {box: {min: [0, 0, 0], half: [1, 1, 1]}}
)",
     "bad.yaml:4: liquid.sources.0.shape.box: needs either center and half, or min and max"},
    {"RoundedBoxWithoutRound", R"(grid: {cell: 0.1}
liquid:
  sources:
    - shape: {rounded_box: {center: [0, 0, 0], half: [1, 1, 1]}}
)",
     "bad.yaml:4: liquid.sources.0.shape.rounded_box.round is missing; it is the radius of the edges, added outside of half"},
    {"CylinderAxisZero", R"(grid: {cell: 0.1}
liquid:
  sources:
    - shape: {cylinder: {center: [0, 0, 0], axis: [0, 0, 0], radius: 1, half: 1}}
)",
     "bad.yaml:4: liquid.sources.0.shape.cylinder.axis: must be a direction, like [0, 1, 0]"},
    {"UnionOfNothing", R"(grid: {cell: 0.1}
liquid:
  sources:
    - shape: {union: []}
)",
     "bad.yaml:4: liquid.sources.0.shape.union: needs a list of shapes, not an empty list"},
    {"UnionOfMap", R"(grid: {cell: 0.1}
liquid:
  sources:
    - shape: {union: {ball: {center: [0, 0, 0], radius: 1}}}
)",
     "bad.yaml:4: liquid.sources.0.shape.union: needs a list of shapes, not a map"},
    {"BadPartOfUnion", R"(grid: {cell: 0.1}
liquid:
  sources:
    - shape: {union: [{ball: {center: [0, 0, 0], radius: 1}}, {ball: {center: [0, 0, 0], radius: 0}}]}
)",
     "bad.yaml:4: liquid.sources.0.shape.union.1.ball.radius: \"0\" is out of range; must be above 0, at most 10000000 cm"},
    {"MeshMissing", R"(grid: {cell: 0.1}
liquid:
  sources:
    - shape: {mesh: {file: nowhere.obj}}
)",
     "bad.yaml:4: liquid.sources.0.shape.mesh.file: there is no file \"./nowhere.obj\""},
    {"RotateWithoutAngle", R"(grid: {cell: 0.1}
liquid:
  sources:
    - shape: {ball: {center: [0, 0, 0], radius: 1}, rotate: {axis: [0, 0, 1]}}
)",
     "bad.yaml:4: liquid.sources.0.shape.rotate.angle is missing; it is how far to turn, in degrees, like angle: 30"},
    {"SourceApart", R"(grid: {cell: 0.1}
liquid:
  sources:
    - shape: {intersect: [{ball: {center: [0, 0, 0], radius: 1}}, {ball: {center: [5, 0, 0], radius: 1}}]}
)",
     "bad.yaml:4: liquid.sources.0: is empty: its shape has no volume; make its parts overlap"},
    {"SourceUnbounded", R"(grid: {cell: 0.1}
liquid:
  sources:
    - shape: {invert: {ball: {center: [0, 0, 0], radius: 1}}}
)",
     "bad.yaml:4: liquid.sources.0: reaches to infinity; intersect its shape with a box"},
    {"SourceOutsideOfDomain", R"(grid: {cell: 0.1}
liquid:
  sources:
    - shape: {ball: {center: [0, 0, 0], radius: 1}}
domain: {box: {min: [5, 0, 0], max: [6, 1, 1]}}
)",
     "bad.yaml:4: liquid.sources.0: is empty: its shape lies outside of the domain or inside obstacles; move it"},
    {"SourceInsideObstacle", R"(grid: {cell: 0.1}
liquid:
  sources:
    - shape: {ball: {center: [0, 0, 0], radius: 1}}
obstacles: [{shape: {ball: {center: [0, 0, 0], radius: 2}}}]
)",
     "bad.yaml:4: liquid.sources.0: is empty: its shape lies outside of the domain or inside obstacles; move it"},
    {"TooManyParticles", R"(grid: {cell: 1.0e-4}
liquid: {sources: [{shape: {ball: {center: [0, 0, 0], radius: 1}}}]}
)",
     "bad.yaml:2: liquid.sources.0: would be about 6.5e+13 particles (at most 2e+08 are possible); use a larger grid.cell than 0.0001 cm"},
    {"EmitEmpty", R"(grid: {cell: 0.1}
liquid:
  sources:
    - shape: {ball: {center: [0, 0, 0], radius: 1}}
      emit: []
)",
     "bad.yaml:5: liquid.sources.0.emit: is empty; remove it, or give a span like {from: 0, to: 0.5}"},
    {"EmitBackwards", R"(grid: {cell: 0.1}
liquid:
  sources:
    - shape: {ball: {center: [0, 0, 0], radius: 1}}
      emit: [{from: 1, to: 0.5}]
)",
     "bad.yaml:5: liquid.sources.0.emit.0: to must be after from"},
    {"EmitBeforeStart", R"(grid: {cell: 0.1}
time: {start: 2}
liquid:
  sources:
    - shape: {ball: {center: [0, 0, 0], radius: 1}}
      emit: [{from: 0, to: 1}]
)",
     "bad.yaml:6: liquid.sources.0.emit.0: ends at 1 s, before the run starts at 2 s"},
    {"EmitWithoutEnd", R"(grid: {cell: 0.1}
liquid:
  sources:
    - shape: {ball: {center: [0, 0, 0], radius: 1}}
      emit: [{from: 1}]
)",
     "bad.yaml:5: liquid.sources.0.emit.0.to is missing; it is the end of the span in which the source gives liquid, like to: 0.5"},
    {"FillUnknown", R"(grid: {cell: 0.1}
liquid:
  sources:
    - shape: {ball: {center: [0, 0, 0], radius: 1}}
      fill: latice
)",
     "bad.yaml:5: liquid.sources.0.fill.pattern: \"latice\" is unknown (did you mean \"lattice\"?)"},
    {"SeedNegative", R"(grid: {cell: 0.1}
liquid:
  sources:
    - shape: {ball: {center: [0, 0, 0], radius: 1}}
      fill: {seed: -1}
)",
     "bad.yaml:5: liquid.sources.0.fill.seed: needs a whole number, 0 or more, not \"-1\""},
};

class BadBodies : public testing::TestWithParam<BadScene> {};

TEST_P(BadBodies, NameLocationFaultAndRemedy) { expectItsMessage(GetParam()); }

INSTANTIATE_TEST_SUITE_P(LoadScene, BadBodies, testing::ValuesIn(kBadScenes), [](const auto& scene) { return std::string(scene.param.name); });

}  // namespace
