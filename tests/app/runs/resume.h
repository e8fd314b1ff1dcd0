#pragma once

#include "app/checkpoint/state_files.h"
#include "app/export/geometry_files.h"
#include "tests/app/checkpoint/small_scene.h"

#include <fmt/format.h>
#include <algorithm>
#include <chrono>
#include <random>
#include <thread>

// Runs that are stopped and gone on with, by the program itself.

namespace app::test {

class Resume : public testing::Test, protected SmallRuns {
 protected:
    void expectRefused(const ChildExit& end, const std::string& mentions) const
    {
        EXPECT_EQ(end.code, 2) << end.errorText;
        EXPECT_NE(end.lastWords().find(mentions), std::string::npos) << end.errorText;
    }
    std::filesystem::path checkpointOf(const std::string& run, int frame) const { return stateFile(folder / run, StateKind::ForResuming, frame); }
};

}  // namespace app::test
