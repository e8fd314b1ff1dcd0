#include "app/runs/compare.h"

#include "app/diff/series.h"
#include "app/reports/compare_table.h"
#include "app/reports/energy_plot.h"
#include "app/reports/run_report.h"
#include "app/runs/resume.h"
#include "app/system/atomic_files.h"
#include "app/system/child_process.h"
#include "app/system/gnuplot.h"
#include "app/system/progress.h"
#include "app/system/stopwatch.h"
#include "sim/core/check.h"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <chrono>
#include <cstdio>

namespace app {

namespace {

constexpr int kSheetRows = 6;  ///< times in a contact sheet

std::string names(const std::vector<Variant>& variants)
{
    std::vector<std::string> all;
    for (const auto& v : variants) all.push_back(v.name);
    return fmt::format("{}", fmt::join(all, ", "));
}

std::vector<Variant> wantedVariants(const Options& options, const CompareSettings& compare)
{
    if (compare.variants.empty())
        throw sim::InputError(fmt::format("{}: nothing to compare: the scene has no compare.variants (drench run runs it as it is)", options.scene));
    if (options.variants.empty()) return compare.variants;
    std::vector<Variant> wanted;
    for (const auto& name : options.variants) {
        const auto found = std::ranges::find(compare.variants, name, &Variant::name);
        if (found == compare.variants.end())
            throw sim::InputError(fmt::format("--variant {}: {} has no such variant; it has {}", name, options.scene, names(compare.variants)));
        wanted.push_back(*found);
    }
    return wanted;
}

void drawEnergies(const std::vector<ComparedRun>& runs, const std::filesystem::path& folder)
{
    std::vector<EnergyCurve> curves;
    for (const auto& run : runs)
        if (std::filesystem::exists(run.folder / "energy.csv")) curves.push_back({run.setup.variant, run.setup.label, run.folder / "energy.csv"});
    if (curves.empty()) return;  // pictures alone
    joinEnergies(curves, folder / "energy.csv");
    const auto& scene = runs.front().setup.scene;
    if (canPlot()) plotEnergies(curves, scene.title.empty() ? scene.name : scene.title, folder);
    else spdlog::warn("no gnuplot along PATH, so no energy plot: the numbers are in {}", (folder / "energy.csv").string());
}

}  // namespace

std::vector<ComparedRun> comparedRuns(const Options& options, const Backends& backends, const std::filesystem::path& folder)
{
    const LoadedScene asWritten = backends.loadScene({options.scene, "", options.sets});
    logNotes(asWritten);
    const std::uint64_t program = programHash();
    std::vector<ComparedRun> runs;
    for (const auto& variant : wantedVariants(options, asWritten.pictures.compare)) {
        ComparedRun run;
        run.setup = backends.loadScene({options.scene, variant.name, options.sets});
        run.folder = folder / variant.name;
        run.contentHash = contentHash(run.setup, true, program);
        runs.push_back(std::move(run));
    }
    return runs;
}

std::vector<ComparedRun> storedRuns(const std::vector<std::filesystem::path>& folders, const std::vector<std::string>& sets, const Backends& backends)
{
    std::vector<ComparedRun> runs;
    for (const auto& folder : folders) {
        const auto report = readReport(folder);
        if (!report || !std::filesystem::exists(folder / "resolved.yaml"))
            throw sim::InputError(fmt::format("--from {}: this is no folder of a run", folder.string()));
        if (numbersIn(folder, "frame_", ".png").empty())
            throw sim::InputError(fmt::format("--from {}: there are no pictures in it; drench render makes some of stored states", folder.string()));
        ComparedRun run = {
            .setup = backends.loadScene({(folder / "resolved.yaml").string(), "", sets}), .folder = folder, .contentHash = report->contentHash};
        run.setup.variant = report->variant;
        run.setup.label = report->label.empty() ? folder.lexically_normal().filename().string() : report->label;
        runs.push_back(std::move(run));
    }
    return runs;
}

bool isDone(const ComparedRun& run, bool withFrames)
{
    const auto report = readReport(run.folder);
    if (!report || report->status != "done" || report->contentHash != run.contentHash) return false;
    if (!withFrames) return true;
    for (std::int64_t n = 0; n <= frameCount(run.setup); ++n)
        if (!std::filesystem::exists(run.folder / frameFileName(n))) return false;
    return true;
}

std::vector<std::string> runArguments(const ComparedRun& run, const Options& options)
{
    std::vector<std::string> arguments = {"run", "--threads", fmt::format("{}", options.threads), "--panel", "--no-video"};
    if (!options.frames) arguments.push_back("--no-frames");
    if (!options.force && canResume(run.folder, run.contentHash)) {
        arguments.insert(arguments.end(), {"--resume", run.folder.string()});
        return arguments;
    }
    const SceneRequest& request = run.setup.request;
    arguments.insert(arguments.end(), {request.file, "--variant", request.variant, "--out", run.folder.string()});
    for (const auto& set : request.sets) arguments.insert(arguments.end(), {"--set", set});
    return arguments;
}

std::string summarizeRuns(const std::vector<ComparedRun>& runs)
{
    std::vector<RunOutcome> outcomes;
    for (const ComparedRun& run : runs) {
        const auto report = readReport(run.folder);
        const auto csv = run.folder / "energy.csv";
        if (!report || !std::filesystem::exists(csv)) continue;
        const Series energies = readSeries(csv);
        const std::vector<double>& total = energies.values.at("total_erg");
        if (total.size() > 1 && total.front() > 0.0) outcomes.push_back({run.setup.label, total.back() / total.front(), report->wallSeconds});
    }
    return outcomeSentence(std::move(outcomes));
}

FrameSequence sequenceOf(const ComparedRun& run)
{
    const std::vector<std::int64_t> frames = numbersIn(run.folder, "frame_", ".png");
    return {.folder = run.folder,
            .label = run.setup.label,
            .start = run.setup.scene.settings.time.start,
            .every = run.setup.pictures.output.every,
            .first = frames.empty() ? 0 : frames.front(),
            .last = frames.empty() ? frameCount(run.setup) : frames.back()};
}

namespace {

bool isLeftToDo(const ComparedRun& run, const Options& options, bool withFrames) { return options.force || !isDone(run, withFrames); }

}  // namespace

double costOf(std::span<const ComparedRun> runs, const Options& options, bool withFrames)
{
    double cost = 0.0;
    for (const ComparedRun& run : runs) cost += isLeftToDo(run, options, withFrames) ? run.cost : 0.0;
    return cost;
}

std::vector<ComparedRun> runAll(const std::vector<ComparedRun>& runs, const Options& options, bool withFrames, double costAfter,
                                const std::function<bool()>& stopWanted)
{
    const auto begin = std::chrono::steady_clock::now();
    std::vector<ComparedRun> done;
    for (std::size_t n = 0; n < runs.size() && !stopWanted(); ++n) {
        const std::string soFar = n > 0 ? fmt::format(", {} so far", formatDuration(secondsSince(begin))) : "";
        const std::string head = fmt::format("[{}/{}] {}{}", n + 1, runs.size(), runs[n].setup.label, soFar);
        if (!isLeftToDo(runs[n], options, withFrames)) {
            fmt::print("{}: already there, in {}\n", head, runs[n].folder.string());
        } else {
            fmt::print("{}\n", head);
            std::fflush(stdout);
            std::vector<std::string> arguments = runArguments(runs[n], options);
            const double toFollow = costOf(std::span(runs).subspan(n + 1), options, withFrames) + costAfter;
            arguments.insert(arguments.end(), {"--runs-to-follow", fmt::format("{:.6g}", toFollow / runs[n].cost)});
            if (!runChild("/proc/self/exe", arguments, {.folder = {}, .quiet = false}).ok()) continue;
        }
        done.push_back(runs[n]);
    }
    return done;
}

void makeComparisonOutputs(const std::vector<ComparedRun>& runs, const ComparisonOutputs& wanted, const Backends& backends,
                           const std::function<bool()>& stopWanted)
{
    const PictureSettings& pictures = wanted.pictures;
    const std::filesystem::path& folder = wanted.folder;
    if (pictures.compare.table) {
        std::vector<RunResult> results;
        for (const auto& run : runs)
            if (auto result = readReport(run.folder)) {
                result->label = run.setup.label;
                results.push_back(std::move(*result));
            }
        const auto& scene = runs.front().setup.scene;
        const std::string table = compareTable(scene.title.empty() ? scene.name : scene.title, results, pictures.compare.reference);
        writeWhole(folder / "table.md", table);
        fmt::print("\n{}\n", table);
    }
    if (pictures.compare.energyPlot) drawEnergies(runs, folder);
    if (!wanted.withFrames) return;
    std::vector<FrameSequence> sequences;
    for (const auto& run : runs) sequences.push_back(sequenceOf(run));
    if (pictures.compare.sheet) composeSheet(sequences, kSheetRows, pictures, backends, folder);
    if (!wanted.withVideo || !pictures.compare.video) return;
    const auto made = composeSideBySide(sequences, pictures.output.every, pictures, backends, folder, stopWanted);
    if (!made.empty()) fmt::print("side by side: {}\n", made.string());
}

}  // namespace app
