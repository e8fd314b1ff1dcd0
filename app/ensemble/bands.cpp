#include "app/ensemble/bands.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace app {

const Band* Bands::find(const std::string& column) const
{
    const auto found = std::ranges::find(all, column, &Band::column);
    return found == all.end() ? nullptr : &*found;
}

Bands bandsOf(const std::vector<Series>& log)
{
    const Series& first = log.front();
    // Steps end on the last time itself but for the rounding of what is written of it.
    constexpr double kRounding = 1.0e-6;
    double end = first.times.back();
    for (const Series& series : log) end = std::min(end, series.times.back());
    Bands bands = {.log = std::filesystem::path(first.name).stem().string(), .times = {}, .all = {}};
    for (const double time : first.times)
        if (time <= end + kRounding * std::abs(end)) bands.times.push_back(time);
    for (const std::string& column : first.columns) {
        if (column == "time_s") continue;
        Band band = {.column = column, .at = {}};
        for (const double time : bands.times) {
            std::vector<double> numbers;
            for (const Series& series : log)
                if (const auto found = series.values.find(column); found != series.values.end())
                    numbers.push_back(valueAt(series, found->second, time));
            band.at.push_back(spreadOf(numbers));
        }
        bands.all.push_back(std::move(band));
    }
    return bands;
}

std::string bandsText(const Bands& bands)
{
    std::string text = "time_s";
    for (const Band& band : bands.all) text += fmt::format(",{0} mean,{0} deviation,{0} lowest,{0} highest", band.column);
    for (std::size_t row = 0; row < bands.times.size(); ++row) {
        text += fmt::format("\n{:.9g}", bands.times[row]);
        for (const Band& band : bands.all) {
            const Spread& at = band.at[row];
            text += at.count > 0 ? fmt::format(",{:.9g},{:.9g},{:.9g},{:.9g}", at.mean, at.deviation, at.lowest, at.highest) : ",,,,";
        }
    }
    return text + '\n';
}

std::size_t placeOfMean(const Bands& bands, const std::string& column)
{
    constexpr std::size_t kNumbers = 4;
    const auto found = std::ranges::find(bands.all, column, &Band::column);
    return 2 + kNumbers * static_cast<std::size_t>(found - bands.all.begin());
}

}  // namespace app
