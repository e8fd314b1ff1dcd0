#pragma once

#include "app/scene/picture_settings.h"
#include "sim/scene/parameters.h"

#include <optional>
#include <string>
#include <vector>

namespace app {

/// Every setting of `render`, with unit and help, in the order of the declarations; those that go only with others, like the range of a colour that
/// shows a speed, where those others are so.
std::vector<sim::Parameter> pictureParametersOf(const RenderSettings& settings);

/// The one with this path, "render.liquid.range"; nothing where it does not go with the others.
std::optional<sim::Parameter> pictureParameter(const RenderSettings& settings, const std::string& path);

}  // namespace app
