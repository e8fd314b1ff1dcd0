#include "sim/scene/parameters.h"

#include "sim/scene/describe.h"
#include "sim/scene/describe_fabric.h"
#include "sim/scene/parameter_list.h"
#include "sim/scene/source_location.h"

#include <algorithm>
#include <cctype>

namespace sim {

namespace {

/// Digits and what goes with them, no unit.
bool isBare(const std::string& numbers)
{
    return std::ranges::all_of(numbers, [](unsigned char c) {
        return std::isdigit(c) || std::string_view("+-.eE, []").find(static_cast<char>(c)) != std::string_view::npos;
    });
}

}  // namespace

std::string overrideText(const Parameter& parameter, const std::string& value)
{
    std::string said;
    const bool takesUnit = !parameter.unit.empty() && isBare(value);
    for (const char c : value) {
        if (takesUnit && parameter.kind == Parameter::Kind::Numbers && (c == ',' || c == ']')) said += " " + parameter.unit;
        said += c;
    }
    if (takesUnit && parameter.kind == Parameter::Kind::Number) said += " " + parameter.unit;
    return parameter.path + "=" + said;
}

std::vector<Parameter> parametersOf(const Settings& settings, const std::vector<NamedMaterial>& materials)
{
    std::vector<Parameter> all;
    Settings values = settings;
    ParameterList top(all, "");
    visitFields(top, values);
    ParameterList liquid(all, "liquid");
    visitFields(liquid, values.liquid);
    describeFabric(top, values);
    for (const NamedMaterial& named : materials) {
        FabricMaterial material = named.material;
        ParameterList inner(all, joinPath("materials", named.name));
        visitFields(inner, material);
    }
    return all;
}

}  // namespace sim
