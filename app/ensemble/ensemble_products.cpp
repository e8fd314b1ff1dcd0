#include "app/ensemble/ensemble_products.h"

#include "app/ensemble/band_plot.h"
#include "app/system/atomic_files.h"
#include "app/system/gnuplot.h"
#include "app/system/markdown.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <spdlog/spdlog.h>

#include <algorithm>

namespace app {

namespace fs = std::filesystem;

namespace {

constexpr double kConfidenceOfMean = 0.95;

std::string ensembleCsv(const std::vector<EnsembleColumn>& columns)
{
    std::string text = "number,runs,mean,deviation,margin_of_mean,lowest,highest\n";
    for (const EnsembleColumn& column : columns) {
        const Spread s = column.spread();
        std::string name = column.name;
        std::ranges::replace(name, ',', ';');
        if (s.count > 0)
            text += fmt::format("{},{},{:.9g},{:.9g},{:.9g},{:.9g},{:.9g}\n", name, s.count, s.mean, s.deviation, s.marginOfMean(kConfidenceOfMean),
                                s.lowest, s.highest);
    }
    return text;
}

/// Tables of the bands of a log in all ensembles that have it, and the plot of them.
void writeLog(const std::vector<Ensemble>& ensembles, const std::string& log, const std::string& title, const fs::path& folder)
{
    std::vector<BandCurve> curves;
    for (std::size_t n = 0; n < ensembles.size(); ++n)
        for (const std::vector<Series>& series : ensembles[n].logs) {
            if (fs::path(series.front().name).stem() != log) continue;
            const std::string which = ensembles.size() > 1 ? fmt::format("_{}", n + 1) : "";
            curves.push_back({ensembles[n].label, bandsOf(series), folder / fmt::format("{}_bands{}.csv", log, which)});
            writeWhole(curves.back().table, bandsText(curves.back().bands));
        }
    if (curves.empty()) return;
    if (canPlot()) drawBands(curves, panelsOf(curves), title, folder, log);
    else spdlog::warn("no gnuplot along PATH, so no plot: the numbers are in {}", curves.front().table.string());
}

void writeLogs(const std::vector<Ensemble>& ensembles, const std::string& title, const fs::path& folder)
{
    for (const char* log : {"energy", "probes"}) writeLog(ensembles, log, title, folder);
}

}  // namespace

std::string ensembleTable(const Ensemble& ensemble)
{
    std::string table = "| number | mean | 95 % of the mean | deviation | of the mean | lowest | highest |\n|---|---:|---:|---:|---:|---:|---:|\n";
    for (const EnsembleColumn& column : columnsOf(ensemble)) {
        const Spread s = column.spread();
        if (s.count == 0 || (s.lowest == 0.0 && s.highest == 0.0)) continue;
        const std::string margin = s.count > 1 ? fmt::format("± {:.2g}", s.marginOfMean(kConfidenceOfMean)) : "";
        const std::string relative = s.isAwayFromZero() ? fmt::format("{:.2g} %", 100.0 * s.deviation / std::abs(s.mean)) : "";
        table += fmt::format("| {} | {:.6g} | {} | {:.3g} | {} | {:.6g} | {:.6g} |\n", markdownCell(column.name), s.mean, margin, s.deviation,
                             relative, s.lowest, s.highest);
    }
    return table;
}

std::string writeEnsemble(const Ensemble& ensemble, const std::string& title, const fs::path& folder)
{
    std::string text = fmt::format("# {}\n\n{}\n", title, ensembleTable(ensemble));
    writeWhole(folder / "ensemble.csv", ensembleCsv(columnsOf(ensemble)));
    writeLogs({ensemble}, title, folder);
    writeWhole(folder / "ensemble.md", text);
    return text;
}

std::string writeDifferences(const std::vector<Ensemble>& ensembles, const std::string& title, double confidence, const fs::path& folder)
{
    std::string text = fmt::format("# {}\n", title), rows = differenceHeader();
    for (std::size_t n = 1; n < ensembles.size(); ++n) {
        const EnsembleDifference difference = differenceOf(ensembles.front(), ensembles[n], confidence);
        text += fmt::format("\n{}\n\n{}", sentenceOf(difference), differenceTable(difference));
        rows += differenceRows(difference);
    }
    writeLogs(ensembles, title, folder);
    writeWhole(folder / "compare.md", text);
    writeWhole(folder / "compare.csv", rows);
    return text;
}

}  // namespace app
