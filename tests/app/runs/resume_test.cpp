// Runs that are stopped and gone on with, by the program itself.
#include "tests/app/runs/resume.h"

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

}  // namespace
}  // namespace app::test
