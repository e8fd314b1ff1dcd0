#include "app/runs/paper_runs.h"

#include "app/reports/energy_plot.h"
#include "app/reports/run_report.h"
#include "app/system/atomic_files.h"
#include "app/system/gnuplot.h"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <algorithm>

namespace app {

namespace {

/// Of each scene's length, where its row of the overview shows it: the liquid is amid the fabric.
constexpr double kShownAt = 0.8;

const std::string& methodOf(const ComparedRun& run) { return std::ranges::find(kPaperVariants, run.setup.variant, &PaperVariant::name)->method; }

void plot(const std::vector<PaperResult>& results, bool withFabric, const std::string& title, const std::filesystem::path& folder,
          const std::string& name)
{
    std::vector<EnergyCurve> curves;
    for (const PaperResult& result : results) {
        if (result.scene.hasFabric != withFabric) continue;
        for (const ComparedRun& run : result.runs) {
            const auto report = readReport(run.folder);
            curves.push_back({run.setup.variant, fmt::format("{}, {}", result.scene.example, methodOf(run)), run.folder / "energy.csv",
                              report ? report->fabricVertices : 0});
        }
    }
    if (!curves.empty()) plotPerParticle(curves, title, folder, name);
}

OverviewRow overviewRow(const PaperResult& result)
{
    OverviewRow row{{}, result.pictures, 0.0};
    for (const ComparedRun& run : result.runs) row.sequences.push_back(sequenceOf(run));
    row.time = row.sequences.front().start + kShownAt * static_cast<double>(row.sequences.front().last) * row.sequences.front().every;
    return row;
}

}  // namespace

const std::vector<PaperScene>& paperScenes()
{
    static const std::vector<PaperScene> scenes = {
        {"dam_break_small", "dam break (small)", false, {"time.duration=0.3", "output.every=1e-2"}},
        {"splash_cloth_small", "splash cloth (small)", true, {"time.duration=0.25", "time.dt=5e-4"}},
        {"splash_yarn_small", "splash yarn (small)", true, {"time.duration=0.25", "time.dt=5e-4"}},
        {"splash_yarn_medium", "splash yarn (medium)", true, {"time.duration=0.3", "time.dt=5e-4"}},
    };
    return scenes;
}

std::string paperTable(const std::vector<PaperResult>& results)
{
    std::string table =
        "| example | duration s | Δt s | s/step (mean) | total min | peak GB | particles (mean) | fluid (mean) | elements |\n"
        "|---|---:|---:|---:|---:|---:|---:|---:|---:|\n";
    for (const PaperResult& result : results)
        for (const ComparedRun& run : result.runs) {
            const auto r = readReport(run.folder);
            if (!r) continue;
            table += fmt::format("| {}, {} | {:.4g} | {:.2g} | {:.4f} | {:.1f} | {:.3f} | {:.0f} | {:.0f} | {} |\n", result.scene.example,
                                 methodOf(run), r->simulatedTime, run.setup.scene.settings.time.dt, r->meanSecondsPerStep, r->wallSeconds / 60.0,
                                 r->peakMemoryMegabytes / 1000.0, r->meanParticles + static_cast<double>(r->fabricVertices), r->meanParticles,
                                 r->fabricElements);
        }
    return table;
}

void makePaper(const std::vector<PaperResult>& results, const Backends& backends, bool withFrames, const std::filesystem::path& folder)
{
    const std::string table = paperTable(results);
    writeWhole(folder / "table.md", table);
    fmt::print("\n{}\n", table);
    if (canPlot()) {
        plot(results, false, "Dam break", folder, "energy_dam_break");
        plot(results, true, "Water on cloth and yarns", folder, "energy_splash");
    } else {
        spdlog::warn("no gnuplot along PATH, so no energy plots: the numbers are in the runs' energy.csv");
    }
    if (!withFrames) return;
    std::vector<OverviewRow> rows;
    for (const PaperResult& result : results) rows.push_back(overviewRow(result));
    composeOverview(rows, backends, folder / "sheet.png");
}

}  // namespace app
