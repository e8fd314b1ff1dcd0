#pragma once

#include "app/system/child_process.h"
#include "tests/app/temporary_folder.h"

#include <nlohmann/json.hpp>

#include <string>
#include <vector>

// A small scene with all that evolves, and runs of it by the program itself.

namespace app::test {

/// Some hundred particles fall onto a small cloth and a yarn, with a frame every few steps.
inline constexpr const char* kSmallScene = R"(drench: 1
scene: {name: small}
time: {dt: 2.0e-3, duration: 0.08, mode: adaptive}
grid: {cell: 0.4}
liquid:
  preset: water
  sources: [{name: ball, shape: {ball: {center: [0, 0.9, 0], radius: 0.7}}, velocity: [0, -60, 0]}]
porous: {fibre_diameter: 0.01, volume_fraction: 0.3}
materials: {wool: {young: 5.0e+5}}
fabrics:
  - {name: sheet, cloth_grid: {material: wool, nodes: [6, 6], spacing: 0.4, center: [0, 0, 0], u: [1, 0, 0], v: [0, 0, 1], radius: 0.02}, pin: {corners: all, patch: 1}}
  - {name: yarn, strand: {material: wool, from: [-1.2, -0.5, 0.1], to: [1.2, -0.5, 0.1], segments: 8, radius: 0.05}, pin: {nodes: [0, 8]}}
render: {size: [64, 48], samples: 1}
output:
  every: 4.0e-3
  data: [energy, stats, ledger, states, checkpoint]
  checkpoint: {every: 8.0e-3, keep: 0}
compare: {variants: {transfer.modes: [4, 8]}}
)";

/// A folder with that scene, where the program runs.
class SmallRuns {
 public:
    SmallRuns() { writeFile(folder / "small.yaml", kSmallScene); }

    ChildExit drench(const std::vector<std::string>& arguments) const { return runChild(DRENCH_PROGRAM, arguments, {.folder = folder.path()}); }
    /// The scene into the folder `out`.
    ChildExit run(const std::string& out, const std::vector<std::string>& more = {}) const
    {
        std::vector<std::string> all = {"run", "small.yaml", "--no-video", "--threads", "1", "--out", out};
        all.insert(all.end(), more.begin(), more.end());
        return drench(all);
    }
    ChildExit resume(const std::string& out, const std::vector<std::string>& more = {}) const
    {
        std::vector<std::string> all = {"run", "--no-video", "--threads", "1", "--resume", out};
        all.insert(all.end(), more.begin(), more.end());
        return drench(all);
    }
    nlohmann::json report(const std::string& out) const { return nlohmann::json::parse(contentOf(folder / out / "report.json")); }
    std::string hash(const std::string& out) const { return report(out).at("state_hash"); }

    /// Pictures and logs of two runs are the same, byte by byte, from this frame on.
    void expectSameFiles(const std::string& a, const std::string& b, int firstFrame = 0) const
    {
        const auto frames = report(a).at("frames").get<int>();
        for (int n = firstFrame; n <= frames; ++n) {
            char name[32];
            std::snprintf(name, sizeof name, "frame_%05d.png", n);
            EXPECT_TRUE(contentOf(folder / a / name) == contentOf(folder / b / name)) << name;
            EXPECT_GT(contentOf(folder / a / name).size(), 100u) << name;
        }
        if (firstFrame > 0) return;
        for (const char* log : {"energy.csv", "energy_ledger.csv"}) EXPECT_EQ(contentOf(folder / a / log), contentOf(folder / b / log)) << log;
        EXPECT_EQ(linesOf(folder / a / "steps.jsonl").size(), linesOf(folder / b / "steps.jsonl").size());
    }

    TemporaryFolder folder;
};

}  // namespace app::test
