#include "tests/sim/scene/bad_scene.h"

#include <filesystem>
#include <fstream>

#include <unistd.h>

// Materials, pieces of fabric, pins and their motions.

namespace {

/// One mistake in an otherwise fine scene; lines 1 and 2 are the grid and the material wool.
struct BadFabric {
    const char* name;
    const char* text;
    const char* message;
};

void PrintTo(const BadFabric& bad, std::ostream* out) { *out << bad.name; }

const char* const kBegin = "grid: {cell: 0.1}\nmaterials: {wool: {young: 1.0e+6}}\n";

const BadFabric kBadFabrics[] = {
    {"NoShape", "fabrics: [{name: cloth}]\n",
     "bad.yaml:3: fabrics.cloth: says no fabric; it takes one of cloth_grid, woven_yarns, strand, mesh, points"},
    {"InfiniteDrag",
     "fabrics: [{strand: {material: wool, from: [0, 0, 0], to: [1, 0, 0], segments: 2, radius: 0.1}}]\n"
     "liquid: {viscosity: 0, sources: [{shape: {ball: {center: [0, 2, 0], radius: 1}}}]}\n",
     "bad.yaml:3: fabrics: nonlinear drag with exponent 1.6 is infinite at liquid.viscosity 0; give a viscosity, "
     "or choose coupling.drag_exponent 1 or coupling.drag linear"},
    {"TwoShapes", "fabrics: [{strand: {}, cloth_grid: {}}]\n", "bad.yaml:3: fabrics.0: has both cloth_grid and strand; make them two pieces"},
    {"NotAList", "fabrics: {cloth: {}}\n", "bad.yaml:3: fabrics: needs a list like [{cloth_grid: …}], not a map"},
    {"NamesTwice",
     "fabrics:\n  - {name: a, strand: {material: wool, from: [0, 0, 0], to: [1, 0, 0], segments: 2, radius: 0.1}}\n"
     "  - {name: a, strand: {material: wool, from: [0, 1, 0], to: [1, 1, 0], segments: 2, radius: 0.1}}\n",
     "bad.yaml:5: fabrics: two are named \"a\"; rename one"},
    {"NoMaterial", "fabrics: [{strand: {from: [0, 0, 0], to: [1, 0, 0], segments: 2, radius: 0.1}}]\n",
     "bad.yaml:3: fabrics.0.material is missing; it is the name of one of materials (there is wool)"},
    {"UnknownMaterial", "fabrics: [{strand: {material: wol, from: [0, 0, 0], to: [1, 0, 0], segments: 2, radius: 0.1}}]\n",
     "bad.yaml:3: fabrics.0.material: materials has no \"wol\" (did you mean \"wool\"?)"},
    {"MaterialTwice",
     "fabrics: [{material: wool, strand: {material: wool, from: [0, 0, 0], to: [1, 0, 0], segments: 2, radius: "
     "0.1}}]\n",
     "bad.yaml:3: fabrics.0.material: is given twice; remove one"},
    {"NoRadius", "fabrics: [{strand: {material: wool, from: [0, 0, 0], to: [1, 0, 0], segments: 2}}]\n",
     "bad.yaml:3: fabrics.0.strand.radius is missing; it is half the thickness of a yarn or of the cloth, like radius: "
     "0.02; "
     "[a, b] is an elliptic section"},
    {"NoThickness", "fabrics: [{cloth_grid: {material: wool, nodes: [3, 3], spacing: 0.1}}]\n",
     "bad.yaml:3: fabrics.0.cloth_grid.radius is missing; it is half the thickness of the cloth, like radius: 0.02, where its material has no "
     "thickness"},
    {"WarpAcross", "fabrics: [{cloth_grid: {material: wool, nodes: [3, 3], spacing: 0.1, radius: 0.1, warp: [0, 0, 0]}}]\n",
     "bad.yaml:3: fabrics.0.cloth_grid.warp: must be a direction, like [0, 1, 0]"},
    {"RadiusNegative", "fabrics: [{strand: {material: wool, from: [0, 0, 0], to: [1, 0, 0], segments: 2, radius: [0.1, -1]}}]\n",
     "bad.yaml:3: fabrics.0.strand.radius: \"-1\" is out of range; must be above 0, at most 10000000 cm"},
    {"OneNode", "fabrics: [{cloth_grid: {material: wool, nodes: [1, 5], spacing: 0.1, radius: 0.1}}]\n",
     "bad.yaml:3: fabrics.0.cloth_grid.nodes: 1 is out of range; must be 2 to 5000000"},
    {"NodesIsNumber", "fabrics: [{cloth_grid: {material: wool, nodes: 5, spacing: 0.1, radius: 0.1}}]\n",
     "bad.yaml:3: fabrics.0.cloth_grid.nodes: needs a list of 2 whole numbers, like [20, 30], not \"5\""},
    {"SpacingAndSize", "fabrics: [{cloth_grid: {material: wool, nodes: [5, 5], spacing: 0.1, size: 1, radius: 0.1}}]\n",
     "bad.yaml:3: fabrics.0.cloth_grid: needs either spacing or size"},
    {"NeitherSpacingNorSize", "fabrics: [{cloth_grid: {material: wool, nodes: [5, 5], radius: 0.1}}]\n",
     "bad.yaml:3: fabrics.0.cloth_grid: needs either spacing or size"},
    {"SizeNegative", "fabrics: [{cloth_grid: {material: wool, nodes: [5, 5], size: [1, -1], radius: 0.1}}]\n",
     "bad.yaml:3: fabrics.0.cloth_grid.size: \"-1\" is out of range; must be above 0, at most 10000000 cm"},
    {"OriginAndCenter",
     "fabrics: [{cloth_grid: {material: wool, nodes: [5, 5], spacing: 1, radius: 0.1, origin: [0, 0, 0], center: [0, "
     "0, 0]}}]\n",
     "bad.yaml:3: fabrics.0.cloth_grid.center: stands for origin; give one of them"},
    {"ParallelAxes", "fabrics: [{cloth_grid: {material: wool, nodes: [5, 5], spacing: 1, radius: 0.1, u: [0, 0, 2]}}]\n",
     "bad.yaml:3: fabrics.0.cloth_grid: u and v must point in different directions"},
    {"ZeroAxis", "fabrics: [{cloth_grid: {material: wool, nodes: [5, 5], spacing: 1, radius: 0.1, u: [0, 0, 0]}}]\n",
     "bad.yaml:3: fabrics.0.cloth_grid.u: must be a direction, like [0, 1, 0]"},
    {"TooManyVertices", "fabrics: [{cloth_grid: {material: wool, nodes: [10000, 10000], spacing: 1, radius: 0.1}}]\n",
     "bad.yaml:3: fabrics.0.cloth_grid: would have 1e+08 vertices (at most 5e+06 are possible); ask for fewer"},
    {"TooManyTogether",
     "fabrics:\n  - {cloth_grid: {material: wool, nodes: [2000, 2000], spacing: 1, radius: 0.1}}\n"
     "  - {cloth_grid: {material: wool, nodes: [2000, 2000], spacing: 1, radius: 0.1}}\n",
     "bad.yaml:5: fabrics: together have 8000000 vertices; at most 5000000 are possible"},
    {"WeaveUnknown", "fabrics: [{woven_yarns: {material: wool, yarns: [9, 9], spacing: 0.1, radius: 0.01, weave: twil}}]\n",
     "bad.yaml:3: fabrics.0.woven_yarns.weave: \"twil\" is unknown (did you mean \"twill\"?)"},
    {"TooFewYarns", "fabrics: [{woven_yarns: {material: wool, yarns: [2, 9], spacing: 0.1, radius: 0.01}}]\n",
     "bad.yaml:3: fabrics.0.woven_yarns.yarns: 2 is out of range; must be 3 to 5000000"},
    {"StrandOfNothing", "fabrics: [{strand: {material: wool, radius: 0.01, from: [0, 0, 0]}}]\n",
     "bad.yaml:3: fabrics.0.strand: needs either points, or from, to and segments"},
    {"StrandOfBoth", "fabrics: [{strand: {material: wool, radius: 0.01, points: [[0, 0, 0], [1, 0, 0]], segments: 4}}]\n",
     "bad.yaml:3: fabrics.0.strand: needs either points, or from, to and segments"},
    {"StrandOfOnePoint", "fabrics: [{strand: {material: wool, radius: 0.01, points: [[0, 0, 0]]}}]\n",
     "bad.yaml:3: fabrics.0.strand.points: needs two or more points, like [[0, 0, 0], [1, 0, 0]], not a list of 1"},
    {"StrandWithoutLength", "fabrics: [{strand: {material: wool, radius: 0.01, from: [1, 0, 0], to: [1, 0, 0], segments: 2}}]\n",
     "bad.yaml:3: fabrics.0.strand: from and to are the same point"},
    {"StrandPointTwice", "fabrics: [{strand: {material: wool, radius: 0.01, points: [[0, 0, 0], [1, 0, 0], [1, 0, 0]]}}]\n",
     "bad.yaml:3: fabrics.0: vertices 1 and 2 of a yarn are at one place; remove one"},
    {"StrandTurnsBack", "fabrics: [{strand: {material: wool, radius: 0.01, points: [[0, 0, 0], [2, 0, 0], [1, 0, 0]]}}]\n",
     "bad.yaml:3: fabrics.0: a yarn turns straight back at vertex 1; make a bend"},
    {"MeshMissing", "fabrics: [{mesh: {material: wool, file: nowhere.obj, radius: 0.1}}]\n",
     "bad.yaml:3: fabrics.0.mesh.file: there is no file \"./nowhere.obj\""},
    {"Wetness", "fabrics: [{wetness: 1.5, strand: {material: wool, from: [0, 0, 0], to: [1, 0, 0], segments: 2, radius: 0.1}}]\n",
     "bad.yaml:3: fabrics.0.wetness: \"1.5\" is out of range; must be 0 to 1"},
    {"UnknownKey",
     "fabrics: [{velocty: [0, 0, 0], strand: {material: wool, from: [0, 0, 0], to: [1, 0, 0], segments: 2, radius: "
     "0.1}}]\n",
     "bad.yaml:3: unknown key \"velocty\" in fabrics.0 (did you mean \"velocity\"?)"},
    {"SolverUnknown", "fabric: {solver: vertx}\n", "bad.yaml:3: fabric.solver: \"vertx\" is unknown (did you mean \"vertex\"?)"},
    {"PorousOfOne", "porous: {volume_fraction: 0.4}\n", "bad.yaml:3: porous: needs two of fibre_diameter, volume_fraction, pore_radius"},
    {"PorousWithoutPores", "porous: {volume_fraction: 1, pore_radius: 0.1}\n",
     "bad.yaml:3: porous: with volume_fraction 1 there are no pores; leave pore_radius out"},
    {"ThreadsWithoutThickness", "porous: {fibre_diameter: 0.01, thread_count: 80}\n",
     "bad.yaml:3: porous: thread_count and thickness need each other"},
};

const char* const kSheet =
    "fabrics:\n"
    "  - name: cloth\n"
    "    cloth_grid: {material: wool, nodes: [5, 5], spacing: 1, radius: 0.1}\n";

const BadFabric kBadPins[] = {
    {"Nothing", "    pin: {name: a}\n", "bad.yaml:6: fabrics.cloth.pin: selects nothing; it takes one of corners, edge, nodes, shape, box, ball"},
    {"TwoThings", "    pin: {corners: all, edge: x-}\n", "bad.yaml:6: fabrics.cloth.pin: has both corners and edge; make them two pins in a list"},
    {"Empty", "    pin: {name: left, ball: {center: [9, 9, 9], radius: 1}}\n",
     "bad.yaml:6: fabrics.cloth.pin, \"left\": holds no vertex; move or enlarge what it selects"},
    {"NoNodes", "    pin: {nodes: []}\n", "bad.yaml:6: fabrics.cloth.pin: holds no vertex; move or enlarge what it selects"},
    {"NodeTooHigh", "    pin: [{nodes: [25]}]\n", "bad.yaml:6: fabrics.cloth.pin.0.nodes: 25 is out of range; must be 0 to 24"},
    {"CornersIsWord", "    pin: {corners: both}\n",
     "bad.yaml:6: fabrics.cloth.pin.corners: needs all, or a list like [\"x- z-\", \"x- z+\"], not \"both\""},
    {"NoSuchSide", "    pin: {corners: [left]}\n", "bad.yaml:6: fabrics.cloth.pin.corners: \"left\" is no side; write x-, x+, y-, y+, z- or z+"},
    {"FlatAlongY", "    pin: {corners: [\"x- y-\"]}\n", "bad.yaml:6: fabrics.cloth.pin.corners: the piece has no corner \"x- y-\""},
    {"EdgeAlongY", "    pin: {edge: y+}\n", "bad.yaml:6: fabrics.cloth.pin.edge: the piece has no side \"y+\""},
    {"PatchOfNodes", "    pin: {nodes: [1], patch: 2}\n", "bad.yaml:6: fabrics.cloth.pin.patch: needs corners or edge"},
    {"PatchZero", "    pin: {corners: all, patch: 0}\n", "bad.yaml:6: fabrics.cloth.pin.patch: 0 is out of range; must be 1 to 1000000"},
    {"MotionOfNobody", "    pin: {name: left, edge: x-}\nmotion: {lefft: {t: [0, 1], translate: [0, 1, 0]}}\n",
     "bad.yaml:7: motion: no obstacle, pin or fabric is named \"lefft\" (did you mean \"left\"?)"},
    {"MotionOfUnpinned", "motion: [{group: cloth, t: [0, 1], translate: [0, 1, 0]}]\n",
     "bad.yaml:6: motion: fabric \"cloth\" has no pin; a motion moves pins, give it one"},
    {"MotionTwice",
     "    pin: {name: left, edge: x-, motion: {t: [0, 1], translate: [0, 1, 0]}}\n"
     "motion: {left: {t: [0, 1], translate: [0, 1, 0]}}\n",
     "bad.yaml:7: motion: \"left\" has a motion already; put all pieces into one list"},
    {"TwoWays", "    pin:\n      - {edge: x-}\n      - {edge: z-, motion: {t: [0, 1], translate: [0, 1, 0]}}\n",
     "bad.yaml:8: fabrics.cloth.pin: vertex 0 is held by two pins that move differently; let them not overlap"},
};

const BadFabric kBadMaterials[] = {
    {"NotAMap", "materials: [wool]\n", "bad.yaml:2: materials: needs a map like {wool: {young: 6.6e+7}}, not a list of 1"},
    {"WithoutYoung", "materials: {wool: {poisson: 0.2}}\n",
     "bad.yaml:2: materials.wool.young is missing; it is Young's modulus of the fibres, like young: 6.6e+7 (dyn/cm^2) "
     "or young: "
     "6.6 MPa"},
    {"YoungZero", "materials: {wool: {young: 0}}\n", "bad.yaml:2: materials.wool.young: \"0\" is out of range; must be above 0 dyn/cm^2"},
    {"PoissonTooHigh", "materials: {wool: {young: 1, poisson: 0.5}}\n",
     "bad.yaml:2: materials.wool.poisson: \"0.5\" is out of range; must be above -1, below 0.5"},
    {"PoissonTooLow", "materials: {wool: {young: 1, poisson: -1}}\n",
     "bad.yaml:2: materials.wool.poisson: \"-1\" is out of range; must be above -1, below 0.5"},
    {"FractionAboveOne", "materials: {wool: {young: 1, volume_fraction: 1.2}}\n",
     "bad.yaml:2: materials.wool.volume_fraction: \"1.2\" is out of range; must be above 0, at most 1"},
    {"UnknownKey", "materials: {wool: {young: 1, friction: 30}}\n",
     "bad.yaml:2: unknown key \"friction\" in materials.wool (there is preset, young, poisson, density, damping_viscosity, "
     "damp_bending, damp_stretching, stretch_factor, contact_stiffness, pin_stiffness, friction_angle, "
     "volume_fraction, "
     "section_rotation, thickness, stretch_stiffness, shear_stiffness, bending_stiffness)"},
    {"UnknownPreset", "materials: {jeans: {preset: denm}}\n", "bad.yaml:2: materials.jeans.preset: \"denm\" is unknown (did you mean \"denim\"?)"},
    {"WarpWithoutWeft", "materials: {wool: {young: 1, bending_stiffness: [1, 0]}}\n",
     "bad.yaml:2: materials.wool.bending_stiffness: one of warp and weft is 0; give both, or 0 for both"},
    {"ShearWithoutStretch", "materials: {wool: {young: 1, shear_stiffness: 1}}\n",
     "bad.yaml:2: materials.wool.shear_stiffness: needs stretch_stiffness"},
    {"WarpAndNeoHookean", "materials: {wool: {preset: wool}}\nfabric: {membrane: neo_hookean}\n",
     "bad.yaml:3: fabric.membrane: is alike in all directions, and materials.wool has stretch_stiffness along warp and weft; choose stvk"},
    {"WarpAndHinges", "materials: {wool: {young: 1, bending_stiffness: [1, 2]}}\nfabric: {bending: hinge}\n",
     "bad.yaml:3: fabric.bending: is alike in all directions, and materials.wool has bending_stiffness along warp and weft; choose shape_operator"},
    {"FibresOfTwoKinds",
     "materials: {a: {preset: silk}, b: {preset: wool}}\nfabrics: [{cloth_grid: {material: a, nodes: [3, 3], size: 1}}]\n"
     "liquid: {sources: [{shape: {ball: {center: [0, 2, 0], radius: 1}}}]}\n",
     "bad.yaml:2: materials: fibres of a are 0.0012 cm thick and those of b 0.0021 cm, and liquid flows around one kind; say porous: "
     "{fibre_diameter: 0.0012, volume_fraction: 0.3}"},
    {"NameWithDot", "materials: {a b: {young: 1}}\n", "bad.yaml:2: materials: \"a b\" may have letters, digits, _ and - only"},
};

class BadFabrics : public testing::TestWithParam<BadFabric> {};
class BadPins : public testing::TestWithParam<BadFabric> {};
class BadMaterials : public testing::TestWithParam<BadFabric> {};

void expectMessage(const std::string& begin, const BadFabric& bad)
{
    const std::string text = begin + bad.text;
    expectItsMessage({bad.name, text.c_str(), bad.message});
}

TEST_P(BadFabrics, NameLocationFaultAndRemedy) { expectMessage(kBegin, GetParam()); }

TEST_P(BadPins, NameLocationFaultAndRemedy) { expectMessage(std::string(kBegin) + kSheet, GetParam()); }

TEST_P(BadMaterials, NameLocationFaultAndRemedy) { expectMessage("grid: {cell: 0.1}\n", GetParam()); }

const auto nameOf = [](const auto& bad) { return std::string(bad.param.name); };

INSTANTIATE_TEST_SUITE_P(LoadScene, BadFabrics, testing::ValuesIn(kBadFabrics), nameOf);
INSTANTIATE_TEST_SUITE_P(LoadScene, BadPins, testing::ValuesIn(kBadPins), nameOf);
INSTANTIATE_TEST_SUITE_P(LoadScene, BadMaterials, testing::ValuesIn(kBadMaterials), nameOf);

/// The end of the message that a mesh or points file with this text gives.
void expectFileRefused(const std::string& kind, const std::string& obj, const std::string& what)
{
    const auto file = std::filesystem::temp_directory_path() / ("drench_bad_fabric_" + std::to_string(getpid()) + ".obj");
    std::ofstream(file) << obj;
    const std::string text = kBegin + ("fabrics: [{" + kind + ": {material: wool, radius: 0.1, file: " + file.string() + "}}]\n");
    try {
        sim::readScene(sim::sceneFileFromText(text, "bad.yaml"));
        ADD_FAILURE() << "loaded: " << what;
    } catch (const sim::InputError& e) {
        const std::string message = e.what();
        EXPECT_EQ(0u, message.find("bad.yaml:3: fabrics.0")) << message;
        EXPECT_NE(std::string::npos, message.find(what)) << message;
    }
    std::filesystem::remove(file);
}

TEST(BadFabricFiles, SayWhereAndWhat)
{
    const std::string square = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";
    expectFileRefused("mesh", square + "f 1 2 3\nf 1 1 4\n", "the face 0, 0, 3 has no area; remove it");
    expectFileRefused("mesh", square + "v 0 0 1\nf 1 2 3\nf 1 2 4\nf 1 2 5\n", "the edge between vertices 0 and 1 has more than two faces");
    expectFileRefused("mesh", square + "l 1 2 3 4\n", "has no faces");
    expectFileRefused("points", square + "f 1 2 3\n", "has no lines (l)");
    expectFileRefused("points", square + "l 1\n", "a line needs two vertices or more");
}

}  // namespace
