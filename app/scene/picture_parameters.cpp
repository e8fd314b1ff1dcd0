#include "app/scene/picture_parameters.h"

#include "app/scene/describe_picture.h"
#include "sim/scene/parameter_list.h"

#include <algorithm>

namespace app {

std::vector<sim::Parameter> pictureParametersOf(const RenderSettings& settings)
{
    std::vector<sim::Parameter> all;
    RenderSettings values = settings;
    sim::ParameterList render(all, "render");
    visitFields(render, values);
    return all;
}

std::optional<sim::Parameter> pictureParameter(const RenderSettings& settings, const std::string& path)
{
    const std::vector<sim::Parameter> all = pictureParametersOf(settings);
    const auto found = std::ranges::find(all, path, &sim::Parameter::path);
    return found == all.end() ? std::nullopt : std::optional(*found);
}

}  // namespace app
