#include "app/diff/series.h"
#include "app/system/atomic_files.h"
#include "app/system/csv.h"
#include "sim/core/check.h"
#include "sim/renamed.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <sstream>

namespace app {

namespace {

using OrderedJson = nlohmann::ordered_json;

/// Keys that tell of the machine and the clock, or are compared elsewhere.
constexpr std::array<std::string_view, 11> kNotOfTheRun = {
    "seconds", "wall_seconds", "seconds_per_step", "peak_memory_mb", "provenance", "content_hash", "state_hash",
    "scene",   "title",        "variant",          "label"};

[[noreturn]] void refuseLine(const std::filesystem::path& file, std::size_t line, const std::string& why)
{
    throw sim::InputError(fmt::format("{}:{}: {}", file.string(), line, why));
}

std::vector<double>& columnOf(Series& series, const std::string& name)
{
    const auto [column, isNew] = series.values.try_emplace(name);
    if (isNew) series.columns.push_back(name);
    return column->second;
}

/// One number of the row that is being read.
void put(Series& series, const std::string& name, double value)
{
    std::vector<double>& column = columnOf(series, name);
    column.resize(series.rows, kNothing);
    column.push_back(value);
}

void endRow(Series& series)
{
    ++series.rows;
    for (auto& [name, column] : series.values) column.resize(series.rows, kNothing);
}

/// All numbers below a value of JSON.
void putNumbers(Series& series, const std::string& name, const OrderedJson& value)
{
    if (value.is_number() || value.is_boolean()) {
        put(series, sim::currentName(name), value.is_boolean() ? (value.get<bool>() ? 1.0 : 0.0) : value.get<double>());
    } else if (value.is_array()) {
        for (std::size_t i = 0; i < value.size(); ++i) putNumbers(series, fmt::format("{}[{}]", name, i), value[i]);
    } else if (value.is_object()) {
        for (const auto& [key, below] : value.items()) {
            if (name.empty() && std::ranges::find(kNotOfTheRun, key) != kNotOfTheRun.end()) continue;
            putNumbers(series, name.empty() ? key : name + '/' + key, below);
        }
    }
}

void putCells(Series& series, const std::vector<std::string>& names, const std::string& text, const std::filesystem::path& file, std::size_t line)
{
    const std::vector<std::string> cells = csvCells(text);
    if (cells.size() > names.size()) refuseLine(file, line, fmt::format("{} cells, where the first line names {}", cells.size(), names.size()));
    for (std::size_t c = 0; c < cells.size(); ++c) {
        if (cells[c].empty()) continue;
        char* end = nullptr;
        const double value = std::strtod(cells[c].c_str(), &end);
        if (*end != '\0') refuseLine(file, line, fmt::format("{} is \"{}\", which is no number", names[c], cells[c]));
        put(series, names[c], value);
    }
    endRow(series);
}

}  // namespace

Series readSeries(const std::filesystem::path& file)
{
    Series series;
    series.name = file.filename().string();
    const bool isCsv = file.extension() == ".csv";
    std::istringstream in(readWhole(file));
    std::vector<std::string> names;
    std::size_t line = 0;
    for (std::string text; std::getline(in, text);) {
        ++line;
        if (isCsv && line == 1) {
            names = csvCells(text);
            for (std::string& name : names) columnOf(series, name = sim::currentName(name));
        } else if (isCsv) {
            putCells(series, names, text, file, line);
        } else {
            const auto row = OrderedJson::parse(text, nullptr, false);
            if (!row.is_object()) refuseLine(file, line, "this is no object of JSON; was the line cut off?");
            putNumbers(series, "", row);
            endRow(series);
        }
    }
    for (const char* time : {"time", "time_s"})
        if (const auto column = series.values.find(time); column != series.values.end()) series.times = column->second;
    return series;
}

Series readReportNumbers(const std::filesystem::path& file)
{
    const auto report = OrderedJson::parse(readWhole(file), nullptr, false);
    if (!report.is_object()) throw sim::InputError(fmt::format("{}: this is no report of a run", file.string()));
    Series series;
    series.name = file.filename().string();
    putNumbers(series, "", report);
    endRow(series);
    return series;
}

}  // namespace app
