#pragma once

#include "app/system/child_process.h"
#include "tests/app/temporary_folder.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <algorithm>

// The whole program as a process, around the toy of fake_backends.h: TOY_PROGRAM is its file.

namespace app::test {

/// A folder with the scene toy.yaml, where the program runs.
class Program : public testing::Test {
 protected:
    Program() { writeFile(folder / "toy.yaml", "duration: 0.03\n"); }

    ChildExit run(const std::vector<std::string>& arguments) const { return runChild(TOY_PROGRAM, arguments, {.folder = folder.path()}); }
    /// A shell script in which "$0" is the program.
    ChildExit runScript(const std::string& script) const
    {
        return runChild(*findProgram("sh"), {"-c", script, TOY_PROGRAM}, {.folder = folder.path()});
    }
    nlohmann::json reportOf(const std::string& run) const { return nlohmann::json::parse(contentOf(folder.path() / run / "report.json")); }

    TemporaryFolder folder;
};

inline void expectOneLine(const ChildExit& end, int code, const std::string& mentions)
{
    EXPECT_EQ(end.code, code) << end.errorText;
    EXPECT_EQ(std::ranges::count(end.errorText, '\n'), 1) << end.errorText;
    EXPECT_TRUE(end.errorText.starts_with("drench: ")) << end.errorText;
    EXPECT_NE(end.errorText.find(mentions), std::string::npos) << end.errorText;
}

}  // namespace app::test
