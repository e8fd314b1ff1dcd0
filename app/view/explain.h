#pragma once

#include "sim/scene/parameters.h"

#include <imgui.h>

#include <string>

namespace app {

/// Colour of what a restart waits for.
inline const ImVec4 kWaits(1.0f, 0.8f, 0.3f, 1.0f);

/// " [cm]", or nothing for plain numbers.
std::string inBrackets(const std::string& unit);

/// Path, unit, range and help of a setting, while the pointer is on the widget that was drawn last.
void explain(const sim::Parameter& parameter);

/// What a widget without a setting is for.
void explain(const char* help);

}  // namespace app
