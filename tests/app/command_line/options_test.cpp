#include "app/options.h"
#include "sim/core/check.h"
#include "tests/app/program.h"

namespace app {
namespace {

using test::expectOneLine, test::Program;

TEST_F(Program, MistakesOnTheCommandLineExitWithTwoAndOneLine)
{
    expectOneLine(run({}), 2, "subcommand");
    expectOneLine(run({"fly", "toy.yaml"}), 2, "fly");
    expectOneLine(run({"run"}), 2, "scene");
    expectOneLine(run({"run", "toy.yaml", "--treads", "2"}), 2, "--treads");
    expectOneLine(run({"run", "toy.yaml", "--threads", "0"}), 2, "--threads");
    expectOneLine(run({"bench", "--scene", "toy.yaml", "--threads", "1,x"}), 2, "--threads");
    expectOneLine(run({"bench"}), 2, "--scene");
    expectOneLine(run({"bench", "precision", "nowhere"}), 2, "nowhere");
    expectOneLine(run({"bench", "precision", "--repeats", "0"}), 2, "--repeats");
    expectOneLine(run({"import", "nowhere.xml"}), 2, "nowhere.xml");
    expectOneLine(run({"import", "toy.yaml", "-o", "scene.yaml"}), 2, "toy.yaml:1: is no XML");
    expectOneLine(run({"import", "toy.xml", "--solver", "fast"}), 2, "--solver");
}

TEST_F(Program, HelpAndVersionAreNoMistakes)
{
    EXPECT_EQ(run({"--help"}).code, 0);
    EXPECT_EQ(run({"--version"}).code, 0);
    EXPECT_EQ(run({"run", "--help"}).errorText, "");
}

Options optionsOf(const std::vector<const char*>& words)
{
    std::vector<const char*> argv = {"drench"};
    argv.insert(argv.end(), words.begin(), words.end());
    return *readOptions(static_cast<int>(argv.size()), argv.data());
}

TEST(Options, SetTakesOneOverrideEachAndKeepsTheirOrder)
{
    const auto options = optionsOf({"run", "--set", "a=1", "--set", "b.c=[1, 2]", "scene.yaml", "--no-frames"});
    EXPECT_EQ(options.scene, "scene.yaml");
    EXPECT_EQ(options.sets, (std::vector<std::string>{"a=1", "b.c=[1, 2]"}));
    EXPECT_FALSE(options.frames);
    EXPECT_TRUE(options.video);
}

TEST(Options, TwoVariantsAreForCompareOnly)
{
    EXPECT_EQ(optionsOf({"compare", "s.yaml", "--variant", "pic", "--variant", "apic"}).variants, (std::vector<std::string>{"pic", "apic"}));
    EXPECT_THROW(optionsOf({"run", "s.yaml", "--variant", "pic", "--variant", "apic"}), sim::InputError);
}

}  // namespace
}  // namespace app
