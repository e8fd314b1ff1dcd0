#include "app/lab/stability/stability_map.h"

#include "app/reports/output_folder.h"
#include "app/system/atomic_files.h"
#include "app/system/csv.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <iterator>
#include <sstream>

namespace app {

namespace {

bool isSame(double a, double b) { return std::abs(a - b) <= 1.0e-6 * std::abs(b); }  // as files round them

bool isOf(const StabilityRow& row, const StabilityRow& wanted)
{
    return row.method == wanted.method && isSame(row.dt, wanted.dt) && isSame(row.duration, wanted.duration);
}

struct Job {
    const StabilityMethod* method;
    StabilityRow row;
    std::filesystem::path folder;
};

std::filesystem::path folderOf(const StabilityMap& map, const StabilityRow& row)
{
    std::string name = fmt::format("{}_dt_{:g}", row.method, row.dt);
    std::ranges::replace(name, ' ', '_');
    std::ranges::replace(name, '*', '_');
    return map.folder / "runs" / name;
}

/// What is left to do at one step.
std::vector<Job> jobsOf(const StabilityMap& map, double dt, const std::vector<StabilityRow>& done)
{
    std::vector<Job> jobs;
    for (const StabilityMethod& method : map.methods) {
        StabilityRow row{.method = method.name, .dt = dt, .duration = map.duration, .why = {}};
        const auto isThere = [&](const StabilityRow& other) { return isOf(other, row); };
        const auto isEnough = [&](const StabilityRow& other) {
            return map.largestOnly && other.isStable && other.dt > dt && other.method == row.method && isSame(other.duration, row.duration);
        };
        if (std::ranges::none_of(done, isThere) && std::ranges::none_of(done, isEnough)) jobs.push_back({&method, row, folderOf(map, row)});
    }
    return jobs;
}

/// Arguments of a run at steps of the job's length: nothing may cut them.
std::vector<std::string> argumentsOf(const StabilityMap& map, const Job& job)
{
    std::vector<std::string> sets = map.sets;
    std::ranges::copy(job.method->sets, std::back_inserter(sets));
    for (const char* set : {"time.mode=fixed", "time.max_cfl.liquid=1e9", "time.max_cfl.fabric=1e9", "output.data=[energy, stats, ledger]"})
        sets.emplace_back(set);
    sets.push_back(fmt::format("time.dt={:.9g}", job.row.dt));
    sets.push_back(fmt::format("time.duration={:.9g}", job.row.duration));
    sets.push_back(fmt::format("output.every={:.9g}", job.row.duration));
    std::vector<std::string> arguments = {"run", map.scene, "--out", job.folder.string(), "--threads", "1", "--no-frames", "--no-video"};
    for (const std::string& set : sets) arguments.insert(arguments.end(), {"--set", set});
    return arguments;
}

void tell(const StabilityRow& row)
{
    fmt::print("{:<28} dt {:<8g} {:>7.1f} s  {}\n", row.method, row.dt, row.seconds, row.isStable ? "stable" : row.why);
    std::fflush(stdout);
}

void runStep(const StabilityMap& map, double dt, const std::filesystem::path& csv, std::vector<StabilityRow>& rows)
{
    const std::vector<Job> jobs = jobsOf(map, dt, rows);
    ProcessPool pool{.count = jobs.size(), .width = map.width, .limitSeconds = map.limitSeconds};
    pool.stopWanted = map.stopWanted;
    pool.arguments = [&](std::size_t n) { return argumentsOf(map, jobs[n]); };
    pool.ended = [&](std::size_t n, const ProcessEnd& end) {
        if (map.stopWanted()) return;
        rows.push_back(judgeStability(end, jobs[n].folder, jobs[n].row));
        tell(rows.back());
        std::filesystem::remove_all(jobs[n].folder);
        writeWhole(csv, stabilityTable(rows));
    };
    runProcesses(pool);
}

}  // namespace

std::vector<StabilityRow> runStabilityMap(const StabilityMap& map)
{
    makeFolder(map.folder);
    const auto csv = map.folder / "map.csv";
    std::vector<StabilityRow> rows = readStabilityTable(csv);
    std::vector<double> steps = map.steps;
    std::ranges::sort(steps, std::greater());  // the longest are over soonest
    for (const double dt : steps) runStep(map, dt, csv, rows);
    return rows;
}

std::string stabilityTable(const std::vector<StabilityRow>& rows)
{
    std::string csv = "method,dt_s,duration_s,stable,energy_gain,largest_speed_cm_s,seconds,why\n";
    for (const StabilityRow& row : rows)
        fmt::format_to(std::back_inserter(csv), "{},{:.9g},{:.9g},{},{:.4g},{:.4g},{:.1f},{}\n", row.method, row.dt, row.duration,
                       row.isStable ? "yes" : "no", row.energyGain, row.largestSpeed, row.seconds, row.why);
    return csv;
}

std::vector<StabilityRow> readStabilityTable(const std::filesystem::path& csv)
{
    std::vector<StabilityRow> rows;
    if (!std::filesystem::exists(csv)) return rows;
    std::istringstream in(readWhole(csv));
    std::string line;
    for (std::getline(in, line); std::getline(in, line);) {
        std::vector<std::string> cell = csvCells(line);
        cell.resize(8);
        const auto number = [&](int i) { return std::strtod(cell[i].c_str(), nullptr); };
        rows.push_back({.method = cell[0],
                        .dt = number(1),
                        .duration = number(2),
                        .isStable = cell[3] == "yes",
                        .why = cell[7],
                        .energyGain = number(4),
                        .largestSpeed = number(5),
                        .seconds = number(6)});
    }
    return rows;
}

double largestStableStep(const std::vector<StabilityRow>& rows, const std::string& method, double duration)
{
    double largest = 0.0, smallestUnstable = std::numeric_limits<double>::infinity();
    const auto isMeant = [&](const StabilityRow& row) { return row.method == method && isSame(row.duration, duration); };
    for (const StabilityRow& row : rows)
        if (isMeant(row) && !row.isStable) smallestUnstable = std::min(smallestUnstable, row.dt);
    for (const StabilityRow& row : rows)
        if (isMeant(row) && row.isStable && row.dt < smallestUnstable) largest = std::max(largest, row.dt);
    return largest;
}

}  // namespace app
