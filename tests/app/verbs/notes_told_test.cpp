// Every verb that reads a scene tells its notes, once each.
#include "app/verbs/verbs.h"
#include "sim/core/check.h"
#include "tests/app/fake_backends.h"
#include "tests/app/log.h"
#include "tests/app/temporary_folder.h"

#include <gtest/gtest.h>

namespace app {
namespace {

constexpr const char* kNote = "toy.yaml:4: obstacle lid is 0.1 cm thick";

Backends partsWithANote()
{
    Backends backends = test::toyBackends({});
    backends.loadScene = [](const SceneRequest&) {
        LoadedScene setup = test::toySetup({});
        setup.scene.notes.emplace_back(kNote);
        return setup;
    };
    return backends;
}

void expectToldOnce(const std::string& words)
{
    const std::size_t first = words.find(kNote);
    ASSERT_NE(first, std::string::npos) << words;
    EXPECT_EQ(words.find(kNote, first + 1), std::string::npos) << words;
}

TEST(NotesTold, ByCheck)
{
    const test::Log log;
    testing::internal::CaptureStdout();
    EXPECT_EQ(runVerbCheck({}, partsWithANote()), 0);
    EXPECT_NE(testing::internal::GetCapturedStdout().find("duration: 0.05"), std::string::npos);
    expectToldOnce(log.words());
}

TEST(NotesTold, ByRun)
{
    const test::TemporaryFolder folder;
    const test::Log log;
    Options options;
    options.out = folder / "out";
    options.video = false;
    testing::internal::CaptureStdout();
    EXPECT_EQ(runVerbRun(options, partsWithANote()), 0);
    testing::internal::GetCapturedStdout();
    expectToldOnce(log.words());
}

/// With or without a display.
TEST(NotesTold, ByView)
{
    const test::Log log;
    Backends backends = partsWithANote();
    backends.view = {};
    EXPECT_THROW(runVerbView({}, backends), sim::RunError);
    expectToldOnce(log.words());
}

}  // namespace
}  // namespace app
