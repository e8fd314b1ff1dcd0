#include "app/lab/precision/precision_row.h"

#include "app/system/atomic_files.h"
#include "app/system/csv.h"
#include "sim/core/check.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <iterator>
#include <sstream>

namespace app {

namespace {

constexpr std::string_view kHeader =
    "case,method,integrator,step,resolution,modes,dt,cfl,cell,steps,wall_s,error,energy_left,viscosity,threads,repeats,"
    "settings,outcome";
constexpr std::size_t kColumns = 18;

/// Reads cells one after the other.
class Cells {
 public:
    explicit Cells(const std::string& line) : cells_(csvCells(line)) {}
    bool areComplete() const { return cells_.size() == kColumns; }
    bool areNumbers() const { return areNumbers_; }
    const std::string& text() { return cells_[next_++]; }
    double number()
    {
        const std::string& cell = text();
        char* end = nullptr;
        const double value = std::strtod(cell.c_str(), &end);
        areNumbers_ = areNumbers_ && end != cell.c_str() && *end == '\0';
        return value;
    }
    int whole() { return static_cast<int>(number()); }

 private:
    std::vector<std::string> cells_;
    std::size_t next_ = 0;
    bool areNumbers_ = true;
};

PrecisionRow rowFrom(Cells& cells)
{
    PrecisionRow row;
    row.scene = cells.text();
    for (std::string* name : {&row.names.method, &row.names.integrator, &row.names.step, &row.names.resolution}) *name = cells.text();
    row.modes = cells.whole();
    for (double* value : {&row.dt, &row.cfl, &row.cell}) *value = cells.number();
    row.steps = static_cast<std::int64_t>(cells.number());
    for (double* value : {&row.wallSeconds, &row.error, &row.energyLeft, &row.viscosity}) *value = cells.number();
    for (int* value : {&row.threads, &row.repeats}) *value = cells.whole();
    row.settings = cells.text();
    row.outcome = cells.text();
    return row;
}

/// Fit for one cell.
std::string cellText(std::string text)
{
    std::ranges::replace_if(
        text, [](char c) { return c == ',' || c == '\n' || c == '"'; }, ';');
    return text;
}

}  // namespace

std::string precisionCsv(const std::vector<PrecisionRow>& rows)
{
    std::string csv = std::string(kHeader) + '\n';
    for (const PrecisionRow& row : rows)
        fmt::format_to(std::back_inserter(csv), "{},{},{},{},{},{},{:.6g},{:.4g},{:.6g},{},{:.4g},{:.6g},{:.6g},{:.6g},{},{},{},{}\n", row.scene,
                       row.names.method, row.names.integrator, row.names.step, row.names.resolution, row.modes, row.dt, row.cfl, row.cell, row.steps,
                       row.wallSeconds, row.error, row.energyLeft, row.viscosity, row.threads, row.repeats, row.settings, cellText(row.outcome));
    return csv;
}

std::vector<PrecisionRow> readPrecisionCsv(const std::filesystem::path& file)
{
    std::vector<PrecisionRow> rows;
    if (!std::filesystem::exists(file)) return rows;
    std::istringstream in(readWhole(file));
    std::string line;
    std::getline(in, line);
    const auto fail = [&](std::size_t number) {
        throw sim::InputError(fmt::format("{}:{}: is no row of bench precision: remove the file to start anew", file.string(), number));
    };
    if (line != kHeader) fail(1);
    while (std::getline(in, line)) {
        Cells cells(line);
        if (!cells.areComplete()) fail(rows.size() + 2);
        rows.push_back(rowFrom(cells));
        if (!cells.areNumbers()) fail(rows.size() + 1);
    }
    return rows;
}

}  // namespace app
