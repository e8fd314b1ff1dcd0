#include "tests/app/runs/toy_runs.h"

namespace app {
namespace {

TEST(OutputFolder, RefusesAFile)
{
    TemporaryFolder folder;
    test::writeFile(folder / "file", "text");
    EXPECT_THROW(claimFolder(folder / "file", {"toy", "default"}), sim::InputError);
    EXPECT_THROW(claimFolder(folder.path() / "file" / "below", {"toy", "default"}), sim::InputError);
    EXPECT_EQ(test::contentOf(folder / "file"), "text");
}

TEST(OutputFolder, RefusesAnotherScenesResults)
{
    TemporaryFolder folder;
    runToy({}, folder.path());
    EXPECT_THROW(claimFolder(folder.path(), {"another", "default"}), sim::InputError);
    EXPECT_THROW(claimFolder(folder.path(), {"toy", "apic"}), sim::InputError);
    EXPECT_TRUE(std::filesystem::exists(folder / frameFileName(5)));
    claimFolder(folder.path(), {"toy", "default"});
    EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

TEST(OutputFolder, RefusesAFolderWithFilesThatAreNoResults)
{
    TemporaryFolder folder;
    test::writeFile(folder / "frame_00000.png", "someone's holiday");
    EXPECT_THROW(claimFolder(folder.path(), {"toy", "default"}), sim::InputError);
    EXPECT_TRUE(std::filesystem::exists(folder / "frame_00000.png"));
}

TEST(OutputFiles, AWriteThatFailsLeavesTheOldFile)
{
    TemporaryFolder folder;
    writeWhole(folder / "report.json", "old");
    std::filesystem::create_directory(folder / "report.json.part");
    EXPECT_THROW(writeWhole(folder / "report.json", "new"), std::runtime_error);
    EXPECT_EQ(test::contentOf(folder / "report.json"), "old");
    std::filesystem::remove(folder / "report.json.part");
    writeWhole(folder / "report.json", "new");
    EXPECT_EQ(test::contentOf(folder / "report.json"), "new");
    EXPECT_FALSE(std::filesystem::exists(folder / "report.json.part"));
}

TEST(OutputFiles, AFullDiskIsTold)
{
    LineFile full("/dev/full");
    EXPECT_THROW(full.add("line"), std::runtime_error);
}

}  // namespace
}  // namespace app
