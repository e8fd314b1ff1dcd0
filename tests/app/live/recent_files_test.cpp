#include "app/live/recent_files.h"

#include "app/system/atomic_files.h"
#include "tests/app/temporary_folder.h"

#include <gtest/gtest.h>

#include <cstdlib>

namespace app::test {
namespace {

/// The user's folder of such things, for as long as it lives.
struct StateFolder {
    TemporaryFolder folder;
    StateFolder() { setenv("XDG_STATE_HOME", (folder / "state").c_str(), 1); }
    ~StateFolder() { unsetenv("XDG_STATE_HOME"); }
};

TEST(RecentFiles, NewestFirstOnceAndNotTooMany)
{
    const StateFolder state;
    RecentFiles().add("/scenes/a.yaml");
    RecentFiles().add("/scenes/b.yaml");
    RecentFiles().add("/scenes/./a.yaml");
    EXPECT_EQ(RecentFiles().files(), (std::vector<std::string>{"/scenes/a.yaml", "/scenes/b.yaml"}));
    RecentFiles many;
    for (int i = 0; i < 30; ++i) many.add("/scenes/" + std::to_string(i) + ".yaml");
    EXPECT_EQ(many.files().size(), RecentFiles::kMost);
    EXPECT_EQ(RecentFiles().files(), many.files());
    EXPECT_EQ(many.files().front(), "/scenes/29.yaml");
}

TEST(RecentFiles, WithoutAFolderTheyLastAsLongAsTheProgram)
{
    const TemporaryFolder folder;
    writeWhole(folder / "file", "no folder");
    setenv("XDG_STATE_HOME", (folder / "file").c_str(), 1);
    RecentFiles recent;
    recent.add("/scenes/a.yaml");
    EXPECT_EQ(recent.files().size(), 1u);
    EXPECT_TRUE(RecentFiles().files().empty());
    unsetenv("XDG_STATE_HOME");
}

}  // namespace
}  // namespace app::test
