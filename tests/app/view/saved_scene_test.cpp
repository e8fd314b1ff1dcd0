#include "app/view/saved_scene.h"

#include "app/system/atomic_files.h"
#include "tests/app/temporary_folder.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>

namespace app::test {
namespace {

/// A shell takes the command apart into what it was made of, whatever is in it.
TEST(CommandLine, IsTakenApartByAShellAsItWasMade)
{
    const TemporaryFolder folder;
    const SceneRequest request = {.file = "my scenes/o'clock.yaml",
                                  .variant = "polypic_8",
                                  .sets = {"time.dt=0.5 ms", "changes=[{step: 3, set: {gravity: [0, -1, 0]}}]", "scene.title=$HOME \"x\" `y` \\\\"}};
    const std::string line = commandLine(request);
    ASSERT_EQ(line.find("drench run "), 0u);
    const std::string show = "for word in " + line.substr(11) + "; do printf '%s\\n' \"$word\"; done > '" + (folder / "words").string() + "'";
    ASSERT_EQ(std::system(show.c_str()), 0) << show;
    std::string words = request.file + "\n--variant\n" + request.variant + "\n";
    for (const std::string& set : request.sets) words += "--set\n" + set + "\n";
    EXPECT_EQ(readWhole(folder / "words"), words);
}

TEST(FreeName, IsOneThatIsNotThere)
{
    const TemporaryFolder folder;
    const std::filesystem::path before = std::filesystem::current_path();
    std::filesystem::current_path(folder.path());
    EXPECT_EQ(freeName("drop", ".yaml"), "drop.yaml");
    writeWhole("drop.yaml", "");
    writeWhole("drop_2.yaml", "");
    EXPECT_EQ(freeName("drop", ".yaml"), "drop_3.yaml");
    std::filesystem::current_path(before);
}

}  // namespace
}  // namespace app::test
