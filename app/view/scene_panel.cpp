#include "app/view/scene_panel.h"

#include <imgui.h>

namespace app {

SceneCommands ScenePanel::draw(const LiveScene& scene, const RecentFiles& recent) const
{
    SceneCommands commands;
    commands.save = ImGui::Button("Save as YAML");
    if (ImGui::IsItemHovered()) ImGui::SetTooltip("control S: a scene whose run repeats what was done here");
    ImGui::SameLine();
    commands.copyCommand = ImGui::Button("Copy command line");
    if (ImGui::IsItemHovered()) ImGui::SetTooltip("control C: the same as a command");
    commands.picture = ImGui::Button("Picture");
    if (ImGui::IsItemHovered()) ImGui::SetTooltip("P");
    ImGui::SameLine();
    bool records = isRecording;
    if (ImGui::Checkbox("record frames", &records)) commands.record = records;

    const auto& variants = scene.setup.pictures.compare.variants;
    if (!variants.empty() && ImGui::BeginCombo("beside", beside.empty() ? "nothing" : beside.c_str())) {
        if (ImGui::Selectable("nothing", beside.empty())) commands.beside = "";
        for (const Variant& variant : variants)
            if (ImGui::Selectable(variant.name.c_str(), variant.name == beside)) commands.beside = variant.name;
        ImGui::EndCombo();
    }
    if (!recent.files().empty() && ImGui::BeginCombo("open", "a recent scene, or drop a file")) {
        for (const std::string& file : recent.files())
            if (ImGui::Selectable(file.c_str())) commands.open = file;
        ImGui::EndCombo();
    }
    if (!message.empty()) ImGui::TextWrapped("%s", message.c_str());
    return commands;
}

}  // namespace app
