#include "app/view/live_panel.h"

#include <imgui.h>

#include <algorithm>

namespace app {

namespace {

const char* wordFor(LiveMode mode)
{
    switch (mode) {
        case LiveMode::Playing: return "playing";
        case LiveMode::Ended: return "at its end";
        case LiveMode::Failed: return "failed";
        default: return "paused";
    }
}

void explainKey(const char* key)
{
    if (ImGui::IsItemHovered()) ImGui::SetTooltip("%s", key);
}

}  // namespace

void LivePanel::take(LivePair& pair)
{
    for (std::size_t s = 0; s < pair.sides().size(); ++s) plots_[s].add(pair.sides()[s]->live.takeSteps());
}

void LivePanel::draw(LivePair& pair)
{
    drawStatus(pair);
    drawButtons(pair);
    drawRewindPoints(pair);
    const bool isPair = pair.sides().size() > 1;
    for (std::size_t s = 0; s < pair.sides().size(); ++s) {
        ImGui::PushID(static_cast<int>(s));
        const char* title = !isPair ? "Steps" : s == 0 ? "Steps of A" : "Steps of B";
        if (ImGui::CollapsingHeader(title, ImGuiTreeNodeFlags_DefaultOpen)) plots_[s].draw();
        ImGui::PopID();
    }
}

void LivePanel::drawStatus(const LivePair& pair) const
{
    for (const auto& side : pair.sides()) {
        const LiveStatus status = side->live.status();
        ImGui::Text("t = %.4f s, step %lld, %s", status.time, static_cast<long long>(status.step), wordFor(status.mode));
        if (!status.failure.empty()) ImGui::TextWrapped("%s", status.failure.c_str());
    }
}

void LivePanel::drawButtons(LivePair& pair) const
{
    const bool isPlaying = std::ranges::any_of(pair.sides(), [](const auto& side) { return side->live.status().mode == LiveMode::Playing; });
    if (ImGui::Button(isPlaying ? "Pause###play" : "Play###play")) pair.playOrPause();
    explainKey("space");
    ImGui::SameLine();
    if (ImGui::Button("Step")) pair.all([](LiveSimulation& live) { live.stepOnce(); });
    explainKey("S");
    ImGui::SameLine();
    if (ImGui::Button("Restart")) pair.all([](LiveSimulation& live) { live.restart(); });
    explainKey("R");
}

/// The slider over the moments that are kept.
void LivePanel::drawRewindPoints(LivePair& pair) const
{
    const LiveStatus status = pair.first().status();
    const int last = static_cast<int>(status.moments.size()) - 1;
    if (last <= 0) return;
    const auto current = std::ranges::upper_bound(status.moments, status.time);
    int moment = static_cast<int>(current - status.moments.begin()) - 1;
    ImGui::SetNextItemWidth(-6.0f * ImGui::GetFontSize());
    char text[32];
    std::snprintf(text, sizeof text, "%.4f s", status.moments[std::clamp(moment, 0, last)]);
    if (!ImGui::SliderInt("go back", &moment, 0, last, text)) return;
    const double time = status.moments[std::clamp(moment, 0, last)];
    pair.all([&](LiveSimulation& live) { live.goBackTo(time); });
}

}  // namespace app
