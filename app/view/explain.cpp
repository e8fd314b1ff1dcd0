#include "app/view/explain.h"

namespace app {

std::string inBrackets(const std::string& unit) { return unit.empty() ? "" : " [" + unit + "]"; }

void explain(const sim::Parameter& parameter)
{
    if (!ImGui::IsItemHovered()) return;
    const std::string range = parameter.range.text(parameter.unit);
    ImGui::BeginTooltip();
    ImGui::PushTextWrapPos(26.0f * ImGui::GetFontSize());
    ImGui::TextUnformatted((parameter.path + inBrackets(parameter.unit)).c_str());
    if (!range.empty()) ImGui::TextDisabled("%s", range.c_str());
    ImGui::TextUnformatted(parameter.help.c_str());
    if (parameter.isFixed) ImGui::TextColored(kWaits, "holds for a whole run: a change waits for a restart");
    ImGui::PopTextWrapPos();
    ImGui::EndTooltip();
}

void explain(const char* help)
{
    if (ImGui::IsItemHovered()) ImGui::SetTooltip("%s", help);
}

}  // namespace app
