#include "app/system/child_process.h"

#include <gtest/gtest.h>

namespace app {
namespace {

TEST(ChildProcess, ArgumentsAreNotReadByAShell)
{
    const auto echo = findProgram("sh");
    ASSERT_TRUE(echo);
    const ChildExit end = runChild(*echo, {"-c", "printf '%s' \"$0\" >&2; exit 3", "a b; $(touch nothing) *"});
    EXPECT_EQ(end.code, 3);
    EXPECT_EQ(end.errorText, "a b; $(touch nothing) *");
}

TEST(ChildProcess, LastWordsAreTheLastLineThatSaysSomething)
{
    EXPECT_EQ((ChildExit{1, "first\nsecond \n\n"}).lastWords(), "second");
    EXPECT_EQ((ChildExit{1, "alone"}).lastWords(), "alone");
    EXPECT_EQ((ChildExit{7, " \n"}).lastWords(), "exit code 7, no message");
}

}  // namespace
}  // namespace app
