// Runs that were stopped, that failed or were killed, and are gone on with.
#include "tests/app/runs/resume.h"

#include <gtest/gtest.h>

namespace app::test {
namespace {

/// A run that is stopped leaves a checkpoint though its scene asks for none.
TEST_F(Resume, AStoppedRunCanBeGoneOnWith)
{
    const std::vector<std::string> bare = {"--set", "output.data=[energy]"};
    ASSERT_EQ(run("whole", bare).code, 0);
    const std::string script = R"("$0" run small.yaml --no-video --threads 1 --set 'output.data=[energy]' --out stopped &
        while [ ! -e stopped/frame_00002.png ] && kill -0 $!; do sleep 0.005; done; kill -INT $!; wait $!)";
    const ChildExit end = runChild(*findProgram("sh"), {"-c", script, DRENCH_PROGRAM}, {.folder = folder.path()});
    ASSERT_EQ(end.code, 1) << end.errorText;
    EXPECT_NE(end.lastWords().find("go on with drench run --resume stopped"), std::string::npos) << end.errorText;
    ASSERT_EQ(report("stopped").at("status"), "interrupted");
    ASSERT_EQ(resume("stopped").code, 0);
    EXPECT_EQ(hash("stopped"), hash("whole"));
    for (int frame : {0, 2, 10, 20}) {
        const std::string name = "frame_000" + std::string(frame < 10 ? "0" : "") + std::to_string(frame) + ".png";
        EXPECT_TRUE(contentOf(folder / "stopped" / name) == contentOf(folder / "whole" / name)) << name;
    }
    EXPECT_EQ(contentOf(folder / "stopped" / "energy.csv"), contentOf(folder / "whole" / "energy.csv"));
}

/// A comparison that is stopped goes on with the variant that was under way.
TEST_F(Resume, AStoppedComparisonGoesOn)
{
    const std::string script = R"("$0" compare small.yaml --no-video --threads 1 --out both &
        while [ ! -e both/4/frame_00002.png ] && kill -0 $!; do sleep 0.005; done; kill -INT $!; wait $!)";
    const auto compare = [&](const std::string& command) {
        return runChild(*findProgram("sh"), {"-c", command, DRENCH_PROGRAM}, {.folder = folder.path()});
    };
    EXPECT_EQ(compare(script).code, 1);
    ASSERT_EQ(report("both/4").at("status"), "interrupted");
    const auto first = folder / "both" / "4" / "frame_00001.png";
    const auto drawn = std::filesystem::last_write_time(first);
    const ChildExit end = compare(R"("$0" compare small.yaml --no-video --threads 1 --out both)");
    ASSERT_EQ(end.code, 0) << end.errorText;
    EXPECT_EQ(std::filesystem::last_write_time(first), drawn);
    ASSERT_EQ(run("alone", {"--panel", "--set", "transfer.modes=4"}).code, 0);
    EXPECT_EQ(hash("both/4"), hash("alone"));
    EXPECT_EQ(report("both/8").at("status"), "done");
}

/// Where no more than so many bytes of a file can be written the run stops and says so. What was there before stays, and when there is
/// room again the run goes on as if nothing had been.
TEST_F(Resume, AFullDiskIsSurvived)
{
    ASSERT_EQ(run("whole").code, 0);
    ASSERT_EQ(run("run", {"--set", "time.duration=0.04"}).code, 0);
    const std::string script = R"(ulimit -f 100; "$0" run --resume run --no-video --threads 1 --set time.duration=0.08)";
    const ChildExit end = runChild(*findProgram("sh"), {"-c", script, DRENCH_PROGRAM}, {.folder = folder.path()});
    EXPECT_EQ(end.code, 1);
    EXPECT_NE(end.lastWords().find("File too large"), std::string::npos) << end.errorText;
    EXPECT_EQ(storedFrames(folder / "run", StateKind::ForResuming).back(), 10);
    for (const auto& entry : std::filesystem::recursive_directory_iterator(folder / "run"))
        EXPECT_NE(entry.path().extension(), ".part") << entry.path();
    ASSERT_EQ(resume("run", {"--set", "time.duration=0.08"}).code, 0);
    EXPECT_EQ(hash("run"), hash("whole"));
    expectSameFiles("run", "whole");
}

/// A run that fails has kept its last good state, from which it can be tried with other settings.
TEST_F(Resume, AFailedRunCanBeGoneOnWithOtherwise)
{
    // From the tenth step on it falls so fast that its steps would have to be shorter than they may.
    const ChildExit failed = run(
        "failed", {"--set", "output.data=[energy]", "--set", "time.dt_min=1.0e-3", "--set", "changes=[{step: 10, set: {gravity: [0, -5.0e+7, 0]}}]"});
    ASSERT_EQ(failed.code, 1) << failed.errorText;
    EXPECT_NE(failed.errorText.find("go on from the last good state with other settings: drench run --resume failed"), std::string::npos)
        << failed.errorText;
    ASSERT_EQ(report("failed").at("status"), "failed");
    ASSERT_EQ(resume("failed", {"--out", "otherwise", "--set", "gravity=[0, -981, 0]"}).code, 0);
    EXPECT_EQ(report("otherwise").at("status"), "done");
    EXPECT_GE(linesOf(folder / "otherwise" / "energy.csv").size(), 20u);
}

/// Killed at any moment, a run has lost no more than what came after its last checkpoint, and no file under its own
/// name is broken.
TEST_F(Resume, KilledFiftyTimesItComesToTheSameEnd)
{
    ASSERT_EQ(run("whole").code, 0);
    constexpr int kKills = 50, kCadence = 2;
    std::mt19937 random(1);
    int kills = 0, ends = 0;
    while (kills < kKills) {
        const auto there = storedFrames(folder / "run", StateKind::ForResuming);
        std::vector<std::string> arguments = {"run", "--no-video", "--threads", "1"};
        if (there.empty()) arguments.insert(arguments.end(), {"small.yaml", "--out", "run"});
        else arguments.insert(arguments.end(), {"--resume", "run"});
        ChildProcess child(DRENCH_PROGRAM, arguments, {.folder = folder.path()});
        std::this_thread::sleep_for(std::chrono::milliseconds(20 + random() % 300));
        child.kill();
        const ChildExit end = child.wait();
        if (end.ok()) {
            ++ends;
            EXPECT_EQ(hash("run"), hash("whole"));
            expectSameFiles("run", "whole");
            std::filesystem::remove_all(folder / "run");
            continue;
        }
        ASSERT_EQ(end.code, 128 + SIGKILL) << end.errorText;
        ++kills;
        const auto now = storedFrames(folder / "run", StateKind::ForResuming);
        for (const std::int64_t frame : now) ASSERT_NO_THROW(loadCheckpoint(checkpointOf("run", static_cast<int>(frame))));
        if (!there.empty()) {
            ASSERT_FALSE(now.empty());
        }
        if (!there.empty()) {
            EXPECT_GE(now.back(), there.back());
        }
        const auto pictures = storedFrames(folder / "run", StateKind::ForPictures);
        if (pictures.size() > kCadence + 1) {
            ASSERT_FALSE(now.empty());
        }
        if (!now.empty()) {
            EXPECT_LE(pictures.back() - now.back(), kCadence);
        }
        for (int n = 0; !now.empty() && n <= now.back(); ++n) {
            char name[32];
            std::snprintf(name, sizeof name, "frame_%05d.png", n);
            EXPECT_TRUE(contentOf(folder / "run" / name) == contentOf(folder / "whole" / name)) << name;
        }
        if (std::filesystem::exists(folder / "run" / "report.json")) {
            EXPECT_NO_THROW(report("run"));
        }
    }
    if (std::filesystem::exists(folder / "run" / "resolved.yaml") && !storedFrames(folder / "run", StateKind::ForResuming).empty()) {
        ASSERT_EQ(resume("run").code, 0);
        EXPECT_EQ(hash("run"), hash("whole"));
        expectSameFiles("run", "whole");
    } else if (ends == 0) {  // on a slow machine each was killed before it had anything to go on from
        std::filesystem::remove_all(folder / "run");
        ChildProcess child(DRENCH_PROGRAM, {"run", "--no-video", "--threads", "1", "small.yaml", "--out", "run"}, {.folder = folder.path()});
        ASSERT_TRUE(child.wait().ok());
        EXPECT_EQ(hash("run"), hash("whole"));
        expectSameFiles("run", "whole");
    }
}

}  // namespace
}  // namespace app::test
