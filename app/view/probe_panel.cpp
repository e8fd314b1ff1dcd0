#include "app/view/probe_panel.h"

#include "app/view/readable_number.h"

#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <cfloat>
#include <cmath>

namespace app {

namespace {

constexpr std::size_t kMostReadings = 2000;  ///< of a plot: older ones are forgotten
constexpr float kWidth = 18.0f;              ///< [font sizes]
constexpr float kPlotHeight = 2.6f;          ///< [lines of text]

/// "0 to 1072": what rounding leaves beside the largest is nothing.
std::string rangeOf(const std::vector<float>& values)
{
    const auto [low, high] = std::ranges::minmax(values);
    const double nothing = 1.0e-6 * std::max(std::abs(low), std::abs(high));
    const auto rounded = [&](double value) { return readableNumber(std::abs(value) < nothing ? 0.0 : value); };
    return rounded(low) + " to " + rounded(high);
}

}  // namespace

void ProbePanel::Course::add(const ProbeTitle& title, double time, std::span<const std::optional<double>> read)
{
    latest = read.front();
    latestTime = time;
    if (title.points > 0) {
        values.clear();
        for (const std::optional<double>& value : read)
            if (value) values.push_back(static_cast<float>(*value));
        return;
    }
    if (!latest) return;
    if (values.size() == kMostReadings) {
        values.erase(values.begin(), values.begin() + kMostReadings / 2);
        times.erase(times.begin(), times.begin() + kMostReadings / 2);
    }
    values.push_back(static_cast<float>(*latest));
    times.push_back(time);
}

/// Of a line the values are those of one time: all hold, or none.
void ProbePanel::Course::forgetAfter(double time)
{
    if (latestTime <= time) return;
    const auto kept = std::ranges::upper_bound(times, time) - times.begin();
    times.resize(static_cast<std::size_t>(kept));
    values.resize(times.size());
    latest = values.empty() ? std::nullopt : std::optional<double>(values.back());
    latestTime = time;
}

void ProbePanel::Course::draw(const ProbeTitle& title) const
{
    const bool isLine = title.points > 0;
    std::string text = title.name;
    if (isLine) text += fmt::format(" at {} points [{}]", title.points, title.unit);
    else text += latest ? fmt::format(": {} {}", readableNumber(*latest), title.unit) : fmt::format(": no value [{}]", title.unit);
    ImGui::TextUnformatted(text.c_str());
    const std::string range = isLine && !values.empty() ? rangeOf(values) : "";
    const ImVec2 size(ImGui::GetContentRegionAvail().x, kPlotHeight * ImGui::GetTextLineHeight());
    ImGui::PlotLines("##course", values.data(), static_cast<int>(values.size()), 0, range.c_str(), FLT_MAX, FLT_MAX, size);
}

void ProbePanel::Side::add(const LiveReadings& taken)
{
    if (titles != taken.titles) courses.clear();
    titles = taken.titles;
    if (!titles) return;
    courses.resize(titles->size());
    for (Course& course : courses) course.forgetAfter(taken.forgetAfter);
    for (const ProbeReading& reading : taken.readings) {
        std::span<const std::optional<double>> left = reading.values;
        for (std::size_t i = 0; i < courses.size(); ++i) {
            const std::size_t count = std::max<std::size_t>(1, (*titles)[i].points);
            courses[i].add((*titles)[i], reading.time, left.first(count));
            left = left.subspan(count);
        }
    }
}

void ProbePanel::Side::draw() const
{
    for (std::size_t i = 0; i < courses.size(); ++i) {
        ImGui::PushID(static_cast<int>(i));
        courses[i].draw((*titles)[i]);
        ImGui::PopID();
    }
}

void ProbePanel::take(LivePair& pair)
{
    for (std::size_t s = 0; s < pair.sides().size(); ++s) sides_[s].add(pair.sides()[s]->live.takeReadings());
}

void ProbePanel::draw(const LivePair& pair) const
{
    const std::size_t count = pair.sides().size();
    if (std::none_of(sides_.begin(), sides_.begin() + static_cast<std::ptrdiff_t>(count), [](const Side& side) { return side.titles != nullptr; }))
        return;
    const float unit = ImGui::GetFontSize(), width = std::min(kWidth * unit, 0.9f * ImGui::GetIO().DisplaySize.x);
    ImGui::SetNextWindowPos(ImVec2(ImGui::GetIO().DisplaySize.x - width - 0.4f * unit, 0.4f * unit), ImGuiCond_FirstUseEver);
    ImGui::SetNextWindowSize(ImVec2(width, 0.48f * ImGui::GetIO().DisplaySize.y), ImGuiCond_FirstUseEver);
    if (ImGui::Begin("Probes")) {
        for (std::size_t s = 0; s < count; ++s) {
            ImGui::PushID(static_cast<int>(s));
            if (count > 1 && sides_[s].titles) ImGui::TextUnformatted(s == 0 ? "A" : "B");
            sides_[s].draw();
            ImGui::PopID();
        }
    }
    ImGui::End();
}

}  // namespace app
