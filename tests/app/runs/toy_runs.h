#pragma once

#include "app/runs/run_offline.h"

#include "app/reports/output_folder.h"
#include "sim/core/check.h"
#include "tests/app/fake_backends.h"
#include "tests/app/temporary_folder.h"

#include <nlohmann/json.hpp>

// Runs of the toy simulation to their end.

namespace app {

using nlohmann::json;
using test::TemporaryFolder;
using test::ToySettings;

inline RunSummary runToy(
    const ToySettings& toy, const std::filesystem::path& out, std::function<bool()> stopWanted = [] { return false; })
{
    const RunOptions options = {.out = out, .contentHash = "0123", .threads = 2, .stopWanted = std::move(stopWanted)};
    return runOffline(test::toySetup(toy), test::toyBackends(toy), options);
}

inline json reportOf(const std::filesystem::path& out) { return json::parse(test::contentOf(out / "report.json")); }

}  // namespace app
