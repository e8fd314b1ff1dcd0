#include "app/view/viewer_inner.h"

#include <imgui.h>

#include <algorithm>

// The panels of the window.

namespace app {

namespace {

constexpr float kPanelWidth = 24.0f;  ///< width of the column with the panels [font sizes]

}  // namespace

/// Width that two scenes leave to the panels [pixels]; one is drawn behind them.
int Viewer::Inner::widthOfPanels() const
{
    const int width = static_cast<int>(kPanelWidth * ImGui::GetFontSize());
    return pair->sides().size() > 1 && window.width() > 2 * width ? width : 0;
}

/// Draws a hint to those who have looked at no scene before.
void Viewer::Inner::drawFirstHint() const
{
    if (!isFirstUse) return;
    ImGui::PushTextWrapPos(0.0f);
    ImGui::TextDisabled(
        "%s",
        "Space plays and pauses, S takes a step, R restarts. Drag with the left button to turn, with the right one to move; the wheel "
        "comes nearer, F shows all. Point at anything for what it is.");
    ImGui::PopTextWrapPos();
}

void Viewer::Inner::drawPanels()
{
    const float unit = ImGui::GetFontSize(), height = ImGui::GetIO().DisplaySize.y;
    const float width = std::min((kPanelWidth - 0.8f) * unit, 0.9f * ImGui::GetIO().DisplaySize.x);
    ImGui::SetNextWindowPos(ImVec2(0.4f * unit, 0.4f * unit), ImGuiCond_FirstUseEver);
    ImGui::SetNextWindowSize(ImVec2(width, 0.48f * height), ImGuiCond_FirstUseEver);
    if (ImGui::Begin("Simulation")) {
        drawFirstHint();
        livePanel.draw(*pair);
        if (ImGui::CollapsingHeader("Picture")) drawPicturePanel();
        if (ImGui::CollapsingHeader("Scene")) follow(scenePanel.draw(*pair->first().scene(), recent));
    }
    ImGui::End();
    ImGui::SetNextWindowPos(ImVec2(0.4f * unit, 0.5f * height), ImGuiCond_FirstUseEver);
    ImGui::SetNextWindowSize(ImVec2(width, 0.48f * height), ImGuiCond_FirstUseEver);
    if (ImGui::Begin("Settings")) drawSettings();
    ImGui::End();
    probePanel.draw(*pair);
}

void Viewer::Inner::drawPicturePanel()
{
    if (ImGui::Button("Show all")) frameAll();
    if (ImGui::IsItemHovered()) ImGui::SetTooltip("F");
    ImGui::SameLine();
    if (ImGui::Button("Camera of the file")) camera.reset();
    if (ImGui::IsItemHovered()) ImGui::SetTooltip("C");
    if (lookPanel->draw()) showRequested();
}

void Viewer::Inner::drawSettings()
{
    if (pair->sides().size() > 1) {
        int side = static_cast<int>(tuned);
        ImGui::RadioButton("A", &side, 0);
        ImGui::SameLine();
        ImGui::RadioButton("B", &side, 1);
        tuned = static_cast<std::size_t>(side);
    }
    parameterPanel.draw(tunedSide().live);
}

}  // namespace app
