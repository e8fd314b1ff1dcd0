#include "sim/scene/old_keys.h"

#include "sim/renamed.h"
#include "sim/scene/units.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>

namespace sim {

namespace {

/// The row of a key, or of a section that it stands in.
const Renamed* rowOf(std::string_view path)
{
    const auto row = std::ranges::find_if(renamedKeys(), [&](const Renamed& r) {
        return path.starts_with(r.before) && (path.size() == r.before.size() || path[r.before.size()] == '.');
    });
    return row == renamedKeys().end() ? nullptr : &*row;
}

/// Is this a section, or a section of sections, in which a key was renamed?
bool leadsToOldKeys(const std::string& path)
{
    return std::ranges::any_of(renamedKeys(), [&](const Renamed& r) { return r.before.starts_with(path + '.'); });
}

/// Writes 1 - x for every number x; other texts stay, for the reader to refuse.
void takeComplements(Node& node)
{
    for (Node& item : node.items) takeComplements(item);
    if (!node.isScalar()) return;
    const ParsedNumber number = parseNumber(node.text, Quantity::None, false);
    if (number.problem.empty()) node.text = lostText(number.value);
}

void renameOne(Node& map, std::size_t i, const std::string& path, const std::string& full, const Renamed& row, std::vector<std::string>& notes)
{
    const std::string now = std::string(row.now) + full.substr(row.before.size());
    const std::string key = path.empty() ? now : now.substr(path.size() + 1);
    const SourceLocation location = map.items[i].location;
    if (map.find(key)) fail(location, fmt::format("{} is called {} now, which stands beside it; remove one of them", full, now));
    notes.push_back(
        fmt::format("{}: {} is called {} now{}", location.text(), full, now, row.isComplement ? ", and says what is lost, 1 less what is kept" : ""));
    map.keys[i] = key;
    if (row.isComplement) takeComplements(map.items[i]);
}

/// @param path  of the node in a scene: "" also for what holds keys of a scene, as variants do
void renameBelow(Node& node, const std::string& path, std::vector<std::string>& notes)
{
    if (node.isList())
        for (Node& item : node.items) renameBelow(item, path, notes);
    if (!node.isMap()) return;
    for (std::size_t i = 0; i < node.keys.size(); ++i) {
        const std::string full = joinPath(path, node.keys[i]);
        if (const Renamed* row = rowOf(full)) renameOne(node, i, path, full, *row, notes);
        else renameBelow(node.items[i], leadsToOldKeys(full) ? full : "", notes);
    }
}

}  // namespace

void renameOldKeys(Node& root, std::vector<std::string>& notes) { renameBelow(root, "", notes); }

std::string lostText(double kept)
{
    const double lost = 1.0 - kept;
    constexpr int kMostDigits = 17;
    for (int digits = 1; digits <= kMostDigits; ++digits) {
        const std::string text = fmt::format("{:.{}g}", lost, digits);
        if (1.0 - std::strtod(text.c_str(), nullptr) == kept) return text;
    }
    return fmt::format("{}", lost);
}

}  // namespace sim
