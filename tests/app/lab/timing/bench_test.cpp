#include "tests/app/program.h"

namespace app {
namespace {

using test::Program;

TEST_F(Program, BenchWritesACsvWithAHash)
{
    const ChildExit end = run({"bench", "--scene", "toy.yaml", "--threads", "1,2", "--repeats", "2", "--steps", "3", "--csv", "--machine", "m"});
    EXPECT_TRUE(end.ok()) << end.errorText;
    const auto lines = test::linesOf(folder.path() / "tests/bench/results/m/toy.csv");
    ASSERT_EQ(lines.size(), 5u) << "header and, for each number of threads, the one stage that ran and the whole step";
    // Steps 3, 4 and 5 after two warm-up ones take 3, 4 and 5 ms.
    EXPECT_TRUE(lines[1].starts_with("toy,1,pressure,4.0000,4.0000,3,2,1,4.00,")) << lines[1];
    EXPECT_TRUE(lines[4].starts_with("toy,2,step,")) << lines[4];
}

}  // namespace
}  // namespace app
