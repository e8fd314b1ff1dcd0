// Runs that are stopped and gone on with, by the program itself.
#include "tests/app/checkpoint/small_scene.h"

#include "app/checkpoint/state_files.h"
#include "app/export/geometry_files.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <random>
#include <thread>

namespace app::test {
namespace {

class Resume : public testing::Test, protected SmallRuns {
 protected:
    void expectRefused(const ChildExit& end, const std::string& mentions) const
    {
        EXPECT_EQ(end.code, 2) << end.errorText;
        EXPECT_NE(end.lastWords().find(mentions), std::string::npos) << end.errorText;
    }
    std::filesystem::path checkpointOf(const std::string& run, int frame) const { return stateFile(folder / run, StateKind::ForResuming, frame); }
};

/// run(0 → T) is run(0 → t) and a resumed run to T, whatever is used to step.
class ResumeIsExact : public Resume, public testing::WithParamInterface<std::vector<std::string>> {};

TEST_P(ResumeIsExact, InStatePicturesAndLogs)
{
    std::vector<std::string> sets;
    for (const std::string& set : GetParam()) sets.insert(sets.end(), {"--set", set});
    ASSERT_EQ(run("whole", sets).code, 0);
    std::vector<std::string> half = sets;
    half.insert(half.end(), {"--set", "time.duration=0.045"});  // between two frames
    ASSERT_EQ(run("half", half).code, 0);
    EXPECT_NE(hash("half"), hash("whole"));
    const ChildExit end = resume("half", {"--set", "time.duration=0.08"});
    ASSERT_EQ(end.code, 0) << end.errorText;
    EXPECT_EQ(hash("half"), hash("whole"));
    expectSameFiles("half", "whole");
    for (const char* figure :
         {"steps", "frames", "particles", "rejected_steps", "largest_cfl", "mass_error", "iterations", "energy_ledger", "forces", "content_hash"})
        EXPECT_EQ(report("half").at(figure), report("whole").at(figure)) << figure;
}

INSTANTIATE_TEST_SUITE_P(, ResumeIsExact,
                         testing::Values(std::vector<std::string>{}, std::vector<std::string>{"transfer.modes=27", "time.integrator=plain"},
                                         std::vector<std::string>{"fabric.solver=grid", "time.mode=fixed", "time.dt=5e-4"},
                                         std::vector<std::string>{"transfer.method=flip", "liquid.surface_tension_force=true"},
                                         std::vector<std::string>{
                                             "changes=[{step: 8, set: {gravity: [100, -981, 0]}}, {step: 25, set: {transfer.modes: 27}}]"}));

TEST_F(Resume, GeometryIsThatOfAWholeRun)
{
    const std::vector<std::string> formats = {"--no-frames",
                                              "--set",
                                              "output.data=[energy, geometry, checkpoint]",
                                              "--set",
                                              "output.geometry_format=[vtp, ply, obj, usda]",
                                              "--set",
                                              "output.geometry_surface=true"};
    ASSERT_EQ(run("whole", formats).code, 0);
    std::vector<std::string> half = formats;
    half.insert(half.end(), {"--set", "time.duration=0.041"});
    ASSERT_EQ(run("half", half).code, 0);
    ASSERT_EQ(resume("half", {"--no-frames", "--set", "time.duration=0.08"}).code, 0);
    std::size_t files = 0;
    for (const auto& entry : std::filesystem::directory_iterator(folder / "whole" / "geometry")) {
        const std::string name = entry.path().filename().string();
        if (name == kGeometryProvenance) continue;  // it tells when and how each was made
        EXPECT_TRUE(contentOf(entry.path()) == contentOf(folder / "half" / "geometry" / name)) << name;
        ++files;
    }
    EXPECT_EQ(files, 21u * (2 * 4 + 2) + 4 + 2) << "liquid, its surface, yarns and cloth as .vtp and .ply, all as .obj and .usda; collections";
    ASSERT_EQ(run("stored", {"--no-frames"}).code, 0);
    ASSERT_EQ(drench({"export", "stored", "--to", "vtp,usda", "--set", "output.geometry_surface=true"}).code, 0);
    for (const char* name :
         {"liquid.pvd", "liquid_00020.vtp", "surface_00011.vtp", "cloth_00007.vtp", "yarns_00000.vtp", "frame_00013.usda", "animation.usda"})
        EXPECT_TRUE(contentOf(folder / "stored" / "geometry" / name) == contentOf(folder / "whole" / "geometry" / name))
            << name << " afterwards, from stored states";
}

TEST_F(Resume, GoesOnFromAnyFrameOfWhichThereIsACheckpoint)
{
    ASSERT_EQ(run("whole").code, 0);
    const std::string whole = hash("whole");
    const std::string last = contentOf(folder / "whole" / "frame_00020.png");
    EXPECT_EQ(storedFrames(folder / "whole", StateKind::ForResuming), (std::vector<std::int64_t>{2, 4, 6, 8, 10, 12, 14, 16, 18, 20}));
    for (const char* frame : {"12", "4"}) {
        std::filesystem::remove(folder / "whole" / "frame_00020.png");
        ASSERT_EQ(resume("whole", {"--from-frame", frame}).code, 0);
        EXPECT_EQ(hash("whole"), whole);
        EXPECT_TRUE(contentOf(folder / "whole" / "frame_00020.png") == last);
        EXPECT_EQ(linesOf(folder / "whole" / "steps.jsonl").size(), report("whole").at("steps").get<std::size_t>());
    }
    expectRefused(resume("whole", {"--from-frame", "3"}), "there are those of 2, 4, 6");
}

TEST_F(Resume, KeepsAsManyCheckpointsAsWanted)
{
    ASSERT_EQ(run("run", {"--set", "output.checkpoint.keep=2"}).code, 0);
    EXPECT_EQ(storedFrames(folder / "run", StateKind::ForResuming), (std::vector<std::int64_t>{18, 20}));
    EXPECT_EQ(storedFrames(folder / "run", StateKind::ForPictures).size(), 21u);
    ASSERT_EQ(run("run", {"--set", "output.data=[energy]"}).code, 0);
    EXPECT_FALSE(std::filesystem::exists(folder / "run" / "checkpoints")) << "those of the run before are gone";
    EXPECT_FALSE(std::filesystem::exists(folder / "run" / "states"));
}

/// A branch is a scene of its own: run from the start it comes to the same end.
TEST_F(Resume, ABranchHasOtherSettingsFromThereOn)
{
    ASSERT_EQ(run("whole").code, 0);
    const std::string whole = hash("whole");
    const ChildExit end = resume("whole", {"--from-frame", "8", "--out", "branch", "--set", "gravity=[0, -200, 0]", "--set", "render.size=[32, 24]"});
    ASSERT_EQ(end.code, 0) << end.errorText;
    EXPECT_NE(hash("branch"), whole);
    EXPECT_EQ(hash("whole"), whole) << "the run it comes from is as it was";
    EXPECT_FALSE(std::filesystem::exists(folder / "branch" / "frame_00007.png"));
    EXPECT_TRUE(std::filesystem::exists(folder / "branch" / "frame_00008.png"));
    ASSERT_EQ(drench({"run", "branch/resolved.yaml", "--no-video", "--threads", "1", "--out", "anew"}).code, 0);
    EXPECT_EQ(hash("anew"), hash("branch"));
    expectSameFiles("anew", "branch", 8);
    ASSERT_EQ(resume("branch", {"--from-frame", "12"}).code, 0) << "a branch can be gone on with, too";
    EXPECT_EQ(hash("anew"), hash("branch"));
}

TEST_F(Resume, WhatWouldBeAnotherRunIsRefused)
{
    ASSERT_EQ(run("whole").code, 0);
    const std::string before = contentOf(folder / "whole" / "report.json");
    expectRefused(resume("whole", {"--set", "gravity=[0, -200, 0]"}), "go on elsewhere with --out");
    expectRefused(resume("whole", {"--set", "grid.cell=0.3", "--out", "branch"}), "grid.cell=0.3: this holds for a whole run");
    expectRefused(resume("whole", {"--set", "time.duration=0.02"}), "would end before its checkpoint");
    expectRefused(resume("whole", {"--set", "gravitty=[0, 0, 0]", "--out", "branch"}), "gravitty");
    expectRefused(resume("nowhere"), "no folder of a run");
    expectRefused(drench({"run", "small.yaml", "--resume", "whole"}), "either scene, --resume or --again");
    expectRefused(drench({"run", "small.yaml", "--from-frame", "2"}), "--resume");
    EXPECT_EQ(contentOf(folder / "whole" / "report.json"), before);
    EXPECT_FALSE(std::filesystem::exists(folder / "branch"));
}

TEST_F(Resume, CheckpointsOfOtherScenesAndDamagedOnesAreRefused)
{
    ASSERT_EQ(run("whole").code, 0);
    ASSERT_EQ(run("other", {"--set", "gravity=[0, -200, 0]"}).code, 0);
    const std::string own = contentOf(checkpointOf("whole", 20));
    std::filesystem::copy_file(checkpointOf("other", 20), checkpointOf("whole", 20), std::filesystem::copy_options::overwrite_existing);
    expectRefused(resume("whole"), "not of the scene in its resolved.yaml");
    writeFile(checkpointOf("whole", 20), own.substr(0, own.size() / 2));
    expectRefused(resume("whole"), "cut off");
    ASSERT_EQ(resume("whole", {"--from-frame", "18"}).code, 0) << "as the message says";
    std::filesystem::remove(folder / "whole" / "steps.jsonl");
    expectRefused(resume("whole"), "steps.jsonl");
    std::filesystem::remove_all(folder / "whole" / "checkpoints");
    expectRefused(resume("whole", {"--set", "time.duration=0.1"}), "output.data: [checkpoint]");
}

/// Nothing is left of a run that is done; that is no mistake, whatever it has kept and whatever was drawn.
TEST_F(Resume, AFinishedRunSaysThatItIsDone)
{
    for (const char* data : {"energy", "energy, states", "energy, checkpoint"}) {
        const std::string set = fmt::format("output.data=[{}]", data);
        for (const bool isDrawn : {false, true}) {
            std::vector<std::string> more = {"--set", set, "--set", "time.duration=0.01"};
            if (!isDrawn) more.emplace_back("--no-frames");
            ASSERT_EQ(run("finished", more).code, 0);
            const std::string before = hash("finished");
            for (const std::vector<std::string>& flags : {std::vector<std::string>{}, {"--no-frames"}}) {
                std::vector<std::string> all = {"run", "--threads", "1", "--resume", "finished"};
                all.insert(all.end(), flags.begin(), flags.end());
                const ChildExit end = drench(all);
                EXPECT_EQ(end.code, 0) << set << ": " << end.errorText;
                EXPECT_EQ(report("finished").at("status"), "done");
                EXPECT_EQ(hash("finished"), before);
            }
            std::filesystem::remove_all(folder / "finished");
        }
    }
}

TEST_F(Resume, AFinishedRunWithoutACheckpointIsRefusedWhatIsBehindItsEnd)
{
    ASSERT_EQ(run("finished", {"--no-frames", "--set", "output.data=[energy]", "--set", "time.duration=0.01"}).code, 0);
    for (const std::vector<std::string>& more : {std::vector<std::string>{"--set", "time.duration=0.02"}, {"--from-frame", "2"}, {"--out", "branch"}})
        expectRefused(resume("finished", more), "output.data: [checkpoint]");
}

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
