#include "app/view/live_panel.h"

#include <imgui.h>

#include <algorithm>

namespace app {

namespace {

constexpr std::size_t kMostPoints = 2000;  ///< of a plot: older steps are forgotten

void addTo(std::vector<float>& values, double value)
{
    if (values.size() == kMostPoints) values.erase(values.begin(), values.begin() + kMostPoints / 2);
    values.push_back(static_cast<float>(value));
}

void plot(const char* label, const std::vector<float>& values)
{
    const float height = 3.0f * ImGui::GetTextLineHeight();
    ImGui::PlotLines(label, values.data(), static_cast<int>(values.size()), 0, nullptr, FLT_MAX, FLT_MAX,
                     ImVec2(0.0f, height));
}

const char* wordFor(LiveMode mode)
{
    switch (mode) {
        case LiveMode::Playing:
            return "playing";
        case LiveMode::Ended:
            return "at its end";
        case LiveMode::Failed:
            return "failed";
        default:
            return "paused";
    }
}

}  // namespace

void LivePanel::add(std::vector<LiveStep> steps)
{
    for (LiveStep& step : steps) {
        if (!step.report.isReflected) addTo(energy_, step.report.energies.total());
        addTo(cfl_, step.report.cfl);
        addTo(iterations_, step.report.pressure.iterations);
        addTo(milliseconds_, 1000.0 * step.seconds);
        last_ = std::move(step);
    }
}

void LivePanel::playOrPause(LiveSimulation& live) const
{
    if (live.status().mode == LiveMode::Playing)
        live.pause();
    else
        live.play();
}

void LivePanel::draw(LiveSimulation& live)
{
    const float unit = ImGui::GetFontSize();
    ImGui::SetNextWindowPos(ImVec2(0.5f * unit, 0.5f * unit), ImGuiCond_FirstUseEver);
    ImGui::SetNextWindowSize(ImVec2(22.0f * unit, 34.0f * unit), ImGuiCond_FirstUseEver);
    if (ImGui::Begin("Simulation")) {
        const LiveStatus status = live.status();
        ImGui::Text("t = %.4f s, step %lld, %s", status.time, static_cast<long long>(status.step),
                    wordFor(status.mode));
        if (!status.failure.empty()) ImGui::TextWrapped("%s", status.failure.c_str());
        drawButtons(live, status);
        if (ImGui::CollapsingHeader("Steps", ImGuiTreeNodeFlags_DefaultOpen)) drawPlots();
        if (ImGui::CollapsingHeader("Picture", ImGuiTreeNodeFlags_DefaultOpen) && look_.draw()) live.show(look_.wanted());
    }
    ImGui::End();
}

void LivePanel::drawButtons(LiveSimulation& live, const LiveStatus& status)
{
    if (ImGui::Button(status.mode == LiveMode::Playing ? "Pause###play" : "Play###play")) playOrPause(live);
    if (ImGui::IsItemHovered()) ImGui::SetTooltip("space");
    ImGui::SameLine();
    if (ImGui::Button("Step")) live.stepOnce();
    if (ImGui::IsItemHovered()) ImGui::SetTooltip("S");
    ImGui::SameLine();
    if (ImGui::Button("Restart")) live.restart();
    if (ImGui::IsItemHovered()) ImGui::SetTooltip("R");
    const int last = static_cast<int>(status.moments.size()) - 1;
    const auto current = std::ranges::upper_bound(status.moments, status.time);
    int moment = static_cast<int>(current - status.moments.begin()) - 1;
    ImGui::SetNextItemWidth(-6.0f * ImGui::GetFontSize());
    if (last > 0 && ImGui::SliderInt("go back", &moment, 0, last, "moment %d"))
        live.goBackTo(status.moments[std::clamp(moment, 0, last)]);
}

void LivePanel::drawPlots() const
{
    const sim::StepReport& report = last_.report;
    ImGui::Text("dt %.3g s, %zu particles, %.1f ms per step", report.dt, report.particles, 1000.0 * last_.seconds);
    plot("energy [erg]", energy_);
    plot("CFL [-]", cfl_);
    plot("iterations", iterations_);
    plot("step [ms]", milliseconds_);
}

}  // namespace app
