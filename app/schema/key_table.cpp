#include "app/schema/key_table.h"

#include "app/schema/key_schema.h"
#include "app/schema/schema.h"

#include <fmt/format.h>

#include <algorithm>
#include <regex>
#include <vector>

namespace app {

namespace {

/// "Edge of a cell [cm], above 0" in its parts.
struct Description {
    std::string help, unit, range;
};

Description partsOf(const SchemaJson& schema)
{
    static const std::string n = "-?[0-9][0-9.e+-]*", unit = R"((?:(?:^| )\[([A-Za-z1][A-Za-z0-9/^ ]*)\])?)";
    static const std::regex form("^(.*?)" + unit + "((?:, above " + n + "(?:, (?:below|at most) " + n + ")?|, at (?:least|most) " + n + "|, " + n +
                                 " to " + n + ")?)$");
    Description parts;
    if (!schema.contains("description")) return parts;
    const std::string text = schema["description"].get<std::string>();
    if (std::smatch match; std::regex_match(text, match, form)) parts = {match[1], match[2], match[3]};
    else parts.help = text;
    return parts;
}

/// Numbers with bounds and without, which come with a text for their unit.
bool isNumber(const SchemaJson& schema)
{
    return schema.contains("anyOf") && schema["anyOf"].size() == 2 && schema["anyOf"][0].value("type", SchemaJson()) == "number";
}

/// Numbers as they were meant, whatever the precision in which they are kept.
std::string textOf(const SchemaJson& value)
{
    if (value.is_number_float()) return fmt::format("{:.6g}", value.get<double>());
    if (!value.is_array()) return value.is_string() ? value.get<std::string>() : value.dump();
    std::vector<std::string> all;
    for (const SchemaJson& one : value) all.push_back(textOf(one));
    return fmt::format("[{}]", fmt::join(all, ", "));
}

std::string code(const SchemaJson& value) { return fmt::format("`{}`", textOf(value)); }

std::string joined(const std::vector<std::string>& all, const char* between) { return fmt::format("{}", fmt::join(all, between)); }

/// "integer, 1 to 27".
std::string integerKind(const SchemaJson& schema)
{
    const bool hasLow = schema.contains("minimum"), hasHigh = schema.contains("maximum");
    if (hasLow && hasHigh) return fmt::format("integer, {} to {}", schema["minimum"].dump(), schema["maximum"].dump());
    return hasLow ? fmt::format("integer, at least {}", schema["minimum"].dump()) : "integer";
}

/// What a value of this schema is, in words.
std::string kindOf(const SchemaJson& schema, const std::string& unit)
{
    const std::string inUnit = unit.empty() ? "" : fmt::format(" [{}]", unit);
    if (isNumber(schema)) return "number" + inUnit;
    if (schema.contains("$ref")) {
        const std::string name = schema["$ref"].get<std::string>().substr(std::string("#/definitions/").size());
        return fmt::format("[{0}](#{0})", name);
    }
    if (schema.contains("const")) return code(schema["const"]);
    if (schema.contains("enum")) {
        std::vector<std::string> words;
        for (const SchemaJson& word : schema["enum"]) words.push_back(code(word));
        return joined(words, ", ");
    }
    if (schema.contains("anyOf") && !schema.contains("properties")) {
        std::vector<std::string> ways;
        for (const SchemaJson& way : schema["anyOf"])
            if (const std::string kind = kindOf(way, unit); std::ranges::find(ways, kind) == ways.end()) ways.push_back(kind);
        return joined(ways, " or ");
    }
    if (schema.contains("format")) return schema["format"].get<std::string>() + inUnit;
    const SchemaJson type = schema.value("type", SchemaJson());
    if (type == "integer") return integerKind(schema);
    if (type == "number") return "number" + inUnit;
    if (type == "boolean") return "`true`, `false`";
    if (type == "array" && schema.contains("items")) {
        const bool isFixed = schema.contains("maxItems");
        const std::string of = kindOf(schema["items"], unit);
        return isFixed ? fmt::format("list of {}: {}", schema["maxItems"].dump(), of) : of.empty() ? "list" : "list of " + of;
    }
    if (type == "object") {
        if (schema.contains("properties")) return "map";
        const bool isNamed = schema.contains("additionalProperties") && schema["additionalProperties"].is_object();
        const std::string of = isNamed ? kindOf(schema["additionalProperties"], unit) : "";
        return of.empty() ? "map of keys of a scene to values" : "map of names, each a " + of;
    }
    return type.is_null() ? "" : "text";
}

void addRows(const SchemaJson& schema, const std::string& path, std::string& out);

void addRow(const SchemaJson& schema, const std::string& path, bool isNeeded, std::string& out)
{
    const Description parts = partsOf(schema);
    const std::string value = schema.contains("default") ? code(schema["default"]) : isNeeded ? "needed" : "";
    const auto inTable = [](const std::string& text) { return std::regex_replace(text, std::regex(R"(\|)"), "\\|"); };
    out += fmt::format("| `{}` | {}{} | {} | {} |\n", path, inTable(kindOf(schema, parts.unit)), parts.range, inTable(value), inTable(parts.help));
}

/// The keys of a map, or of what is one of several ways to write a value, or of what a list or a map of names holds.
void addRows(const SchemaJson& schema, const std::string& path, std::string& out)
{
    const std::string before = path.empty() ? "" : path + ".";
    if (schema.contains("properties")) {
        const SchemaJson required = schema.value("required", SchemaJson::array());
        for (const auto& [name, below] : schema["properties"].items()) {
            addRow(below, before + name, std::find(required.begin(), required.end(), name) != required.end(), out);
            addRows(below, before + name, out);
        }
        return;
    }
    if (schema.contains("anyOf"))
        for (const SchemaJson& way : schema["anyOf"]) addRows(way, path, out);
    if (schema.contains("items") && schema["items"].is_object()) addRows(schema["items"], path + "[]", out);
    if (schema.contains("additionalProperties") && schema["additionalProperties"].is_object())
        addRows(schema["additionalProperties"], before + "NAME", out);
}

std::string table(const std::string& name, const SchemaJson& schema, const std::string& path)
{
    std::string rows;
    addRows(schema, path, rows);
    const std::string about = partsOf(schema).help;
    const std::string what = about.empty() ? "" : about + ".\n\n";
    if (rows.empty()) return fmt::format("### {}\n\n{}{}\n\n", name, what, kindOf(schema, ""));
    return fmt::format("### {}\n\n{}| key | value | if left out | what it does |\n|---|---|---|---|\n{}\n", name, what, rows);
}

}  // namespace

std::string keyTables()
{
    const SchemaJson schema = SchemaJson::parse(sceneSchema());
    SchemaJson single = {{"properties", SchemaJson::object()}};  // keys without others below them
    std::string sections;
    for (const auto& [name, section] : schema["properties"].items()) {
        std::string rows;
        addRows(section, name, rows);
        if (rows.empty()) single["properties"][name] = section;
        else sections += table(name, section, name);
    }
    std::string out = table("top", single, "") + sections;
    for (const auto& [name, definition] : schema["definitions"].items()) out += table(name, definition, "");
    out.pop_back();  // tables end with an empty line
    return out;
}

}  // namespace app
