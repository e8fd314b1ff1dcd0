// drench diff on runs and on files of runs.

#include "app/checkpoint/checkpoint.h"
#include "app/diff/diff.h"
#include "app/diff/series.h"
#include "app/runs/run_offline.h"
#include "sim/core/check.h"
#include "tests/app/fake_backends.h"
#include "tests/app/temporary_folder.h"

#include <algorithm>
#include <cmath>

namespace app::test {
namespace {

bool goOn() { return false; }

class DiffRuns : public testing::Test {
 protected:
    void run(const std::string& name, const ToySettings& toy = {}) const
    {
        runOffline(toySetup(toy), toyBackends(toy), {.out = folder / name, .contentHash = "0123", .threads = 2, .stopWanted = goOn});
    }
    DiffResult diff(const std::string& a, const std::string& b, const std::vector<std::string>& sets = {}) const
    {
        return diffResults({folder / a, folder / b, {}, false}, sets, goOn);
    }
    /// What is said of one thing; "" for nothing.
    static std::string wordsOn(const std::string& what, const DiffResult& result)
    {
        const auto finding = std::ranges::find(result.findings, what, &DiffFinding::what);
        return finding == result.findings.end() ? "not compared" : finding->words;
    }
    void replaceIn(const std::string& file, const std::string& from, const std::string& to) const
    {
        std::string text = contentOf(folder / file);
        ASSERT_NE(text.find(from), std::string::npos) << text;
        writeFile(folder / file, text.replace(text.find(from), from.size(), to));
    }
    TemporaryFolder folder;
};

/// Three particles, and a fabric of two vertices, at 0.5 s.
sim::State smallState(const std::vector<std::uint32_t>& ids = {7, 3, 5})
{
    sim::State state;
    state.time = 0.5;
    for (const std::uint32_t id : ids) state.liquid.add({1.0 * id, 0.0, 0.0}, 0.25, id, {0.0, 1.0, 0.0});
    state.fabric.x = {{0.0, 0.0, 0.0}, {1.0, 0.0, 0.0}};
    state.fabric.v = {{0.0, 0.0, 0.0}, {0.0, 0.0, 0.0}};
    state.fabric.absorbed = {0.0, 0.0};
    return state;
}

TEST_F(DiffRuns, OfOneSceneAreTheSame)
{
    run("a");
    run("b");
    const DiffResult result = diff("a", "b");
    EXPECT_FALSE(result.differs()) << result.verdict();
    EXPECT_EQ(result.pictures.size(), 6u);
    EXPECT_EQ(wordsOn("energy.csv: total_erg", result), "");
    EXPECT_EQ(wordsOn("report.json: wall_seconds", result), "not compared");
}

TEST_F(DiffRuns, TellTheColumnTheSizeAndTheTimeOfWhatDiffers)
{
    run("a");
    run("b");
    std::vector<std::string> lines = linesOf(folder / "b" / "energy.csv");
    const std::string time = lines[4].substr(0, lines[4].find(','));
    const auto second = lines[4].find(',') + 1;
    lines[4].replace(second, lines[4].find(',', second) - second, "1000");
    std::string text;
    for (const std::string& line : lines) text += line + '\n';
    writeFile(folder / "b" / "energy.csv", text);
    const DiffResult result = diff("a", "b");
    EXPECT_TRUE(result.differs());
    const std::string words = wordsOn("energy.csv: kinetic_erg", result);
    EXPECT_NE(words.find("against 1000"), std::string::npos) << words;
    EXPECT_TRUE(words.ends_with("at " + time + " s")) << words;
    EXPECT_NE(result.verdict().find("energy.csv: kinetic_erg"), std::string::npos) << result.verdict();
    EXPECT_EQ(std::ranges::count_if(result.findings, &DiffFinding::differs), 1);
    EXPECT_FALSE(diff("a", "b", {"ignore=[kinetic_erg]"}).differs());
    EXPECT_FALSE(diff("a", "b", {"series=1e6"}).differs());
    EXPECT_TRUE(diff("a", "b", {"ignore=[kinetic]"}).differs()) << "no column is called so";
}

TEST_F(DiffRuns, ThatLackSomethingDiffer)
{
    run("a");
    run("b");
    std::filesystem::remove(folder / "b" / "energy.csv");
    std::filesystem::remove(folder / "b" / "frame_00002.png");
    const DiffResult result = diff("a", "b");
    EXPECT_EQ(wordsOn("energy.csv", result), "only A has it");
    ASSERT_EQ(result.pictures.size(), 6u);
    EXPECT_EQ(result.pictures.front().pair.name, "frame_00002.png");
    EXPECT_EQ(result.pictures.front().problem, "only A has it");
}

TEST_F(DiffRuns, OfAnotherHashDifferThoughNothingElseTellsSo)
{
    run("a");
    run("b");
    const auto report = contentOf(folder / "b" / "report.json");
    const auto hash = report.find("\"state_hash\": \"") + 15;
    replaceIn("b/report.json", report.substr(hash - 15, 31), "\"state_hash\": \"0123456789abcdef");
    const DiffResult result = diff("a", "b");
    EXPECT_TRUE(result.differs());
    EXPECT_NE(wordsOn("state hash", result).find("against 0123456789abcdef; output.data: [states]"), std::string::npos) << result.verdict();
}

TEST_F(DiffRuns, ReadTheirTolerancesInTheSceneOfA)
{
    run("a");
    run("b", {.speed = 1.0 + 1e-7});
    EXPECT_TRUE(diff("a", "b").differs());
    writeFile(folder / "a" / "resolved.yaml", "compare: {tolerance: {series: 1.0e-5, position: 1 mm}}\n");
    const DiffResult result = diff("a", "b");
    EXPECT_EQ(result.tolerance.position, 0.1);
    EXPECT_EQ(std::ranges::count_if(result.findings, [](const DiffFinding& f) { return f.what.starts_with("energy.csv") && f.differs; }), 0)
        << result.verdict();
}

TEST_F(DiffRuns, RowsOfEqualTimesAreComparedAndOthersTold)
{
    writeFile(folder / "a.csv", "time_s,x\n0,1\n1,2\n2,3\n");
    writeFile(folder / "b.csv", "time_s,x\n0,1\n0.5,7\n1,2\n2,3\n3,4\n");
    const DiffResult result = diff("a.csv", "b.csv");
    EXPECT_EQ(wordsOn("a.csv: rows", result), "3 in both, 2 only in B, the first at 0.5 s");
    EXPECT_EQ(wordsOn("a.csv: x", result), "");
    writeFile(folder / "c.csv", "time_s,x\n0,1\n1,two\n");
    EXPECT_THROW(
        {
            try {
                diff("a.csv", "c.csv");
            } catch (const sim::InputError& error) {
                EXPECT_NE(std::string(error.what()).find("c.csv:3: x is \"two\", which is no number"), std::string::npos) << error.what();
                throw;
            }
        },
        sim::InputError);
}

TEST_F(DiffRuns, ComponentsOfAVectorAreMeasuredByTheWholeOfIt)
{
    writeFile(folder / "a.jsonl", "{\"time\": 0, \"force\": [1e-9, 100]}\n");
    writeFile(folder / "b.jsonl", "{\"time\": 0, \"force\": [2e-9, 100]}\n");
    EXPECT_TRUE(diff("a.jsonl", "b.jsonl").differs());
    EXPECT_FALSE(diff("a.jsonl", "b.jsonl", {"series=1e-10"}).differs());
    EXPECT_FALSE(diff("a.jsonl", "b.jsonl", {"ignore=[force]"}).differs());
}

TEST_F(DiffRuns, OneParticleThatIsElsewhereIsFoundByItsId)
{
    saveCheckpoint({}, smallState(), folder / "a.h5");
    sim::State other = smallState({3, 7, 5});
    saveCheckpoint({}, other, folder / "order.h5");
    EXPECT_EQ(wordsOn("positions of particles", diff("a.h5", "order.h5")), "") << "whatever the order";
    other.liquid.x[1][2] = 0.01;
    saveCheckpoint({}, other, folder / "b.h5");
    const DiffResult result = diff("a.h5", "b.h5");
    EXPECT_TRUE(result.differs());
    EXPECT_EQ(wordsOn("positions of particles", result), "0.01 cm apart, particle 5 at 0.5 s");
    EXPECT_EQ(wordsOn("masses of particles", result), "");
    EXPECT_FALSE(diff("a.h5", "b.h5", {"position=0.011"}).differs());
    EXPECT_TRUE(diff("a.h5", "b.h5", {"position=0.009"}).differs());
    EXPECT_TRUE(diff("a.h5", "b.h5", {"velocity=1"}).differs());
}

TEST_F(DiffRuns, ParticlesAndVerticesThatAreNotThereAreTold)
{
    const sim::State state = smallState();
    saveCheckpoint({}, state, folder / "a.h5");
    sim::State other = state;
    other.liquid.resize(2);
    other.fabric.x[1].y() = 0.5;
    saveCheckpoint({}, other, folder / "b.h5");
    const DiffResult result = diff("a.h5", "b.h5", {"position=1"});
    EXPECT_TRUE(result.differs()) << "a particle is missing, whatever the tolerance";
    EXPECT_EQ(wordsOn("particles", result), "1 only in A at 0.5 s, particle 5 is one");
    EXPECT_EQ(wordsOn("positions of vertices", result), "0.5 cm apart, vertex 1 at 0.5 s");
}

/// Steps may be others, and one may end before the other.
TEST_F(DiffRuns, DifferToAnotherByPercentOfTheLargest)
{
    writeFile(folder / "ours.csv", "time_s,total_erg\n0,-400\n0.05,-299\n0.2,98\n0.3,98\n");
    writeFile(folder / "theirs.csv", "time_s,total_erg\n0,-400\n0.1,-200\n0.2,100\n");
    const std::vector<double> percent = percentOfDifference(readSeries(folder / "ours.csv"), readSeries(folder / "theirs.csv"), "total_erg");
    ASSERT_EQ(percent.size(), 4u);
    EXPECT_EQ(percent[0], 0.0);
    EXPECT_NEAR(percent[1], 0.25, 1e-9);
    EXPECT_NEAR(percent[2], -0.5, 1e-9);
    EXPECT_TRUE(std::isnan(percent[3]));
}

}  // namespace
}  // namespace app::test
