#include "app/ensemble/ensemble.h"

#include "app/reports/run_report.h"
#include "sim/core/check.h"
#include "sim/scene/node.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>

namespace app {

namespace fs = std::filesystem;

namespace {

/// Columns that plots want and that are sums or ratios of others, so that they are not judged beside them.
constexpr std::array<std::string_view, 4> kDerived = {"moving_erg", "per_particle_erg", "published_per_particle_erg", kLessTheFirst};

/// Numbers of a report that tell of the simulation itself, beside all below "forces/".
constexpr std::array<std::string_view, 3> kOfReport = {"steps", "iterations/mean", "largest_cfl"};

/// Numbers of a run that tell of the machine.
struct MachineFigure {
    const char* name;
    double (*of)(const RunResult&);
};
constexpr MachineFigure kOfMachine[] = {
    {"wall_s", [](const RunResult& r) { return r.wallSeconds; }},
    {"s_per_step, median", [](const RunResult& r) { return r.secondsPerStep; }},
    {"peak_memory_mb", [](const RunResult& r) { return r.peakMemoryMegabytes; }},
};

template <class Of>
void derive(Series& series, std::string_view name, Of&& of)
{
    std::vector<double> values(series.rows);
    for (std::size_t row = 0; row < series.rows; ++row) values[row] = of(row);
    series.columns.emplace_back(name);
    series.values[std::string(name)] = std::move(values);
}

/// energy.csv with what the plots of energies show.
/// @param vertices  of fabric, which the paper counts with the particles
void addDerived(Series& energies, double vertices)
{
    const auto at = [&](const char* column, std::size_t row) { return energies.values.at(column)[row]; };
    const auto perParticle = [&](const char* column, std::size_t row) { return at(column, row) / (at("particles", row) + vertices); };
    derive(energies, kDerived[0], [&](std::size_t row) { return at("kinetic_erg", row) + at("modal_erg", row); });
    derive(energies, kDerived[1], [&](std::size_t row) { return perParticle("total_erg", row); });
    derive(energies, kDerived[2], [&](std::size_t row) { return perParticle("published_erg", row); });
}

/// A log of every run; none unless all have it.
std::vector<Series> logOf(const Ensemble& ensemble, const char* name)
{
    std::vector<Series> all;
    for (std::size_t n = 0; n < ensemble.runs.size(); ++n) {
        if (!fs::exists(ensemble.runs[n].folder / name)) return {};
        Series series = readSeries(ensemble.runs[n].folder / name);
        if (series.times.empty()) return {};
        if (series.values.contains("published_erg")) addDerived(series, ensemble.reports[n].values.at("fabric/vertices").front());
        all.push_back(std::move(series));
    }
    return all;
}

/// The mean of a column over the time in which it has values, by the trapezoidal rule.
double meanOverTime(const std::vector<double>& times, const std::vector<double>& values)
{
    double sum = 0.0, length = 0.0;
    for (std::size_t row = 1; row < values.size(); ++row) {
        const double dt = times[row] - times[row - 1], mean = 0.5 * (values[row] + values[row - 1]);
        if (std::isnan(mean)) continue;
        sum += dt * mean;
        length += dt;
    }
    return length > 0.0 ? sum / length : kNothing;
}

/// The columns that at least one of them has, in order.
std::vector<std::string> columnNames(const std::vector<Series>& all)
{
    std::vector<std::string> names;
    std::set<std::string> known;
    for (const Series& series : all)
        for (const std::string& name : series.columns)
            if (known.insert(name).second) names.push_back(name);
    return names;
}

/// One number of each series, made of a column.
template <class Of>
EnsembleColumn memberColumn(const std::vector<Series>& all, const std::string& column, const std::string& name, Of&& of)
{
    EnsembleColumn made = {.name = name, .values = {}};
    for (const Series& series : all) {
        const auto found = series.values.find(column);
        made.values.push_back(found == series.values.end() || found->second.empty() ? kNothing : of(series, found->second));
    }
    return made;
}

/// Reports have forces and torques in cgs, whatever the scene is in.
const char* unitOfForce(const std::string& name) { return name.find("torque") == std::string::npos ? " [dyn]" : " [dyn cm]"; }

void addReportColumns(const Ensemble& ensemble, std::vector<EnsembleColumn>& columns)
{
    const auto first = [](const Series&, const std::vector<double>& values) { return values.front(); };
    for (const std::string& name : columnNames(ensemble.reports))
        if (name.starts_with("forces/")) columns.push_back(memberColumn(ensemble.reports, name, name + unitOfForce(name), first));
        else if (std::ranges::find(kOfReport, name) != kOfReport.end()) columns.push_back(memberColumn(ensemble.reports, name, name, first));
}

void addLogColumns(const std::vector<Series>& log, std::vector<EnsembleColumn>& columns)
{
    const auto last = [](const Series&, const std::vector<double>& values) { return values.back(); };
    const auto mean = [](const Series& series, const std::vector<double>& values) { return meanOverTime(series.times, values); };
    for (const std::string& name : columnNames(log)) {
        if (name == "time_s" || std::ranges::find(kDerived, name) != kDerived.end()) continue;
        columns.push_back(memberColumn(log, name, name + ", at the end", last));
        columns.push_back(memberColumn(log, name, name + ", mean", mean));
    }
}

void addMachineColumns(const Ensemble& ensemble, std::vector<EnsembleColumn>& columns)
{
    for (const MachineFigure& figure : kOfMachine) {
        EnsembleColumn column = {.name = figure.name, .values = {}, .isOfMachine = true};
        for (std::size_t n = 0; n < ensemble.runs.size(); ++n) {
            const auto report = readReport(ensemble.runs[n].folder);
            column.values.push_back(report && n >= ensemble.timedFrom ? figure.of(*report) : kNothing);
        }
        columns.push_back(std::move(column));
    }
}

}  // namespace

Ensemble ensembleOf(const std::vector<EnsembleRun>& runs, const std::string& label)
{
    Ensemble ensemble = {.label = label, .runs = {}, .missing = 0, .timedFrom = 0, .reports = {}, .logs = {}};
    for (const EnsembleRun& run : runs) {
        const auto report = readReport(run.folder);
        if (!report || report->status != "done") {
            ++ensemble.missing;
            continue;
        }
        ensemble.runs.push_back(run);
        ensemble.reports.push_back(readReportNumbers(run.folder / "report.json"));
    }
    for (const char* log : {"energy.csv", "probes.csv"})
        if (auto all = logOf(ensemble, log); !all.empty()) ensemble.logs.push_back(std::move(all));
    return ensemble;
}

void addDifferences(const Ensemble& first, Ensemble& ensemble)
{
    if (first.logs.empty() || ensemble.logs.empty()) return;
    for (std::size_t n = 0; n < ensemble.runs.size(); ++n) {
        Series& energies = ensemble.logs.front()[n];
        const auto pair = std::ranges::find(first.runs, ensemble.runs[n].draw, &EnsembleRun::draw);
        if (pair == first.runs.end()) continue;
        const Series& other = first.logs.front()[static_cast<std::size_t>(pair - first.runs.begin())];
        const std::vector<double> percent = percentOfDifference(energies, other, "total_erg");
        derive(energies, kLessTheFirst, [&](std::size_t row) { return percent[row]; });
    }
}

bool isEnsemble(const fs::path& folder) { return fs::is_regular_file(folder / kEnsembleFile); }

Ensemble readEnsemble(const fs::path& folder)
{
    const fs::path file = folder / kEnsembleFile;
    if (!isEnsemble(folder))
        throw sim::InputError(fmt::format("{}: this is no folder of an ensemble, which has an {}", folder.string(), kEnsembleFile));
    auto source = std::make_shared<sim::TextSource>();
    source->name = file.string();
    const sim::Node root = sim::parseYaml(readWhole(file), source);
    const sim::Node* runs = root.find("runs");
    if (!runs || !runs->isList()) throw sim::InputError(fmt::format("{}: it lists no runs", file.string()));
    std::vector<EnsembleRun> all;
    for (sim::Node run : runs->items) {
        const sim::Node* name = run.find("name");
        if (!name) continue;
        const fs::path of = folder / "runs" / name->text;
        run.erase("name");
        all.push_back({of, run.flow()});
    }
    Ensemble ensemble = ensembleOf(all, "");
    if (ensemble.runs.empty())
        throw sim::InputError(fmt::format("{}: none of its runs is done; drench sweep {} does them", folder.string(), file.string()));
    const RunResult report = *readReport(ensemble.runs.front().folder);
    ensemble.label = report.label.empty() ? folder.lexically_normal().filename().string() : report.label;
    return ensemble;
}

std::vector<EnsembleColumn> columnsOf(const Ensemble& ensemble)
{
    std::vector<EnsembleColumn> columns;
    for (const auto& log : ensemble.logs) addLogColumns(log, columns);
    addReportColumns(ensemble, columns);
    addMachineColumns(ensemble, columns);
    return columns;
}

}  // namespace app
