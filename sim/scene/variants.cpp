#include "sim/scene/variants.h"

#include <fmt/format.h>

#include <algorithm>

namespace sim {

namespace {

constexpr std::size_t kMaxVariants = 1000;  // a product of lists grows fast

std::string textOf(const Node& element, const char* key)
{
    const Node* node = element.find(key);
    if (!node) return "";
    if (!node->isScalar() || node->text.empty()) fail(node->location, fmt::format("a variant's {} must be a word, not {}", key, node->called()));
    return node->text;
}

SceneVariant listedVariant(const Node& element)
{
    if (!element.isMap())
        fail(element.location, fmt::format("a variant is a map like {{label: APIC, transfer.method: apic}}, not {}", element.called()));
    SceneVariant variant{textOf(element, "name"), textOf(element, "label"), overridesOf(element, {"name", "label"})};
    if (variant.name.empty() && variant.label.empty()) fail(element.location, "a variant needs a label, like label: APIC");
    if (variant.name.empty()) variant.name = asName(variant.label);
    if (variant.label.empty()) variant.label = variant.name;
    return variant;
}

void checkNames(const std::vector<SceneVariant>& variants, const Node& list)
{
    for (std::size_t i = 0; i < variants.size(); ++i) {
        const SourceLocation& location = list.isList() ? list.items[i].location : list.location;
        const std::string& name = variants[i].name;
        if (name != asName(name))
            fail(location, fmt::format("variant name {} may have a-z, 0-9 and _ only; {} would do", inQuotes(name), asName(name)));
        if (name == "default") fail(location, "a variant cannot be named default: that is the scene without a variant");
        for (std::size_t k = 0; k < i; ++k) {
            if (variants[k].name == name) fail(location, fmt::format("two variants are named {}; give one of them another name", inQuotes(name)));
        }
    }
}

std::string label(const Node& value) { return value.isScalar() ? value.text : value.flow(); }

std::vector<SceneVariant> product(const Node& map, const std::string& path)
{
    std::vector<SceneVariant> all(1);
    for (std::size_t k = 0; k < map.keys.size(); ++k) {
        const Node& values = map.items[k];
        checkPath(map.keys[k], values.location);
        if (map.keys[k] == "name" || map.keys[k] == "label")
            fail(values.location, fmt::format("compare.variants.{} is no key of a scene; write one like transfer.method", map.keys[k]));
        if (!values.isList() || values.items.empty()) {
            fail(values.location, fmt::format("compare.variants.{} must be a list of values to try, not {}", map.keys[k], values.called()));
        }
        if (all.size() * values.items.size() > kMaxVariants) fail(values.location, fmt::format("more than {} variants", kMaxVariants));
        std::vector<SceneVariant> next;
        for (const SceneVariant& base : all) {
            for (const Node& value : values.items) {
                if (value.isNull() || label(value).empty()) fail(value.location, fmt::format("{}.{} has an empty value", path, map.keys[k]));
                SceneVariant& variant = next.emplace_back(base);
                if (!base.name.empty()) variant.name += '_';
                variant.name += asName(label(value));
                if (!base.label.empty()) variant.label += ", ";
                variant.label += label(value);
                variant.overrides.push_back({map.keys[k], value});
            }
        }
        all = std::move(next);
    }
    return all;
}

}  // namespace

std::string asName(const std::string& label)
{
    std::string name;
    for (const char c : label) {
        const bool isDigit = c >= '0' && c <= '9', isLower = c >= 'a' && c <= 'z', isUpper = c >= 'A' && c <= 'Z';
        const bool continuesCharacter = (static_cast<unsigned char>(c) & 0xC0) == 0x80;
        if (isDigit || isLower) name += c;
        if (isUpper) name += static_cast<char>(c - 'A' + 'a');
        if (!isDigit && !isLower && !isUpper && !continuesCharacter) name += '_';
    }
    return name;
}

std::vector<SceneVariant> readVariants(const Node& root)
{
    const Node* compare = root.find("compare");
    const Node* variants = compare ? compare->find("variants") : nullptr;
    return variants ? listedVariants(*variants, "compare.variants") : std::vector<SceneVariant>();
}

std::vector<SceneVariant> listedVariants(const Node& variants, const std::string& path)
{
    if (variants.isScalar() || variants.isNull() || variants.items.empty())
        fail(variants.location, fmt::format("{} must list variants, or map keys to lists of values, not {}", path, variants.called()));
    if (variants.items.size() > kMaxVariants) fail(variants.location, fmt::format("more than {} variants", kMaxVariants));
    std::vector<SceneVariant> all;
    if (variants.isMap()) {
        all = product(variants, path);
    } else {
        for (const Node& element : variants.items) all.push_back(listedVariant(element));
    }
    checkNames(all, variants);
    return all;
}

const SceneVariant& findVariant(const std::vector<SceneVariant>& variants, const std::string& name, const std::string& file)
{
    std::vector<std::string> names;
    for (const SceneVariant& variant : variants) {
        if (variant.name == name) return variant;
        names.push_back(variant.name);
    }
    if (names.empty()) fail(file, fmt::format("no variant {}: the scene has none", inQuotes(name)));
    fail(file, fmt::format("no variant {}; there is {}", inQuotes(name), listed(names)));
}

}  // namespace sim
