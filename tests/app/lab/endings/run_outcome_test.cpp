#include "app/lab/endings/run_outcome.h"

#include "tests/app/temporary_folder.h"

#include <csignal>

namespace app {
namespace {

/// A run's folder with its log and one picture.
struct LeftBehind {
    test::TemporaryFolder folder;
    LeftBehind()
    {
        log(R"({"step":1,"max_speed":2.0})");
        test::writeFile(folder / "frame_00000.png", "");
    }
    void log(const std::string& line) { test::writeFile(folder / "steps.jsonl", line + '\n'); }
    RunOutcome ending(int code, const std::string& words, bool timedOut = false) const
    {
        return judgeEnd({ChildExit{code, words}, 1.0, timedOut}, folder.path(), 1).ending;
    }
};

const std::string kDiagnosis = "drench: frame 1/2\ndrench: scene drop, step 12, t = 0.0024 s, stage pressure: did not converge\n";

TEST(RunOutcome, ADiagnosisNamesSceneStepAndStage)
{
    const LeftBehind run;
    EXPECT_EQ(run.ending(1, kDiagnosis), RunOutcome::Stopped);
    EXPECT_EQ(run.ending(1, "drench: scene drop: something is wrong\n"), RunOutcome::Undiagnosed);
    EXPECT_EQ(run.ending(1, ""), RunOutcome::Undiagnosed);
    EXPECT_EQ(run.ending(1, "drench: out of memory\n"), RunOutcome::Undiagnosed);
}

TEST(RunOutcome, ASignalIsACrashWhateverWasSaidBefore)
{
    const LeftBehind run;
    EXPECT_EQ(run.ending(128 + SIGSEGV, kDiagnosis), RunOutcome::Crashed);
    EXPECT_EQ(run.ending(128 + SIGKILL, kDiagnosis, true), RunOutcome::TimedOut);
}

TEST(RunOutcome, ToFinishTakesNumbersAndPictures)
{
    LeftBehind run;
    EXPECT_EQ(run.ending(0, ""), RunOutcome::Finished);
    run.log(R"({"step":1,"max_speed":null})");
    EXPECT_EQ(run.ending(0, ""), RunOutcome::NotFinite);
    EXPECT_EQ(run.ending(1, kDiagnosis), RunOutcome::NotFinite);
    run.log("{}");
    std::filesystem::remove(run.folder / "frame_00000.png");
    EXPECT_EQ(run.ending(0, ""), RunOutcome::Undiagnosed);
}

TEST(RunOutcome, OfTheUsersMistakesTheGeneratorIsToBlame)
{
    EXPECT_EQ(LeftBehind().ending(2, "drench: a.yaml:3: unknown key\n"), RunOutcome::Refused);
    EXPECT_TRUE(isFault(RunOutcome::Refused));
    EXPECT_FALSE(isFault(RunOutcome::Stopped));
}

}  // namespace
}  // namespace app
