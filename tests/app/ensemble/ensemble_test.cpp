// Ensembles, by the program itself.
#include "app/ensemble/difference.h"
#include "app/system/csv.h"
#include "sim/core/random.h"
#include "tests/app/checkpoint/small_scene.h"

#include <algorithm>
#include <numeric>

#include <unistd.h>

namespace app::test {
namespace {

/// A block of honey sinks down: a thousand particles, thirty steps.
constexpr const char* kHoney = R"(drench: 1
scene: {name: honey}
time: {dt: 5.0e-3, duration: 0.1}
grid: {cell: 0.5}
liquid:
  preset: honey
  viscosity: 50
  solve_viscosity: true
  sources: [{name: block, shape: {box: {min: [-1, 0, -1], max: [1, 2, 1]}}}]
obstacles: [{name: floor, shape: {box: {min: [-3, 0, -3], max: [3, 4, 3]}}, inside: true}]
output:
  every: 2.0e-2
  frames: none
  probes: {readings: [{name: height, unit: cm, read: liquid_y}]}
compare: {variants: {transfer.method: [apic, polypic]}}
)";

class Ensembles : public testing::Test, protected SmallRuns {
 protected:
    Ensembles() { writeFile(folder / "honey.yaml", kHoney); }

    ChildExit ensemble(const std::string& out, std::vector<std::string> more = {}) const
    {
        more.insert(more.begin(), {"ensemble", "honey.yaml", "--threads", "1", "--jobs", "2", "--out", out});
        return drench(more);
    }
    /// What the program prints.
    std::string told(const std::vector<std::string>& arguments) const
    {
        std::string script = "\"$0\"";
        for (const std::string& argument : arguments) script += " '" + argument + '\'';
        const ChildExit end = runChild(*findProgram("sh"), {"-c", script + " > told", DRENCH_PROGRAM}, {.folder = folder.path()});
        EXPECT_EQ(end.code, 0) << end.errorText;
        return contentOf(folder / "told");
    }
    std::vector<EnsembleColumn> columns(const std::string& out) const { return columnsOf(readEnsemble(folder / out)); }
    std::string hashOf(const std::string& out, const std::string& run) const { return hash(out + "/runs/" + run); }
    void expectRefused(const std::vector<std::string>& arguments, const std::string& says) const
    {
        const ChildExit end = drench(arguments);
        EXPECT_EQ(end.code, 2) << says;
        EXPECT_EQ(std::ranges::count(end.errorText, '\n'), 1) << end.errorText;
        EXPECT_NE(end.errorText.find(says), std::string::npos) << end.errorText;
    }
};

/// Some of the runs.
std::vector<EnsembleColumn> only(std::vector<EnsembleColumn> columns, const std::vector<std::size_t>& runs)
{
    for (EnsembleColumn& column : columns) {
        std::vector<double> values;
        for (const std::size_t run : runs) values.push_back(column.values[run]);
        column.values = std::move(values);
    }
    return columns;
}

/// Numbers below `count` in an order of chance.
std::vector<std::size_t> shuffled(std::size_t count, std::uint64_t number)
{
    const sim::CounterRandom random(number, 1);
    std::vector<std::size_t> order(count);
    std::iota(order.begin(), order.end(), 0);
    std::ranges::sort(order, {}, [&](std::size_t run) { return random.bits(run); });
    return order;
}

std::vector<std::size_t> part(const std::vector<std::size_t>& order, std::size_t begin, std::size_t count)
{
    return {order.begin() + static_cast<std::ptrdiff_t>(begin), order.begin() + static_cast<std::ptrdiff_t>(begin + count)};
}

/// 100 times two ensembles are drawn of runs that differ by chance alone, and two of which one has liquid that is five percent more viscous.
TEST_F(Ensembles, AFalseAlarmIsRareAndFivePercentOfViscosityAreFound)
{
    ASSERT_EQ(ensemble("a", {"-n", "40"}).code, 0);
    ASSERT_EQ(ensemble("b", {"-n", "20", "--first", "100", "--set", "liquid.viscosity=52.5"}).code, 0);
    const std::vector<EnsembleColumn> a = columns("a"), b = columns("b");
    for (const std::size_t runs : {5, 20}) {
        int falseAlarms = 0, found = 0;
        for (std::uint64_t n = 0; n < 100; ++n) {
            const std::vector<std::size_t> order = shuffled(40, n);
            const std::vector<EnsembleColumn> one = only(a, part(order, 0, runs));
            falseAlarms += differenceOf(one, only(a, part(order, runs, runs)), 0.99).seen() > 0 ? 1 : 0;
            found += differenceOf(one, only(b, part(shuffled(20, n), 0, runs)), 0.99).seen() > 0 ? 1 : 0;
        }
        EXPECT_LE(falseAlarms, 1) << runs << " runs";
        EXPECT_GE(found, 95) << runs << " runs";
    }
}

TEST_F(Ensembles, CompareTellsWhetherADifferenceIsSeen)
{
    ASSERT_EQ(ensemble("a", {"-n", "6"}).code, 0);
    ASSERT_EQ(ensemble("same", {"-n", "6", "--first", "50"}).code, 0);
    ASSERT_EQ(ensemble("thick", {"-n", "6", "--set", "liquid.viscosity=60"}).code, 0);
    const std::string same = told({"compare", "--from", "a", "--from", "same", "--out", "both"});
    EXPECT_NE(same.find("No difference seen between a and same in "), std::string::npos) << same;
    const std::string other = told({"compare", "--from", "a", "--from", "thick", "--out", "both"});
    EXPECT_NE(other.find("thick differs from a in "), std::string::npos) << other;
    EXPECT_NE(other.find("of 6 pairs of runs"), std::string::npos) << "they start from the same positions: " << other;
    EXPECT_NE(same.find("of 6 and 6 runs"), std::string::npos) << same;
    EXPECT_EQ(contentOf(folder / "both" / "compare.md") + "\nboth/compare.csv\n", other);
    for (const char* plot : {"energy.png", "probes.png"}) {
        EXPECT_GT(contentOf(folder / "both" / plot).size(), 5000u) << plot;
        EXPECT_GT(contentOf(folder / "a" / plot).size(), 5000u) << plot;
    }
    const std::string script = contentOf(folder / "both" / "energy.gp");
    EXPECT_NE(script.find("energy_bands_1.csv"), std::string::npos);
    EXPECT_NE(script.find("energy_bands_2.csv"), std::string::npos);
    EXPECT_NE(script.find("± one standard deviation"), std::string::npos) << "a plot says what its bands are";
    EXPECT_NE(contentOf(folder / "a" / "probes_bands.csv").find("height [cm] mean,height [cm] deviation"), std::string::npos);
    const std::string table = contentOf(folder / "a" / "ensemble.md");
    EXPECT_NE(table.find("| height [cm], at the end |"), std::string::npos);
    EXPECT_NE(table.find("/mean_force[1] [dyn] |"), std::string::npos) << table;
    EXPECT_NE(other.find("| thick: mean ± deviation |"), std::string::npos) << other;
}

TEST_F(Ensembles, ARunIsOneLikeAnyOtherAndMoreRunsAreAddedToThoseThatAreThere)
{
    ASSERT_EQ(ensemble("a", {"-n", "2", "--variant", "apic"}).code, 0);
    ASSERT_EQ(
        drench({"run", "honey.yaml", "--variant", "apic", "--out", "alone", "--set", "liquid.sources.block.fill={pattern: jittered, seed: 2}"}).code,
        0);
    EXPECT_EQ(hashOf("a", "001"), hash("alone"));
    EXPECT_NE(hashOf("a", "000"), hash("alone"));
    const std::string report = contentOf(folder / "a/runs/001/report.json");
    ASSERT_EQ(ensemble("a", {"-n", "3", "--variant", "apic"}).code, 0);
    EXPECT_EQ(contentOf(folder / "a/runs/001/report.json"), report) << "done already";
    EXPECT_EQ(readEnsemble(folder / "a").runs.size(), 3u);
    // The file is a study of the same runs.
    ASSERT_EQ(drench({"sweep", "a/ensemble.yaml", "--out", "a"}).code, 0);
    EXPECT_EQ(contentOf(folder / "a/runs/001/report.json"), report) << "done already";
    EXPECT_EQ(linesOf(folder / "a/study.csv").size(), 4u);
}

TEST_F(Ensembles, AKeyIsDrawnAndItsRunsAreTabled)
{
    ASSERT_EQ(ensemble("a", {"-n", "3", "--vary", "liquid.viscosity=10..100", "--vary", "positions"}).code, 0);
    ASSERT_EQ(drench({"sweep", "a/ensemble.yaml", "--out", "a"}).code, 0);
    const auto lines = linesOf(folder / "a/study.csv");
    ASSERT_EQ(lines.size(), 4u);
    EXPECT_EQ(csvCells(lines[0]).at(1), "liquid.viscosity");
    for (std::size_t n = 1; n < lines.size(); ++n) {
        const double drawn = std::stod(csvCells(lines[n]).at(1));
        EXPECT_TRUE(drawn >= 10.0 && drawn <= 100.0) << drawn;
    }
    EXPECT_TRUE(std::filesystem::exists(folder / "a/energy_end_erg_over_liquid.viscosity.png"));
    EXPECT_FALSE(std::filesystem::exists(folder / "a/energy_end_erg_over_liquid.sources.0.fill.seed.png"));
}

TEST_F(Ensembles, MistakesAreToldAndLeaveNothing)
{
    expectRefused({"ensemble", "honey.yaml", "--vary", "seed"}, "have no seed; --vary positions moves them");
    expectRefused({"ensemble", "honey.yaml", "--vary", "seeds"}, "--vary seeds: give seed, positions, or a key");
    expectRefused({"ensemble", "honey.yaml", "--vary", "liquid.viscosity=-2..-1"}, "liquid.viscosity");
    expectRefused({"ensemble", "honey.yaml", "--vary", "liquid.viscosty=1..2"}, "viscosty");
    expectRefused({"ensemble", "honey.yaml", "-n", "1"}, "--runs");
    EXPECT_FALSE(std::filesystem::exists(folder / "out"));
    std::filesystem::create_directory(folder / "other");
    std::filesystem::create_directory(folder / "empty");
    writeFile(folder / "empty/ensemble.yaml", "study: none\nruns: [{name: '000'}]\n");
    expectRefused({"compare", "--from", "empty", "--from", "empty", "--out", "both"}, "none of its runs is done");
    ASSERT_EQ(ensemble("a", {"-n", "2"}).code, 0);
    expectRefused({"compare", "--from", "a", "--out", "both"}, "give another ensemble");
    expectRefused({"compare", "--from", "a", "--from", "other", "--out", "both"}, "other: this is no folder of an ensemble");
}

/// Four runs as an array of jobs of a real Slurm: the same results as here.
TEST_F(Ensembles, RunOnSlurm)
{
    if (!findProgram("slurmctld") || !findProgram("slurmd") || !findProgram("munged"))
        GTEST_SKIP() << "there is no Slurm: slurmctld, slurmd and munge are missing";
    if (geteuid() != 0) GTEST_SKIP() << "slurmd runs as root only";
    const ChildExit end =
        runChild(WITH_SLURM,
                 {(folder / "slurm").string(), DRENCH_PROGRAM, "ensemble", "honey.yaml", "-n", "4", "--on", "slurm", "--jobs", "2", "--out", "there"},
                 {.folder = folder.path()});
    ASSERT_EQ(end.code, 0) << end.errorText;
    EXPECT_TRUE(std::filesystem::exists(folder / "there/slurm_3.log")) << "each was a job";
    ASSERT_EQ(ensemble("here", {"-n", "4"}).code, 0);
    for (const char* run : {"000", "001", "002", "003"}) EXPECT_EQ(hashOf("there", run), hashOf("here", run)) << run;
    EXPECT_EQ(linesOf(folder / "there/ensemble.csv").size(), linesOf(folder / "here/ensemble.csv").size());
}

}  // namespace
}  // namespace app::test
