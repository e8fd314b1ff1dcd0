// Studies, by the program itself.
#include "tests/app/checkpoint/small_scene.h"

#include "app/system/csv.h"

#include <algorithm>
#include <map>

#include <unistd.h>

namespace app::test {
namespace {

class StudyRuns : public testing::Test, protected SmallRuns {
 protected:
    StudyRuns()
    {
        write(
            "study: pulls\nscene: small.yaml\nset: {time.duration: 0.012, output.frames: none}\n"
            "runs: {gravity: [[0, -981, 0], [0, -500, 0]], transfer.modes: [4, 8]}\n");
    }
    void write(const std::string& study) const { writeFile(folder / "study.yaml", study); }
    ChildExit sweep(std::vector<std::string> more = {}) const
    {
        more.insert(more.begin(), {"sweep", "study.yaml"});
        return drench(more);
    }
    void expectRefused(const std::string& study, const std::string& says) const
    {
        write(study);
        const ChildExit end = sweep();
        EXPECT_EQ(end.code, 2) << study;
        EXPECT_EQ(std::ranges::count(end.errorText, '\n'), 1) << end.errorText;
        EXPECT_NE(end.errorText.find(says), std::string::npos) << end.errorText;
        EXPECT_FALSE(std::filesystem::exists(folder / "out")) << study;
    }
    /// Rows of study.csv: column → cell.
    std::vector<std::map<std::string, std::string>> table(const std::string& study) const
    {
        const auto lines = linesOf(folder / "out" / study / "study.csv");
        const auto columns = csvCells(lines.at(0));
        std::vector<std::map<std::string, std::string>> rows;
        for (std::size_t n = 1; n < lines.size(); ++n) {
            const auto cells = csvCells(lines[n]);
            for (std::size_t c = 0; c < cells.size(); ++c) {
                if (c == 0) rows.emplace_back();
                rows.back()[columns.at(c)] = cells[c];
            }
        }
        return rows;
    }
};

TEST_F(StudyRuns, AProductIsAllCombinations)
{
    const ChildExit end = sweep({"--jobs", "2", "--threads", "1"});
    ASSERT_EQ(end.code, 0) << end.errorText;
    const auto rows = table("pulls");
    ASSERT_EQ(rows.size(), 4u);
    for (const auto& row : rows) {
        EXPECT_EQ(row.at("status"), "done");
        const std::string gravity = row.at("gravity").find("981") != std::string::npos ? "gravity=[0, -981, 0]" : "gravity=[0, -500, 0]";
        ASSERT_EQ(run("alone", {"--no-frames", "--set", "time.duration=0.012", "--set", "output.frames=none", "--set", gravity, "--set",
                                "transfer.modes=" + row.at("transfer.modes")})
                      .code,
                  0);
        EXPECT_EQ(row.at("state_hash"), hash("alone")) << "a run of a study is a run like any other";
        EXPECT_EQ(row.at("steps"), report("alone").at("steps").dump());
        EXPECT_GT(std::stod(row.at("wall_s")), 0.0);
        std::filesystem::remove_all(folder / "alone");
    }
    EXPECT_NE(rows[0].at("state_hash"), rows[1].at("state_hash"));
    EXPECT_GT(contentOf(folder / "out" / "pulls" / "energy_end_erg_over_transfer.modes.png").size(), 1000u);
    EXPECT_NE(contentOf(folder / "out" / "pulls" / "study.md").find("energy_end_erg_over_transfer.modes.png"), std::string::npos);
}

TEST_F(StudyRuns, WhatIsDoneIsNotDoneAgain)
{
    ASSERT_EQ(sweep({"--threads", "1"}).code, 0);
    const auto reportFile = folder / "out" / "pulls" / "runs" / table("pulls")[0].at("run") / "report.json";
    const auto before = std::filesystem::last_write_time(reportFile);
    ASSERT_EQ(sweep({"--threads", "1"}).code, 0);
    EXPECT_EQ(std::filesystem::last_write_time(reportFile), before);
    ASSERT_EQ(sweep({"--threads", "1", "--force"}).code, 0);
    EXPECT_NE(std::filesystem::last_write_time(reportFile), before);
}

/// A listed run that would need shorter steps than it may take: it fails, is tried again, and the others are done.
TEST_F(StudyRuns, AFailedRunIsTriedAgainAndTold)
{
    write(
        "study: list\nscene: small.yaml\nset: {time.duration: 0.012, output.frames: none}\nretries: 2\n"
        "runs: [{name: good, transfer.modes: 4}, {name: bad, time.dt_min: 2.0e-3, liquid.sources.ball.velocity: [0, -1.0e+5, 0]}, {name: "
        "fine, transfer.modes: 8}]\n");
    const std::string script = "\"$0\" sweep study.yaml --threads 1 > told";
    const ChildExit end = runChild(*findProgram("sh"), {"-c", script, DRENCH_PROGRAM}, {.folder = folder.path()});
    EXPECT_EQ(end.code, 1);
    EXPECT_NE(end.lastWords().find("1 of 3 runs did not get to their end"), std::string::npos) << end.errorText;
    const std::string told = contentOf(folder / "told");
    std::size_t attempts = 0;
    for (std::size_t at = 0; (at = told.find("bad: failed", at)) != std::string::npos; ++at) ++attempts;
    EXPECT_EQ(attempts, 3u) << told;
    const auto rows = table("list");
    ASSERT_EQ(rows.size(), 3u);
    EXPECT_EQ(rows[0].at("status"), "done");
    EXPECT_EQ(rows[1].at("status"), "failed");
    EXPECT_NE(rows[1].at("reason").find("time.dt_min"), std::string::npos) << rows[1].at("reason");
    EXPECT_EQ(rows[2].at("status"), "done");
}

/// A study that is stopped goes on where its runs were, from their checkpoints.
TEST_F(StudyRuns, AStoppedStudyGoesOn)
{
    write("study: stopped\nscene: small.yaml\nset: {output.data: [energy, stats]}\nruns: {transfer.modes: [4, 8]}\n");
    const std::string script = R"("$0" sweep study.yaml --threads 1 &
        while [ ! -e out/stopped/runs/4/frame_00002.png ] && kill -0 $!; do sleep 0.005; done; kill -INT $!; wait $!)";
    const ChildExit end = runChild(*findProgram("sh"), {"-c", script, DRENCH_PROGRAM}, {.folder = folder.path()});
    EXPECT_EQ(end.code, 1) << end.errorText;
    auto rows = table("stopped");
    ASSERT_EQ(rows.at(0).at("status"), "interrupted") << end.errorText;
    EXPECT_EQ(rows.at(1).at("status"), "waiting");
    const auto first = folder / "out" / "stopped" / "runs" / "4" / "frame_00001.png";
    const auto drawn = std::filesystem::last_write_time(first);
    ASSERT_EQ(sweep({"--threads", "1", "--no-video"}).code, 0);
    EXPECT_EQ(std::filesystem::last_write_time(first), drawn) << "it was gone on with, not begun again";
    ASSERT_EQ(run("alone", {"--set", "transfer.modes=4", "--set", "output.data=[energy, stats]"}).code, 0);
    EXPECT_EQ(table("stopped").at(0).at("state_hash"), hash("alone"));
    EXPECT_EQ(table("stopped").at(1).at("status"), "done");
}

TEST_F(StudyRuns, MistakesAreToldWithTheirLine)
{
    expectRefused("scene: small.yaml\n", "runs is missing");
    expectRefused("runs: {transfer.modes: [4]}\n", "scene is missing");
    expectRefused("scene: small.yaml\nrunns: {transfer.modes: [4]}\n", "study.yaml:2: unknown key \"runns\" (did you mean \"runs\"?)");
    expectRefused("scene: small.yaml\nruns: 7\n", "study.yaml:2: runs must list variants");
    expectRefused("scene: nowhere.yaml\nruns: {transfer.modes: [4]}\n", "nowhere.yaml");
    expectRefused("scene: small.yaml\nruns: {transfer.modes: [4, 400]}\n", "transfer.modes");
    expectRefused("scene: small.yaml\nruns: {transfer.mods: [4]}\n", "mods");
    expectRefused("study: a b\nscene: small.yaml\nruns: {transfer.modes: [4]}\n", "a_b would do");
    expectRefused("scene: small.yaml\nretries: many\nruns: {transfer.modes: [4]}\n", "study.yaml:2");
    expectRefused("scene: small.yaml\nset: [1]\nruns: {transfer.modes: [4]}\n", "study.yaml:2: set maps");
    expectRefused("- 1\n", "a study is a map");
    expectRefused("scene: [\n", "study.yaml");
    std::filesystem::remove(folder / "study.yaml");
    EXPECT_EQ(sweep().code, 2);
}

TEST_F(StudyRuns, WithoutSlurmItSaysSo)
{
    const ChildExit end =
        runChild(*findProgram("env"), {"PATH=/nowhere", DRENCH_PROGRAM, "sweep", "study.yaml", "--on", "slurm"}, {.folder = folder.path()});
    EXPECT_EQ(end.code, 2);
    EXPECT_NE(end.errorText.find("no sbatch along PATH"), std::string::npos) << end.errorText;
}

/// Twelve runs as an array of jobs of a real Slurm: the same results as here.
TEST_F(StudyRuns, TwelveRunsOnSlurm)
{
    if (!findProgram("slurmctld") || !findProgram("slurmd") || !findProgram("munged"))
        GTEST_SKIP() << "there is no Slurm: slurmctld, slurmd and munge are missing";
    if (geteuid() != 0) GTEST_SKIP() << "slurmd runs as root only";
    write(
        "study: array\nscene: small.yaml\nset: {time.duration: 0.012, output.frames: none}\n"
        "runs: {transfer.modes: [1, 4, 8], time.dt: [1.0e-3, 2.0e-3], gravity: [[0, -981, 0], [0, -500, 0]]}\n");
    const ChildExit end = runChild(WITH_SLURM, {(folder / "slurm").string(), DRENCH_PROGRAM, "sweep", "study.yaml", "--on", "slurm", "--jobs", "2"},
                                   {.folder = folder.path()});
    ASSERT_EQ(end.code, 0) << end.errorText;
    const auto onSlurm = table("array");
    ASSERT_EQ(onSlurm.size(), 12u);
    EXPECT_TRUE(std::filesystem::exists(folder / "out" / "array" / "slurm_11.log")) << "each was a job";
    ASSERT_EQ(sweep({"--jobs", "2", "--threads", "1", "--force"}).code, 0);
    const auto here = table("array");
    for (std::size_t n = 0; n < here.size(); ++n) {
        EXPECT_EQ(onSlurm[n].at("status"), "done");
        EXPECT_EQ(onSlurm[n].at("state_hash"), here[n].at("state_hash"));
    }
}

}  // namespace
}  // namespace app::test
