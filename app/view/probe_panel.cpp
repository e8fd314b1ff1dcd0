#include "app/view/probe_panel.h"

#include "app/view/readable_number.h"

#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <cfloat>
#include <cmath>

namespace app {

namespace {

constexpr std::size_t kMostReadings = 2000;  ///< readings of a plot: older ones are forgotten
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

/// Drops readings after a time. Values along a line are all of one time: all hold, or none.
void ProbePanel::Course::dropAfter(double time)
{
    if (latestTime <= time) return;
    const auto kept = std::ranges::upper_bound(times, time) - times.begin();
    times.resize(static_cast<std::size_t>(kept));
    values.resize(times.size());
    latest = values.empty() ? std::nullopt : std::optional<double>(values.back());
    latestTime = time;
}

void ProbePanel::Course::plot(bool isLine, float width) const
{
    const std::string text = isLine && !values.empty() ? rangeOf(values) : latest ? readableNumber(*latest) : "no value";
    const ImVec2 size(width, kPlotHeight * ImGui::GetTextLineHeight());
    ImGui::PlotLines("##course", values.data(), static_cast<int>(values.size()), 0, text.c_str(), FLT_MAX, FLT_MAX, size);
}

bool ProbePanel::Side::hasSameProbes(const Side& other) const { return titles && other.titles && *titles == *other.titles; }

void ProbePanel::Side::add(const LiveReadings& taken)
{
    if (titles != taken.titles) courses.clear();
    titles = taken.titles;
    if (!titles) return;
    courses.resize(titles->size());
    for (Course& course : courses) course.dropAfter(taken.dropAfter);
    for (const ProbeReading& reading : taken.readings) {
        std::span<const std::optional<double>> left = reading.values;
        for (std::size_t i = 0; i < courses.size(); ++i) {
            const std::size_t count = std::max<std::size_t>(1, (*titles)[i].points);
            courses[i].add((*titles)[i], reading.time, left.first(count));
            left = left.subspan(count);
        }
    }
}

void ProbePanel::drawProbe(std::size_t probe, std::span<const Side> sides) const
{
    const ProbeTitle& title = (*sides.front().titles)[probe];
    const std::string text =
        title.name + (title.points > 0 ? fmt::format(" at {} points [{}]", title.points, title.unit) : fmt::format(" [{}]", title.unit));
    ImGui::TextUnformatted(text.c_str());
    const auto count = static_cast<float>(sides.size());
    const float spacing = ImGui::GetStyle().ItemInnerSpacing.x, width = (ImGui::GetContentRegionAvail().x - (count - 1.0f) * spacing) / count;
    for (std::size_t s = 0; s < sides.size(); ++s) {
        if (s > 0) ImGui::SameLine(0.0f, spacing);
        ImGui::PushID(static_cast<int>(s));
        sides[s].courses[probe].plot(title.points > 0, width);
        ImGui::PopID();
    }
}

void ProbePanel::drawProbes(std::span<const Side> sides) const
{
    for (std::size_t probe = 0; probe < sides.front().courses.size(); ++probe) {
        ImGui::PushID(static_cast<int>(probe));
        drawProbe(probe, sides);
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
        const std::span<const Side> sides = std::span(sides_).first(count);
        if (count == 1 || sides[0].hasSameProbes(sides[1])) {
            if (count > 1) ImGui::TextDisabled("A left, B right");
            drawProbes(sides);
        } else {
            for (std::size_t s = 0; s < count; ++s) {
                if (!sides[s].titles) continue;
                ImGui::PushID(static_cast<int>(s));
                ImGui::TextDisabled(s == 0 ? "A" : "B");
                drawProbes(sides.subspan(s, 1));
                ImGui::PopID();
            }
        }
    }
    ImGui::End();
}

}  // namespace app
