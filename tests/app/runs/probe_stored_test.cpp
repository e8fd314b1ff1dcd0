// Numbers that are read from the states of a run, by the program itself.

#include "tests/app/probes/probed_runs.h"

#include <algorithm>
#include <cmath>

namespace app::test {
namespace {

using StoredProbes = ProbedRuns;

/// What states hold is read from them as it was when the run was there.
TEST_F(StoredProbes, HaveTheSameReadingsAfterwards)
{
    ASSERT_EQ(run("run", {"--no-frames", "--set", probes(kProbesOfAll)}).code, 0);
    writeFile(folder / "probes.yaml", kProbesOfAll);
    for (const std::vector<std::string>& arguments : {std::vector<std::string>{"probe", "run"}, {"probe", "run", "probes.yaml"}}) {
        std::filesystem::remove_all(folder / "run" / "probes");
        const ChildExit end = drench(arguments);
        ASSERT_EQ(end.code, 0) << end.errorText;
        const auto then = table("run/probes.csv"), now = table("run/probes/probes.csv");
        ASSERT_EQ(now.size(), then.size());
        for (const auto& [name, values] : now)
            for (std::size_t i = 0; i < values.size(); ++i) {
                const std::vector<double>& times = then.at("time_s");
                const auto row = std::ranges::find_if(times, [&](double t) { return std::abs(t - now.at("time_s")[i]) < 1e-9; });
                if (row == times.end()) continue;  // a frame between two steps of one reflection
                const double was = then.at(name)[static_cast<std::size_t>(row - times.begin())];
                EXPECT_TRUE(values[i] == was || (std::isnan(values[i]) && std::isnan(was)))
                    << name << " at " << *row << ": " << values[i] << ", " << was;
            }
    }
}

/// Of the scene's own probes those are left out that states do not tell of, in one line that says why. Names of things are no readings.
TEST_F(StoredProbes, AfterwardsAreWithoutThoseThatStatesDoNotTellOf)
{
    const std::string mixed = R"yaml({let: {front_scale: 2}, control_surfaces: {pressure_on: {center: [0, 0.5, 0], normal: [0, -1, 0], radius: 1}},
        readings: [{name: force, read: "2*force_y(\"sheet\")"}, {name: height, read: liquid_y/front_scale}, {name: all, read: energy},
                   {name: through, read: flux("pressure_on")}, {name: front, read: front_x(0.8)}, {name: disc, read: pressure_on("pressure_on")}]})yaml";
    ASSERT_EQ(run("run", {"--no-frames", "--set", probes(mixed)}).code, 0);
    const ChildExit end = drench({"probe", "run"});
    ASSERT_EQ(end.code, 0) << end.errorText;
    EXPECT_EQ(std::ranges::count(end.errorText, '\n'), 1) << end.errorText;
    EXPECT_NE(
        end.errorText.find("left out force (forces), all (energies), front (fronts), disc (pressures on discs): stored states do not tell of that"),
        std::string::npos)
        << end.errorText;
    const auto read = table("run/probes/probes.csv");
    EXPECT_EQ(read.size(), 1u + 2);
    EXPECT_GT(read.at("height [-]").at(1), 0.0);
    EXPECT_EQ(read.count("through [-]"), 1u);
}

}  // namespace
}  // namespace app::test
