#include "app/runs/paper_runs.h"

#include "app/diff/series.h"
#include "app/ensemble/band_plot.h"
#include "app/ensemble/ensemble_products.h"
#include "app/ensemble/vary.h"
#include "app/reports/energy_plot.h"
#include "app/reports/run_report.h"
#include "app/system/atomic_files.h"
#include "app/system/gnuplot.h"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace app {

namespace {

/// Share of each scene's length at which its row of the overview shows it: the liquid is amid the fabric [-].
constexpr double kShownAt = 0.8;

/// Confidence with which all intervals of a scene hold together.
constexpr double kConfidence = 0.99;

/// What the paper tells of its methods: how much energy they keep, what of it goes to the fabric, how much liquid splashes off and leaves, and
/// what they take.
constexpr std::array<std::string_view, 9> kClaims = {"total_erg, at the end", "total_erg, mean",          "kinetic_erg, mean",
                                                     "published_erg, mean",   "fabric_kinetic_erg, mean", "fabric_elastic_erg, mean",
                                                     "particles, mean",       "s_per_step, median",       "peak_memory_mb"};

const std::string& methodOf(const ComparedRun& run) { return std::ranges::find(kPaperVariants, run.setup.variant, &PaperVariant::name)->method; }

std::string nameOf(const PaperScene& scene, const ComparedRun& run) { return fmt::format("{}, {}", scene.example, methodOf(run)); }

EnergyDifference differenceTo(const ComparedRun& first, const ComparedRun& run)
{
    const Series energies = readSeries(run.folder / "energy.csv");
    const std::vector<double> percent = percentOfDifference(energies, readSeries(first.folder / "energy.csv"), "total_erg");
    EnergyDifference difference;
    for (std::size_t row = 0; row < percent.size(); ++row) {
        if (std::isnan(percent[row])) continue;
        difference.times.push_back(energies.times[row]);
        difference.percent.push_back(percent[row]);
    }
    return difference;
}

void plot(const std::vector<PaperResult>& results, bool withFabric, const std::string& title, const std::filesystem::path& folder,
          const std::string& name)
{
    std::vector<EnergyCurve> curves;
    for (const PaperResult& result : results) {
        if (result.scene.hasFabric != withFabric) continue;
        for (const ComparedRun& run : result.runs) {
            const auto report = readReport(run.folder);
            curves.push_back({run.setup.variant, nameOf(result.scene, run), run.folder / "energy.csv", report ? report->fabricVertices : 0});
            if (&run != &result.runs.front()) curves.back().difference = differenceTo(result.runs.front(), run);
        }
    }
    if (!curves.empty()) plotPerParticle(curves, title, folder, name);
}

/// Energies of the scenes with or without fabric as bands of their repeats, into a plot of that name.
void plotBands(const std::vector<PaperResult>& results, bool withFabric, const std::string& title, const std::filesystem::path& folder,
               const std::string& name)
{
    std::vector<BandCurve> curves;
    for (const PaperResult& result : results) {
        if (result.scene.hasFabric != withFabric) continue;
        for (std::size_t n = 0; n < result.ensembles.size(); ++n) {
            const Ensemble& ensemble = result.ensembles[n];
            if (ensemble.logs.empty()) continue;
            // writeDifferences leaves the table there
            curves.push_back({fmt::format("{}, {}", result.scene.example, ensemble.label), bandsOf(ensemble.logs.front()),
                              folder / result.scene.name / fmt::format("energy_bands_{}.csv", n + 1)});
        }
    }
    if (!curves.empty()) drawBands(curves, perParticlePanels(), title, folder, name);
}

/// Reports of a run and of its repeats.
std::vector<RunResult> reportsOf(const PaperResult& result, std::size_t run)
{
    std::vector<EnsembleRun> runs = {{result.runs[run].folder, ""}};
    if (run < result.ensembles.size()) runs = result.ensembles[run].runs;
    std::vector<RunResult> reports;
    for (const EnsembleRun& one : runs)
        if (const auto report = readReport(one.folder)) reports.push_back(*report);
    return reports;
}

/// "12.3", or of repeats "12.3 ± 0.4".
template <class Of>
std::string cellOf(const std::vector<RunResult>& reports, fmt::string_view format, Of&& of)
{
    std::vector<double> numbers;
    for (const RunResult& report : reports) numbers.push_back(of(report));
    const Spread spread = spreadOf(numbers);
    return spread.count > 1 ? textOf(spread) : fmt::vformat(format, fmt::make_format_args(spread.mean));
}

std::string paperRow(const PaperResult& result, std::size_t run, const std::vector<RunResult>& reports)
{
    const RunResult& first = reports.front();
    // The first of many has drawn pictures, which takes time and memory.
    const std::vector<RunResult> timed(reports.begin() + (reports.size() > 2 ? 1 : 0), reports.end());
    return fmt::format("| {} | {:.4g} | {:.2g} | {} | {} | {} | {} | {} | {} |\n", nameOf(result.scene, result.runs[run]), first.simulatedTime,
                       result.runs[run].setup.scene.settings.time.dt,
                       cellOf(timed, "{:.4f}", [](const RunResult& r) { return r.meanSecondsPerStep; }),
                       cellOf(timed, "{:.1f}", [](const RunResult& r) { return r.wallSeconds / 60.0; }),
                       cellOf(timed, "{:.3f}", [](const RunResult& r) { return r.peakMemoryMegabytes / 1000.0; }),
                       cellOf(reports, "{:.0f}", [](const RunResult& r) { return r.meanParticles + static_cast<double>(r.fabricVertices); }),
                       cellOf(reports, "{:.0f}", [](const RunResult& r) { return r.meanParticles; }), first.fabricElements);
}

/// The difference with those rows alone that the paper makes claims about.
EnsembleDifference claimsOf(EnsembleDifference difference)
{
    const auto isNone = [](const ColumnDifference& column) { return std::ranges::find(kClaims, column.name) == kClaims.end(); };
    std::erase_if(difference.judged, isNone);
    std::erase_if(difference.ofMachine, isNone);
    difference.constant.clear();
    return difference;
}

void drawEnergies(const std::vector<PaperResult>& results, const std::filesystem::path& folder)
{
    if (!canPlot()) {
        spdlog::warn("no gnuplot along PATH, so no energy plots: the numbers are in the runs' energy.csv");
        return;
    }
    const bool hasRepeats = std::ranges::all_of(results, [](const PaperResult& result) { return !result.ensembles.empty(); });
    const auto& draw = hasRepeats ? plotBands : plot;
    draw(results, false, "Dam break", folder, "energy_dam_break");
    draw(results, true, "Water on cloth and yarns", folder, "energy_splash");
}

}  // namespace

const std::vector<PaperScene>& paperScenes()
{
    // Costs: seconds per step of `drench paper --quick` on two cores.
    static const std::vector<PaperScene> scenes = {
        {"dam_break_small", "dam break (small)", false, {"time.duration=0.3", "output.every=1e-2"}, 0.03},
        {"splash_cloth_small", "splash cloth (small)", true, {"time.duration=0.25", "time.dt=5e-4"}, 0.2},
        {"splash_yarn_small", "splash yarn (small)", true, {"time.duration=0.25", "time.dt=5e-4"}, 0.6},
        {"splash_yarn_medium", "splash yarn (medium)", true, {"time.duration=0.3", "time.dt=5e-4"}, 1.2},
    };
    return scenes;
}

std::vector<ComparedRun> repeatsOf(const std::vector<ComparedRun>& runs, int repeats, const Backends& backends, const std::filesystem::path& folder)
{
    const std::uint64_t program = programHash();
    std::vector<ComparedRun> all;
    for (const ComparedRun& run : runs)
        for (int n = 1; n < repeats; ++n) {
            SceneRequest request = run.setup.request;
            for (const std::string& set : setsOfRun({readVary("positions")}, run.setup.scene, static_cast<std::uint64_t>(n)))
                request.sets.push_back(set);
            ComparedRun repeat = run;
            repeat.setup = backends.loadScene(request);
            repeat.contentHash = contentHash(repeat.setup, true, program);
            repeat.setup.label = fmt::format("{}, repeat {}", run.setup.label, n + 1);
            repeat.folder = folder / "repeats" / run.setup.variant / fmt::format("{:03}", n);
            all.push_back(std::move(repeat));
        }
    return all;
}

std::vector<Ensemble> ensemblesOf(const std::vector<ComparedRun>& runs, const std::vector<ComparedRun>& repeats)
{
    std::vector<Ensemble> ensembles;
    for (const ComparedRun& run : runs) {
        std::vector<EnsembleRun> all = {{run.folder, "as published"}};
        for (const ComparedRun& repeat : repeats)
            if (repeat.setup.variant == run.setup.variant) all.push_back({repeat.folder, repeat.folder.filename().string()});
        ensembles.push_back(ensembleOf(all, methodOf(run)));
        if (ensembles.back().runs.size() > 2) ensembles.back().timedFrom = 1;  // the first one has drawn pictures
    }
    const bool areAlone = std::ranges::any_of(ensembles, [](const Ensemble& ensemble) { return ensemble.runs.size() < 2; });
    if (areAlone) return {};
    for (std::size_t n = 1; n < ensembles.size(); ++n) addDifferences(ensembles.front(), ensembles[n]);
    return ensembles;
}

std::string paperHead(const std::vector<PaperResult>& results)
{
    std::size_t most = 1, fewest = 1;
    for (const PaperResult& result : results)
        for (const Ensemble& ensemble : result.ensembles) {
            fewest = most == 1 ? ensemble.runs.size() : std::min(fewest, ensemble.runs.size());
            most = std::max(most, ensemble.runs.size());
        }
    const std::string title = "# Scenes of the PolyPIC paper\n\n";
    if (most < 2) return title;
    const std::string runs = fewest == most ? fmt::format("{}", most) : fmt::format("{} to {}", fewest, most);
    return title + fmt::format(
                       "Means ± standard deviations of {} runs each, with particles laid otherwise. Seconds, minutes and memory are of those "
                       "that draw no pictures.\n\n",
                       runs);
}

std::string paperTable(const std::vector<PaperResult>& results)
{
    std::string table =
        "| example | duration s | Δt s | s/step (mean) | total min | peak GB | particles (mean) | fluid (mean) | elements |\n"
        "|---|---:|---:|---:|---:|---:|---:|---:|---:|\n";
    for (const PaperResult& result : results)
        for (std::size_t run = 0; run < result.runs.size(); ++run)
            if (const auto reports = reportsOf(result, run); !reports.empty()) table += paperRow(result, run, reports);
    return table;
}

std::string paperClaims(const std::vector<PaperResult>& results)
{
    std::string text;
    for (const PaperResult& result : results) {
        if (result.ensembles.size() < 2) continue;
        const EnsembleDifference difference = differenceOf(result.ensembles[0], result.ensembles[1], kConfidence);
        text += fmt::format("\n## {}\n\n{}\n\n{}", result.scene.example, sentenceOf(difference), differenceTable(claimsOf(difference)));
    }
    return text;
}

OverviewRow overviewRow(const PaperResult& result)
{
    OverviewRow row{{}, result.pictures, 0.0};
    for (const ComparedRun& run : result.runs) {
        row.sequences.push_back(sequenceOf(run));
        row.sequences.back().label = nameOf(result.scene, run);
    }
    row.time = row.sequences.front().start + kShownAt * static_cast<double>(row.sequences.front().last) * row.sequences.front().every;
    return row;
}

void makePaper(const std::vector<PaperResult>& results, const Backends& backends, bool withFrames, const std::filesystem::path& folder)
{
    for (const PaperResult& result : results)
        if (result.ensembles.size() > 1) writeDifferences(result.ensembles, result.scene.example, kConfidence, folder / result.scene.name);
    const std::string table = paperHead(results) + paperTable(results) + paperClaims(results);
    writeWhole(folder / "table.md", table);
    fmt::print("\n{}\n", table);
    drawEnergies(results, folder);
    if (!withFrames) return;
    std::vector<OverviewRow> rows;
    for (const PaperResult& result : results) rows.push_back(overviewRow(result));
    composeOverview(rows, backends, folder / "sheet.png");
}

}  // namespace app
