#include "sim/scene/parameters.h"
#include "sim/scene/read_changes.h"
#include "tests/sim/scene/bad_scene.h"

#include <algorithm>

// Settings that change during a run, and the list of settings that there are.

namespace {

const std::string kScene = R"(grid: {cell: 0.1}
transfer: polypic
materials: {wool: {young: 6.0e+7}}
liquid: {preset: oil, sources: [{name: drop, shape: {ball: {center: [0, 0, 0], radius: 1}}}]}
)";

sim::Scene sceneWith(const std::string& more) { return sim::readScene(sim::sceneFileFromText(kScene + more, "scene.yaml")); }

TEST(SceneChanges, HoldFromTheirStepOnTopOfThoseBefore)
{
    const sim::Scene scene = sceneWith(R"(changes:
  - {step: 7, set: {time.dt: 2 ms, transfer.modes.liquid: 27}}
  - {step: 9, set: {gravity: [0, 0, 1], materials.wool.friction_angle: 45}}
)");
    ASSERT_EQ(scene.changes.size(), 2u);
    EXPECT_EQ(scene.changes[0].step, 7);
    EXPECT_EQ(scene.changes[0].settings.time.dt, 2.0e-3);
    EXPECT_EQ(scene.changes[0].settings.transfer.modes, 27);
    EXPECT_EQ(scene.changes[0].settings.fabricTransfer.modes, 8) << "of the liquid alone";
    EXPECT_EQ(scene.changes[0].settings.gravity, scene.settings.gravity);
    EXPECT_EQ(scene.changes[1].settings.time.dt, 2.0e-3) << "what changed before stays";
    EXPECT_EQ(scene.changes[1].settings.gravity, sim::Vec3(0.0, 0.0, 1.0));
    EXPECT_DOUBLE_EQ(scene.changes[1].materials[0].material.frictionAngle, sim::kPi / 4.0);
    EXPECT_DOUBLE_EQ(scene.materials[0].material.frictionAngle, sim::kPi / 6.0);
}

TEST(SceneChanges, ArePrintedInUnitsThatReadBackAlike)
{
    const std::string si = "units: si\n" + kScene + R"(changes:
  - {step: 3, set: {time.dt: 0.3 ms, gravity: [0, -1.62, 0.1], liquid.viscosity: 0.1}}
  - {step: 3, set: {transfer: {method: {fabric: apic}, damping_dt: step}}}
)";
    const sim::Scene scene = sim::readScene(sim::sceneFileFromText(si, "scene.yaml"));
    const sim::Scene again = sim::readScene(sim::sceneFileFromText(sim::printScene(scene), "printed.yaml"));
    ASSERT_EQ(again.changes.size(), 2u);
    for (std::size_t i = 0; i < 2; ++i) {
        const auto first = sim::parametersOf(scene.changes[i].settings, scene.changes[i].materials),
                   second = sim::parametersOf(again.changes[i].settings, again.changes[i].materials);
        ASSERT_EQ(first.size(), second.size());
        for (std::size_t p = 0; p < first.size(); ++p) EXPECT_EQ(first[p].value, second[p].value) << first[p].path;
    }
    EXPECT_EQ(sim::changeText(3, sim::changedSettings(scene, 1)), "{step: 3, set: {transfer.method.fabric: apic, transfer.damping_dt: step}}");
}

TEST(SceneChanges, AreNotTooMany)
{
    std::string list = "changes:\n";
    for (int i = 1; i <= 10'001; ++i) list += "  - {step: 1, set: {}}\n";
    try {
        sceneWith(list);
        FAIL() << "loaded";
    } catch (const sim::InputError& error) {
        EXPECT_STREQ(error.what(), "scene.yaml:5: changes: 10001 are too many; at most 10000 are possible");
    }
}

TEST(Parameters, EveryValueIsTakenBackAsAnOverride)
{
    const sim::Scene scene = sceneWith("time: {dt: 1.3e-4, mode: adaptive}\ncoupling: {capture: {rate: 0.3}}\n");
    const auto parameters = sim::parametersOf(scene.settings, scene.materials);
    std::vector<std::string> sets;
    for (const sim::Parameter& p : parameters)
        if (!p.value.empty()) sets.push_back(sim::overrideText(p, p.value));
    const std::string si =
        "units: si\nmaterials: {wool: {young: 1}}\nliquid: {sources: [{shape: {ball: {center: [0, 0, 0], radius: 1 "
        "cm}}}]}\n";
    for (const std::string& start : {kScene, si}) {
        const sim::Scene again = sim::readScene(sim::sceneFileFromText(start, "scene.yaml", {.set = sets}));
        const auto found = sim::parametersOf(again.settings, again.materials);
        ASSERT_EQ(found.size(), parameters.size());
        for (std::size_t i = 0; i < found.size(); ++i) EXPECT_EQ(found[i].value, parameters[i].value) << found[i].path;
    }
}

TEST(Parameters, TellUnitRangeWordsAndWhatIsFixed)
{
    const sim::Scene scene = sceneWith("");
    const auto all = sim::parametersOf(scene.settings, scene.materials);
    const auto of = [&](const std::string& path) { return *std::ranges::find(all, path, &sim::Parameter::path); };
    EXPECT_EQ(of("liquid.viscosity").unit, "P");
    EXPECT_EQ(of("liquid.viscosity").value, "0.81");
    EXPECT_FALSE(of("liquid.viscosity").range.contains(-1.0));
    EXPECT_EQ(of("time.mode").words, (std::vector<std::string>{"fixed", "cfl", "adaptive"}));
    EXPECT_TRUE(of("grid.cell").isFixed);
    EXPECT_TRUE(of("materials.wool.density").isFixed);
    EXPECT_FALSE(of("materials.wool.young").isFixed);
    for (const sim::Parameter& p : all) EXPECT_FALSE(p.help.empty()) << p.path;
}

const std::string kStart = R"(grid: {cell: 0.1}
liquid: {sources: [{shape: {ball: {center: [0, 0, 0], radius: 1}}}]}
changes:
)";

class BadChange : public testing::TestWithParam<BadScene> {};

TEST_P(BadChange, IsRefusedAtItsLine)
{
    const std::string text = kStart + GetParam().text;
    BadScene bad = GetParam();
    bad.text = text.c_str();
    expectItsMessage(bad);
}

const BadScene kBadChanges[] = {
    {"NoList", "  step: 3\n", "bad.yaml:3: changes: needs a list like - {step: 100, set: {time.dt: 1.0e-3}}, not a map"},
    {"NoStep", "  - {set: {time.dt: 1}}\n", "bad.yaml:4: changes.0.step is missing; it is the first step with what is set, like step: 100"},
    {"Order", "  - {step: 5, set: {time.dt: 1}}\n  - {step: 4, set: {time.dt: 1}}\n",
     "bad.yaml:5: changes.1.step: 4 comes after step 5; write changes in their order"},
    {"Fixed", "  - {step: 5, set: {grid: {cell: 0.2}}}\n", "bad.yaml:4: changes: grid.cell holds for a whole run; give it its value at the start"},
    {"FixedByPreset", "  - {step: 5, set: {liquid.preset: honey}}\n",
     "bad.yaml:4: changes: liquid.density holds for a whole run; give it its value at the start"},
    {"Sources", "  - {step: 5, set: {liquid: {sources: []}}}\n",
     "bad.yaml:4: changes: liquid.sources cannot change during a run; only settings of time, transfer, liquid, "
     "coupling, "
     "fabric, materials, solver and gravity can"},
    {"Value", "  - {step: 5, set: {time.dt: -1}}\n", "bad.yaml:4: time.dt: \"-1\" is out of range; must be above 0 s"},
    {"Key", "  - {step: 5, set: {time.steps: 3}}\n",
     "bad.yaml:4: changes: time.steps cannot change during a run; only settings of time, transfer, liquid, coupling, "
     "fabric, materials, solver and gravity can"},
};

INSTANTIATE_TEST_SUITE_P(Changes, BadChange, testing::ValuesIn(kBadChanges), [](const auto& bad) { return bad.param.name; });

}  // namespace
