#include "app/reports/compare_table.h"

#include "app/system/markdown.h"
#include "app/system/progress.h"

#include <fmt/format.h>

#include <algorithm>
#include <functional>

namespace app {

namespace {

std::string runRow(const RunResult& run, const RunResult* reference)
{
    std::string row = fmt::format("| {} | {:.4f} |", markdownCell(run.label), run.secondsPerStep);
    if (reference) row += fmt::format(" {:.2f} |", reference->secondsPerStep > 0.0 ? run.secondsPerStep / reference->secondsPerStep : 0.0);
    return row + fmt::format(" {} | {:.4g} | {} | {:.0f} | {} | {:.1f} | {} | `{}` |\n", run.steps, run.simulatedTime,
                             formatDuration(run.wallSeconds), run.peakMemoryMegabytes, run.particles, run.meanIterations, run.maxIterations,
                             run.stateHash);
}

std::string runTable(const std::vector<RunResult>& runs, const RunResult* reference)
{
    std::string table = "| variant | s/step (median) |";
    std::string rule = "|---|---:|";
    if (reference) {
        table += fmt::format(" × {} |", markdownCell(reference->label));
        rule += "---:|";
    }
    table += " steps | simulated s | wall time | peak memory MB | particles | iterations/step | most iterations | state hash |\n";
    table += rule + "---:|---:|---:|---:|---:|---:|---:|---|\n";
    for (const auto& run : runs) table += runRow(run, reference);
    return table;
}

std::string stageRows(const std::vector<RunResult>& runs)
{
    std::string table = "| stage [median ms] |", rule = "|---|";
    for (const auto& run : runs) {
        table += fmt::format(" {} |", markdownCell(run.label));
        rule += "---:|";
    }
    table += "\n" + rule + "\n";
    for (int s = 0; s < sim::kStages; ++s) {
        if (std::ranges::none_of(runs, [s](const RunResult& run) { return run.stageSeconds[s].has_value(); })) continue;
        table += fmt::format("| {} |", sim::kStageNames[s]);
        for (const auto& run : runs) {
            const auto& seconds = run.stageSeconds[s];
            table += seconds ? fmt::format(" {:.3f} |", 1000.0 * *seconds) : std::string(" - |");
        }
        table += "\n";
    }
    return table;
}

}  // namespace

std::string compareTable(const std::string& title, const std::vector<RunResult>& runs, const std::string& reference)
{
    const auto found = std::ranges::find(runs, reference, &RunResult::label);
    const RunResult* base = reference.empty() || found == runs.end() ? nullptr : &*found;
    return fmt::format("# {}\n\n{}\n{}", title, runTable(runs, base), stageRows(runs));
}

std::string outcomeSentence(std::vector<RunOutcome> runs)
{
    std::ranges::stable_sort(runs, std::ranges::greater(), &RunOutcome::energyKept);
    std::string sentence;
    for (const RunOutcome& run : runs)
        sentence += fmt::format("{} {} {:.1f} % in {}", sentence.empty() ? "Energy kept and time taken:" : ",", run.label, 100.0 * run.energyKept,
                                formatDuration(run.wallSeconds));
    return sentence.empty() ? "" : sentence + ".";
}

}  // namespace app
