#include "app/view/parameter_panel.h"

#include "app/view/explain.h"
#include "sim/scene/describe.h"

#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <cfloat>
#include <string_view>

namespace app {

namespace {

const ImVec4 kComplaint(1.0f, 0.45f, 0.35f, 1.0f);

std::string groupOf(const std::string& path) { return path.substr(0, path.find('.')); }

/// Has the scene anything that these settings are about?
bool applies(const sim::Parameter& parameter, const SceneContents& contents)
{
    const std::string group = groupOf(parameter.path);
    const bool isOfFabric = group == "fabric" || group == "materials" || group == "porous" || parameter.path.find("fabric") != std::string::npos;
    const bool isOfBoth = group == "coupling";
    const bool isOfLiquid = group == "liquid" || group == "solver" || group == "transfer";
    if (isOfBoth) return contents.liquid && contents.fabric();
    return isOfFabric ? contents.fabric() : !isOfLiquid || contents.liquid;
}

/// What stands behind its value, under the heading of its group.
std::string labelOf(const sim::Parameter& parameter)
{
    const std::string name = parameter.path.substr(std::min(parameter.path.size(), groupOf(parameter.path).size() + 1));
    return (name.empty() ? parameter.path : name) + inBrackets(parameter.unit);
}

}  // namespace

std::optional<std::array<float, 2>> ParameterPanel::placeOf(const std::string& path) const
{
    const auto place = places_.find(path);
    return place == places_.end() ? std::nullopt : std::optional(place->second);
}

void ParameterPanel::draw(LiveSimulation& live)
{
    const auto scene = live.scene();
    const std::string refused = live.status().refused;
    if (!refused.empty()) {
        ImGui::PushTextWrapPos(0.0f);
        ImGui::TextColored(kComplaint, "%s", refused.c_str());
        ImGui::PopTextWrapPos();
    }
    drawWaiting(live, *scene);
    ImGui::SetNextItemWidth(-FLT_MIN);
    ImGui::InputTextWithHint("##find", "find a setting", wanted_.data(), wanted_.size());
    places_.clear();
    drawGroups(live, *scene);
}

void ParameterPanel::drawWaiting(LiveSimulation& live, const LiveScene& scene) const
{
    if (scene.waiting.empty()) return;
    for (const std::string& set : scene.waiting) ImGui::TextColored(kWaits, "%s", set.c_str());
    if (ImGui::Button("Restart with these")) live.restart();
}

void ParameterPanel::drawGroups(LiveSimulation& live, const LiveScene& scene)
{
    const std::string_view wanted = wanted_.data();
    std::string group;
    bool isOpen = false;
    for (const sim::Parameter& parameter : scene.parameters) {
        if (!applies(parameter, scene.setup.pictures.contents)) continue;
        if (!wanted.empty()) {
            if (parameter.path.find(wanted) != std::string::npos) drawParameter(live, parameter);
            continue;
        }
        if (groupOf(parameter.path) != group) {
            group = groupOf(parameter.path);
            isOpen = ImGui::CollapsingHeader(group.c_str(), group == "time" ? ImGuiTreeNodeFlags_DefaultOpen : 0);
            if (isOpen && group == "liquid") drawPresets(live);
        }
        if (isOpen) drawParameter(live, parameter);
    }
}

void ParameterPanel::drawPresets(LiveSimulation& live) const
{
    ImGui::SetNextItemWidth(0.5f * ImGui::GetContentRegionAvail().x);
    if (!ImGui::BeginCombo("like", "...")) return;
    for (const sim::LiquidPreset& preset : sim::liquidPresets()) {
        if (!ImGui::Selectable(preset.name)) continue;
        live.change({fmt::format("liquid.density={} g/cm^3", preset.density), fmt::format("liquid.viscosity={} P", preset.viscosity),
                     fmt::format("liquid.surface_tension={} dyn/cm", preset.surfaceTension)});
    }
    ImGui::EndCombo();
}

void ParameterPanel::drawParameter(LiveSimulation& live, const sim::Parameter& parameter)
{
    using Kind = sim::Parameter::Kind;
    const auto change = [&](const std::string& value) { live.change({sim::overrideText(parameter, value)}); };
    ImGui::PushID(parameter.path.c_str());
    const std::string label = labelOf(parameter);
    const float all = ImGui::GetContentRegionAvail().x, left = all - ImGui::CalcTextSize(label.c_str()).x - ImGui::GetStyle().ItemSpacing.x;
    ImGui::SetNextItemWidth(std::clamp(left, 0.2f * all, 0.45f * all));
    if (parameter.kind == Kind::Flag) {
        bool isOn = parameter.value == "true";
        if (ImGui::Checkbox("##value", &isOn)) change(isOn ? "true" : "false");
    } else if (parameter.kind == Kind::Word) {
        if (ImGui::BeginCombo("##value", parameter.value.c_str())) {
            for (const std::string& word : parameter.words)
                if (ImGui::Selectable(word.c_str(), word == parameter.value)) change(word);
            ImGui::EndCombo();
        }
    } else {
        drawText(live, parameter);
    }
    const ImVec2 low = ImGui::GetItemRectMin(), high = ImGui::GetItemRectMax();
    if (ImGui::IsItemVisible()) places_[parameter.path] = {0.5f * (low.x + high.x), 0.5f * (low.y + high.y)};
    explain(parameter);
    ImGui::SameLine();
    if (parameter.isFixed) ImGui::TextDisabled("%s", label.c_str());
    else ImGui::TextUnformatted(label.c_str());
    explain(parameter);
    ImGui::PopID();
}

/// A value counts when it is entered or left, not while it is typed.
void ParameterPanel::drawText(LiveSimulation& live, const sim::Parameter& parameter)
{
    std::array<char, 128> text{};
    parameter.value.copy(text.data(), text.size() - 1);
    if (ImGui::InputTextWithHint("##value", "left out", text.data(), text.size(), ImGuiInputTextFlags_AutoSelectAll)) entered_ = text.data();
    if (!ImGui::IsItemDeactivatedAfterEdit() || entered_ == parameter.value || entered_.empty()) return;
    live.change({sim::overrideText(parameter, entered_)});
}

}  // namespace app
