#include "app/lab/stability/stability_map.h"

#include "app/lab/endings/run_course.h"

#include "sim/core/check.h"
#include "tests/app/temporary_folder.h"

#include <fmt/format.h>

#include <array>

namespace app {
namespace {

constexpr double kDigits = 1.0e-7;  // of a log, relative to energies that are up to 4 times the largest kinetic one

/// The logs of a run at steps of 1e-3 s: 1 g of liquid that starts with 1 erg and has at most 8 erg of kinetic energy.
struct Logs {
    test::TemporaryFolder folder;

    void steps(double dt, double speed)
    {
        test::writeFile(folder / "steps.jsonl", fmt::format("{{\"dt\":{},\"max_speed\":{},\"ledger\":{{\"liquid_mass\":1.0}}}}\n", dt, speed));
    }
    void energy(double total, double suction)
    {
        test::writeFile(
            folder / "energy_ledger.csv",
            fmt::format("time_s,total_erg,kinetic_erg,suction_erg,walls_erg,residual_erg\n0,1,0,0,0,0\n1e-3,{},8,{},-3,0\n", total, suction));
    }
    /// Rows of total energy and of the work of obstacles [erg].
    void courseAtObstacles(std::initializer_list<std::array<double, 2>> rows)
    {
        std::string text = "time_s,total_erg,kinetic_erg,obstacles_erg\n";
        for (const auto& [total, obstacles] : rows) text += fmt::format("0,{},8,{}\n", total, obstacles);
        test::writeFile(folder / "energy_ledger.csv", text);
    }
    StabilityRow judged() const
    {
        return judgeStability({ChildExit{}, 1.0, false}, folder.path(), {.method = "apic", .dt = 1.0e-3, .duration = 0.1, .why = {}});
    }
    std::string word() const { return judged().why.substr(0, judged().why.find(':')); }
};

TEST(StabilityMap, EnergyMayRiseOnlyByWhatIsDoneFromOutside)
{
    Logs logs;
    logs.steps(1.0e-3, 4.0);
    logs.energy(1.05, 0.0);
    EXPECT_TRUE(logs.judged().isStable) << logs.judged().why;
    logs.energy(2.0, 0.0);
    EXPECT_EQ(logs.word(), "energy");
    EXPECT_NEAR(logs.judged().energyGain, 1.0 / 8.0, kDigits);
    logs.energy(2.0, 0.95);
    EXPECT_TRUE(logs.judged().isStable) << logs.judged().why;
}

/// Fabric at rest without weight: all of its motion is round-off.
TEST(StabilityMap, MotionThatIsNoneGainsNothing)
{
    Logs logs;
    logs.steps(1.0e-3, 0.0);
    const auto judge = [&](double cell) {
        test::writeFile(logs.folder / "report.json", fmt::format(R"({{"cell":{},"fabric":{{"mass":1}}}})", cell));
        test::writeFile(logs.folder / "energy_ledger.csv", "time_s,total_erg,kinetic_erg\n0,1e-27,0\n1e-3,5e-27,1e-33\n");
        return logs.judged().isStable;
    };
    EXPECT_TRUE(judge(0.1));    // 1e-10 erg would be 1e-7 cells
    EXPECT_FALSE(judge(1e-9));  // 1e-26
}

/// A solid presses on fabric that pins hold: all of its work is stored, and booked to the last digit.
TEST(StabilityMap, DigitsOfTheLogAreNoGain)
{
    Logs logs;
    logs.steps(1.0e-3, 0.0);
    const auto judge = [&](const char* stored) {
        test::writeFile(logs.folder / "report.json", R"({"cell":0.1,"fabric":{"mass":1}})");
        test::writeFile(logs.folder / "energy_ledger.csv",
                        fmt::format("time_s,total_erg,kinetic_erg,obstacles_erg\n0,0,0,0\n1e-3,{},1e-28,0.0611353787\n", stored));
        return logs.judged().isStable;
    };
    EXPECT_TRUE(judge("0.0611353788973"));
    EXPECT_FALSE(judge("0.0611373787"));
    test::writeFile(logs.folder / "energy_ledger.csv", "time_s,total_erg,kinetic_erg,implicit_erg,residual_erg\n0,1,0,0,0\n1e-3,2,8,-1e13,1e13\n");
    EXPECT_FALSE(logs.judged().isStable) << "digits of what is not summed do not count";
}

/// Nor is what solves to their tolerance leave in stiff cloth that nothing moves (a random scene of .0233 g).
TEST(StabilityMap, WhatSolvesLeaveInClothAtRestIsNoGain)
{
    Logs logs;
    logs.steps(1.0e-3, 0.0);
    test::writeFile(logs.folder / "report.json", R"({"cell":0.2218,"fabric":{"mass":0.0233}})");
    const auto judge = [&](double stored) {
        test::writeFile(logs.folder / "steps.jsonl", "{\"dt\":0.1055,\"max_speed\":0.0,\"ledger\":{\"liquid_mass\":0.0}}\n");
        test::writeFile(logs.folder / "energy_ledger.csv", fmt::format("time_s,total_erg,kinetic_erg\n0,4e-25,0\n0.1055,{},8e-24\n", stored));
        return logs.judged().isStable;
    };
    EXPECT_TRUE(judge(1.2e-19));
    EXPECT_FALSE(judge(1.2e-16));
}

/// What rests is held anew in each step: 2 g under 1e3 cm/s^2 would get 1 erg in a step of 1e-3 s.
TEST(StabilityMap, WhatRestsMayGainAHundredthOfWhatWeightGivesInAStep)
{
    Logs logs;
    logs.steps(1.0e-3, 0.0);
    test::writeFile(logs.folder / "report.json", R"({"cell":0.1,"fabric":{"mass":1}})");
    test::writeFile(logs.folder / "resolved.yaml",
                    "drench: 1\nscene: {name: rest}\ntime: {duration: 0.1}\ngrid: {cell: 0.1}\ngravity: [0, -1000, 0]\n"
                    "liquid: {sources: [{shape: {ball: {center: [0, 0, 0], radius: 1}}}]}\n");
    const auto judge = [&](double total) {
        test::writeFile(logs.folder / "energy_ledger.csv", fmt::format("time_s,total_erg,kinetic_erg\n0,1,0\n1e-3,{},1e-9\n", total));
        return logs.judged().isStable;
    };
    EXPECT_TRUE(judge(1.009));
    EXPECT_FALSE(judge(1.011));
}

TEST(StabilityMap, WhatObstaclesTookIsGone)
{
    Logs logs;
    logs.steps(1.0e-3, 4.0);
    logs.courseAtObstacles({{10.0, 0.0}, {9.9, -30.0}, {9.9, -30.0}});
    EXPECT_NEAR(logs.judged().energyGain, 0.0, kDigits) << "booked with more than was lost";
    logs.courseAtObstacles({{10.0, 0.0}, {6.0, -4.0}, {8.0, -4.0}});
    EXPECT_NEAR(logs.judged().energyGain, 2.0 / 8.0, kDigits) << "what they took does not come back";
    logs.courseAtObstacles({{10.0, 0.0}, {13.0, 3.0}, {12.0, 2.0}});
    EXPECT_NEAR(logs.judged().energyGain, 0.0, kDigits) << "moving ones give";
    logs.courseAtObstacles({{10.0, 0.0}, {12.0, -1.0}});
    EXPECT_NEAR(logs.judged().energyGain, 2.0 / 8.0, kDigits) << "a rise is one whatever is booked";
}

TEST(StabilityMap, NoParticleMayBeMuchFasterThanTheEnergyAllows)
{
    Logs logs;
    logs.energy(1.0, 0.0);
    logs.steps(1.0e-3, 0.99 * kAllowedSpeed * 4.0);
    EXPECT_TRUE(logs.judged().isStable) << logs.judged().why;
    logs.steps(1.0e-3, 1.01 * kAllowedSpeed * 4.0);
    EXPECT_EQ(logs.word(), "speed");
}

/// A jet into a pool that hardly moves: most of the liquid has no part in its speed.
TEST(StabilityMap, WhatSourcesGiveMayBeAsFastAsTheyGiveIt)
{
    Logs logs;
    logs.energy(1.0, 0.0);
    for (const double speed : {3.0, 50.0}) {
        logs.steps(1.0e-3, 1.01 * kAllowedSpeed * 4.0);
        test::writeFile(
            logs.folder / "resolved.yaml",
            fmt::format(
                "drench: 1\nscene: {{name: jet}}\ntime: {{dt: 1.0e-3, duration: 0.1}}\ngrid: {{cell: 0.5}}\nliquid:\n  sources:\n    - {{name: "
                "jet, shape: {{box: {{min: [0, 0, 0], max: [1, 1, 1]}}}}, emit: [{{to: 0.1, velocity: [0, {}, 0]}}]}}\n",
                speed));
        EXPECT_EQ(logs.word(), speed > 4.0 ? "" : "speed") << logs.judged().why;
    }
}

TEST(StabilityMap, StepsMustBeAsLongAsTheyWereToBe)
{
    Logs logs;
    logs.energy(1.0, 0.0);
    logs.steps(0.5e-3, 1.0);
    EXPECT_EQ(logs.word(), "cut");
    logs.steps(0.98e-3, 1.0);  // as an even number of them before the next frame
    EXPECT_TRUE(logs.judged().isStable) << logs.judged().why;
}

TEST(StabilityMap, TheLargestStableStepHasNoUnstableOneBelow)
{
    const auto row = [](double dt, bool isStable) {
        return StabilityRow{.method = "apic", .dt = dt, .duration = 0.1, .isStable = isStable, .why = {}};
    };
    EXPECT_EQ(largestStableStep({row(1, true), row(2, true), row(4, false)}, "apic", 0.1), 2.0);
    EXPECT_EQ(largestStableStep({row(1, true), row(2, false), row(4, true)}, "apic", 0.1), 1.0);
    EXPECT_EQ(largestStableStep({row(1, false), row(2, true)}, "apic", 0.1), 0.0);
    EXPECT_EQ(largestStableStep({row(1, true)}, "apic", 0.2), 0.0);
}

TEST(StabilityMap, TablesReadBack)
{
    const test::TemporaryFolder folder;
    const std::vector<StabilityRow> rows = {{"apic vertex", 2.0e-4, 0.32, true, "", 0.01, 12.5, 3.5},
                                            {"polypic_27 grid", 4.0e-3, 0.32, false, "energy: gained 7", 7.0, 1.0e5, 0.5}};
    test::writeFile(folder / "map.csv", stabilityTable(rows));
    EXPECT_EQ(stabilityTable(readStabilityTable(folder / "map.csv")), stabilityTable(rows));
    EXPECT_TRUE(readStabilityTable(folder / "nothing.csv").empty());
}

TEST(StabilityMap, MethodsGoWithBothFabricSolversWhereThereIsFabric)
{
    LoadedScene setup;
    EXPECT_EQ(stabilityMethods(setup, {}).size(), 6u);
    setup.scene.fabrics.emplace_back();
    EXPECT_EQ(stabilityMethods(setup, {}).size(), 12u);
    const auto two = stabilityMethods(setup, {"polypic_27"});
    ASSERT_EQ(two.size(), 2u);
    EXPECT_EQ(withParameter(two, setup, "density", {0.1, 10.0}).back().sets.back(), "liquid.density=10");
    EXPECT_THROW(stabilityMethods(setup, {"flip_9"}), sim::InputError);
    EXPECT_THROW(withParameter(two, setup, "colour", {1.0}), sim::InputError);
}

}  // namespace
}  // namespace app
