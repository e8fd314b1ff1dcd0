// Numbers that are read as a scene runs, by the program itself.

#include "app/system/gnuplot.h"
#include "tests/app/probes/probed_runs.h"

#include <algorithm>
#include <cmath>
#include <map>

namespace app::test {
namespace {

TEST_F(ProbedRuns, AreTheRunsThatTheyWouldBeWithout)
{
    ASSERT_EQ(run("without").code, 0);
    for (const char* every : {"1.0e-3", "7.0e-3"}) {
        ASSERT_EQ(run("with", {"--no-frames", "--set", probes(kProbesOfAll), "--set", std::string("output.probes.every=") + every}).code, 0);
        EXPECT_EQ(hash("with"), hash("without"));
        const auto read = table("with/probes.csv");
        const std::vector<double>& times = read.at("time_s");
        EXPECT_EQ(read.size(), 1u + 4 + 5);
        for (const char* name : {"height [cm]", "through [g/s]", "wetness at 0.5 cm [-]", "probe 5 [cm]"})
            EXPECT_EQ(read.at(name).size(), times.size()) << name;
        for (std::size_t i = 1; i < times.size(); ++i)
            EXPECT_GE(std::floor(times[i] / std::stod(every) + 1e-6), std::floor(times[i - 1] / std::stod(every) + 1e-6) + 1.0);
        EXPECT_NEAR(times.back(), 0.08, std::stod(every));
    }
    const std::string script = contentOf(folder / "with/probes.gp");
    EXPECT_NE(script.find("'at 0 cm'"), std::string::npos) << "ends of a line are named by where they are: " << script;
    EXPECT_NE(script.find("'at 2 cm'"), std::string::npos) << script;
}

/// Means since the last reading, which the stop falls into.
constexpr const char* kMeans = R"yaml({every: 7.0e-3,
  control_surfaces: {disc: {center: [0, 0.5, 0], normal: [0, 1, 0], radius: 0.3}},
  readings: [{read: liquid_y}, {name: pressure, read: pressure_on("disc")}, {name: force, read: force_y("sheet")}]})yaml";

TEST_F(ProbedRuns, StoppedAndGoneOnWithHaveTheSameReadings)
{
    for (const char* asked : {kProbesOfAll, kMeans}) {
        const std::vector<std::string> more = {"--no-frames", "--set", probes(asked)};
        std::vector<std::string> half = more;
        half.insert(half.end(), {"--set", "time.duration=0.041"});
        ASSERT_EQ(run("whole", more).code, 0);
        ASSERT_EQ(run("half", half).code, 0);
        ASSERT_EQ(resume("half", {"--no-frames", "--set", "time.duration=0.08"}).code, 0);
        EXPECT_EQ(contentOf(folder / "whole" / "probes.csv"), contentOf(folder / "half" / "probes.csv"));
        EXPECT_EQ(canPlot(), std::filesystem::exists(folder / "half" / "probes.png"));
        std::filesystem::remove_all(folder / "whole");
        std::filesystem::remove_all(folder / "half");
    }
}

/// All that passes a plane has been above it: what goes through is what the mass above loses. The plane lies between layers of particles.
TEST_F(ProbedRuns, FluxIsTheRateAtWhichMassGoesThrough)
{
    const std::string both =
        "{every: 1.0e-3, control_surfaces: {plane: {center: [0, 0.82, 0], normal: [0, -2, 0]}, disc: {center: [0.2, 0.82, 0], normal: [0, 1, 0], "
        "radius: 5},"
        " aside: {center: [9, 0.82, 0], normal: [0, 1, 0], radius: 5}}, readings: [{name: through, read: flux(\"plane\")},"
        " {name: disc, read: flux(\"disc\")}, {name: aside, read: flux(\"aside\")}, {name: above, read: \"mass_y(0.82, 100)\"}]}";
    ASSERT_EQ(run("run", {"--no-frames", "--set", probes(both), "--set", "time.integrator=plain", "--set", "time.dt=5.0e-4"}).code, 0);
    const auto read = table("run/probes.csv");
    const std::vector<double>&time = read.at("time_s"), &through = read.at("through [-]"), &above = read.at("above [-]");
    double gone = 0.0;
    for (std::size_t i = 1; i < time.size(); ++i) {
        gone += 0.5 * (through[i] + through[i - 1]) * (time[i] - time[i - 1]);
        EXPECT_EQ(read.at("disc [-]")[i], -through[i]);
        EXPECT_EQ(read.at("aside [-]")[i], 0.0);
    }
    EXPECT_NEAR(gone, above.front() - above.back(), 0.03 * above.front());
    EXPECT_GT(above.front(), 0.1);
}

/// A pool in a tank, up to y = 1.3, with a lump of liquid on its left half, up to 2.5. At walls and in corners
/// heights are those of the middle; along an axis that is not the vertical they are those of the walls.
TEST_F(ProbedRuns, HeightsAreThoseOfTheSurface)
{
    writeFile(folder / "pool.yaml", R"yaml(drench: 1
scene: {name: pool}
time: {dt: 1.0e-3, duration: 2.0e-3}
grid: {cell: 0.4}
liquid:
  sources:
    - {name: pool, shape: {box: {min: [-2, 0, -2], max: [2, 1.3, 2]}}}
    - {name: lump, shape: {box: {min: [-2, 1.3, -2], max: [0, 2.5, 2]}}}
obstacles: [{name: tank, shape: {box: {min: [-2, 0, -2], max: [2, 9, 2]}}, inside: true}]
output:
  data: [states]
  probes:
    every: 1.0e-3
    readings:
      - {name: right, unit: cm, read: "surface_y(1.1, 0.13)"}
      - {name: left, unit: cm, read: "surface_y(-1.07, -0.4)"}
      - {name: corner, unit: cm, read: "surface_y(2, 2)"}
      - {name: wall, unit: cm, read: "surface_x(0.7, 0)"}
      - {name: outside, unit: cm, read: "surface_y(5, 0)"}
      - {name: row, unit: cm, read: "surface_y(x, z)", along: {from: [-1.5, 0, 0.2], to: [1.5, 0, 0.2], points: 2}}
)yaml");
    ASSERT_EQ(drench({"run", "pool.yaml", "--no-video", "--no-frames", "--threads", "1", "--out", "pool"}).code, 0);
    EXPECT_EQ(canPlot(), std::filesystem::exists(folder / "pool" / "probes.png")) << "of the others, too, where one has no value";
    ASSERT_EQ(drench({"probe", "pool"}).code, 0);
    for (const char* file : {"pool/probes.csv", "pool/probes/probes.csv"}) {
        const auto read = table(file);
        const double near = 0.05;  // cm: an eighth of a cell, over which particles are not even
        EXPECT_NEAR(read.at("right [cm]").front(), 1.3, near) << file;
        EXPECT_NEAR(read.at("left [cm]").front(), 2.5, near) << file;
        EXPECT_NEAR(read.at("corner [cm]").front(), 1.3, near) << file;
        EXPECT_NEAR(read.at("wall [cm]").front(), 2.0, near) << file;
        EXPECT_TRUE(std::isnan(read.at("outside [cm]").front())) << file;
        EXPECT_NEAR(read.at("row at 0 cm [cm]").front(), 2.5, near) << file;
        EXPECT_NEAR(read.at("row at 3 cm [cm]").front(), 1.3, near) << file;
    }
}

/// At rest the floor bears the water over it, but for half a cell of it, and a wall what is over the disc.
TEST_F(ProbedRuns, PressuresOnDiscsAtRestAreThoseOfTheDepth)
{
    writeFile(folder / "pool.yaml", R"yaml(drench: 1
scene: {name: pool}
time: {dt: 2.5e-3, duration: 0.05}
grid: {cell: 0.25}
liquid: {sources: [{name: water, shape: {box: {min: [0, 0, 0], max: [4, 3, 1]}}}]}
obstacles: [{name: tank, shape: {box: {min: [0, 0, 0], max: [4, 9, 1]}}, inside: true}]
output:
  probes:
    every: 1.0e-2
    control_surfaces:
      floor: {center: [2, 0, 0.5], normal: [0, 1, 0], radius: 0.5}
      wall: {center: [0, 1, 0.5], normal: [1, 0, 0], radius: 0.4}
      far: {center: [90, 1, 0.5], normal: [1, 0, 0], radius: 0.4}
    readings: [{name: floor, read: pressure_on("floor")}, {name: wall, read: pressure_on("wall")}, {name: far, read: pressure_on("far")}]
)yaml");
    const ChildExit end = drench({"run", "pool.yaml", "--no-video", "--no-frames", "--threads", "1", "--out", "pool"});
    ASSERT_EQ(end.code, 0) << end.errorText;
    const auto read = table("pool/probes.csv");
    EXPECT_TRUE(std::isnan(read.at("floor [-]").front())) << "before the first step";
    // At the end steps are shorter than the one before, half of whose weight they bear.
    const std::size_t n = read.at("time_s").size() - 2;
    EXPECT_NEAR(read.at("floor [-]")[n], 981.0 * (3.0 - 0.5 * 0.25), 15.0);
    EXPECT_NEAR(read.at("wall [-]")[n], 981.0 * 2.0, 15.0);
    EXPECT_EQ(read.at("far [-]").back(), 0.0);
}

/// A disc on the side of a tank that is lifted stays in the same depth; through a plane that rises with it nothing goes.
TEST_F(ProbedRuns, ControlSurfacesMoveWithTheirObstacles)
{
    writeFile(folder / "lift.yaml", R"yaml(drench: 1
scene: {name: lift}
time: {dt: 2.5e-3, duration: 0.1}
grid: {cell: 0.25}
liquid: {sources: [{name: water, shape: {box: {min: [0, 0, 0], max: [4, 3, 1]}}, velocity: [0, 10, 0]}]}
obstacles:
  - {name: tank, shape: {box: {min: [0, 0, 0], max: [4, 9, 1]}}, inside: true, motion: [{t: [0, 1], ease: [0, 0], translate: [0, 10, 0]}]}
output:
  probes:
    every: 2.0e-2
    control_surfaces:
      side: {center: [0, 1, 0.5], normal: [1, 0, 0], radius: 0.2, moves_with: tank}
      middle: {center: [2, 1.5, 0.5], normal: [0, 1, 0], moves_with: tank}
      resting: {center: [2, 1.5, 0.5], normal: [0, 1, 0]}
    readings: [{name: side, read: pressure_on("side")}, {name: middle, read: flux("middle")}, {name: resting, read: flux("resting")}]
)yaml");
    const ChildExit end = drench({"run", "lift.yaml", "--no-video", "--no-frames", "--threads", "1", "--out", "lift"});
    ASSERT_EQ(end.code, 0) << end.errorText;
    const auto read = table("lift/probes.csv");
    EXPECT_NEAR(read.at("side [-]")[4], 981.0 * 2.0, 100.0);
    EXPECT_NEAR(read.at("resting [-]")[4], 40.0, 4.0);
    EXPECT_NEAR(read.at("middle [-]")[4], 0.0, 2.0);
}

/// What only steps tell has no value before the first, of which nothing needs to be said, and has one from then on.
TEST_F(ProbedRuns, NothingIsReadOfStepsBeforeTheFirst)
{
    const std::string ofSteps = R"yaml({every: 4.0e-3, control_surfaces: {disc: {center: [0, 0.5, 0], normal: [0, 1, 0], radius: 0.3}}, readings: [
        {name: force, read: force_y("sheet")}, {name: torque, read: liquid_torque_x("sheet")}, {name: pins, read: pin_force_y("sheet")},
        {name: disc, read: pressure_on("disc")}, {name: pressure, read: "pressure(0, 0.8, 0)"}, {name: front, read: front_x(0.8)},
        {name: height, read: liquid_y}]})yaml";
    const ChildExit end = run("run", {"--no-frames", "--set", "time.duration=0.01", "--set", probes(ofSteps)});
    ASSERT_EQ(end.code, 0) << end.errorText;
    EXPECT_EQ(end.errorText.find("no value"), std::string::npos) << end.errorText;
    for (const auto& [name, values] : table("run/probes.csv")) {
        EXPECT_EQ(std::isnan(values.at(0)), name != "time_s" && name != "height [-]") << name;
        EXPECT_FALSE(std::isnan(values.at(1))) << name;
    }
}

/// There is no front where no liquid is, which is told, in the place of a front at 0.
TEST_F(ProbedRuns, FrontsHaveNoValueWhereNoLiquidIs)
{
    const ChildExit end = run("run", {"--no-frames", "--set", "time.duration=0.01", "--set",
                                      probes("{every: 4.0e-3, readings: [{name: high, read: front_x(50)}, {name: low, read: front_x(0.8)}]}")});
    ASSERT_EQ(end.code, 0) << end.errorText;
    const auto read = table("run/probes.csv");
    for (std::size_t n = 1; n < read.at("high [-]").size(); ++n) {
        EXPECT_TRUE(std::isnan(read.at("high [-]")[n])) << n;
        EXPECT_FALSE(std::isnan(read.at("low [-]")[n])) << n;
    }
}

/// A jet that a plate stops presses there by half its density times its speed squared, whether steps reflect or not: of two of which the first does
/// both tell only together how much.
TEST_F(ProbedRuns, PressureOnADiscIsThatOfStagnation)
{
    writeFile(folder / "jet.yaml", R"yaml(drench: 1
scene: {name: jet}
gravity: [0, 0, 0]
time: {mode: cfl, cfl: 0.5, dt: 1.0e-2, duration: 0.042}
grid: {cell: 0.25}
liquid: {sources: [{name: jet, shape: {cylinder: {center: [0, 4, 0], axis: [0, 1, 0], radius: 1, half: 3.8}}, velocity: [0, -100, 0]}]}
obstacles: [{name: plate, shape: {box: {min: [-9, -2, -9], max: [9, 0, 9]}}}]
output:
  probes:
    every: 2.0e-2
    control_surfaces: {middle: {center: [0, 0, 0], normal: [0, 1, 0], radius: 0.2}}
    readings: [{name: middle, read: pressure_on("middle")}]
)yaml");
    for (const char* integrator : {"plain", "reflected"}) {
        const ChildExit end = drench({"run", "jet.yaml", "--no-video", "--no-frames", "--threads", "1", "--out", integrator, "--set",
                                      std::string("time.integrator=") + integrator});
        ASSERT_EQ(end.code, 0) << end.errorText;
        EXPECT_NEAR(table(std::string(integrator) + "/probes.csv").at("middle [-]").at(2), 5000.0, 200.0) << integrator;
    }
}

TEST_F(ProbedRuns, MistakesAreToldInOneLineBeforeAnythingIsBegun)
{
    const auto refused = [&](const std::string& section, const std::string& mentions) {
        const ChildExit end = run("run", {"--set", probes(section)});
        EXPECT_EQ(end.code, 2) << section;
        EXPECT_EQ(std::ranges::count(end.errorText, '\n'), 1) << end.errorText;
        EXPECT_NE(end.errorText.find(mentions), std::string::npos) << end.errorText;
        EXPECT_FALSE(std::filesystem::exists(folder / "run")) << section;
    };
    refused("{}", "output.probes.readings is missing");
    refused("{readings: []}", "needs a list of at least one");
    refused("{readings: [{name: a}]}", "read is missing");
    refused("{readings: [{read: liquid_w}]}", "liquid_w");
    refused("{readings: [{read: 'x'}]}", "x");
    refused("{readings: [{read: 'flux(\"gate\")'}]}", "there is no control surface \"gate\"");
    refused("{readings: [{read: 'pressure_on(\"gate\")'}]}", "there is no control surface \"gate\"");
    refused("{control_surfaces: {a: {center: [0, 0, 0], normal: [0, 1, 0]}}, readings: [{read: 'pressure_on(\"a\")'}]}",
            "the control surface \"a\" has no radius: a pressure is the mean over a disc");
    refused("{control_surfaces: {a: {center: [0, 0, 0], normal: [0, 1, 0], moves_with: boat}}, readings: [{read: t}]}",
            "moves_with: there is no obstacle \"boat\": there are none");
    refused("{readings: [{read: 'force_x(\"gate\")'}]}", "no obstacle and no fabric");
    refused("{every: 0, readings: [{read: liquid_y}]}", "above 0 s");
    refused("{readings: [{read: liquid_y, name: 'a, b'}]}", "no commas");
    refused("{readings: [{read: 'x', along: {from: [0, 0, 0]}}]}", "to is missing");
    refused("{control_surfaces: {a: {center: [0, 0, 0], normal: [0, 0, 0]}}, readings: [{read: t}]}", "must be a direction");
    ASSERT_EQ(run("run", {"--no-frames"}).code, 0);
    for (const char* read : {"energy", "front_x(0)", "force_x(\"sheet\")", "pressure_on(\"disc\")"}) {
        writeFile(folder / "probes.yaml",
                  std::string("control_surfaces: {disc: {center: [0, 0, 0], normal: [0, 1, 0], radius: 1}}\nreadings: [{read: '") + read + "'}]");
        const ChildExit end = drench({"probe", "run", "probes.yaml"});
        EXPECT_EQ(end.code, 2) << read;
        EXPECT_NE(end.errorText.find("stored states do not tell of"), std::string::npos) << end.errorText;
        EXPECT_FALSE(std::filesystem::exists(folder / "run" / "probes" / "probes.csv")) << read;
    }
}

}  // namespace
}  // namespace app::test
