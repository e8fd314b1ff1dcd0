#include "sim/scene/overrides.h"

#include "sim/scene/old_keys.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>

namespace sim {

namespace {

std::vector<std::string> splitPath(const std::string& path)
{
    std::vector<std::string> parts(1);
    for (const char c : path) {
        if (c == '.') {
            parts.emplace_back();
        } else {
            parts.back() += c;
        }
    }
    return parts;
}

std::string nameOf(const Node& element)
{
    const Node* name = element.find("name");
    return name && name->isScalar() ? name->text : "";
}

/// The element of a list that is named so, or has that number.
Node& elementOf(Node& list, const std::string& part, const std::string& before, const Override& change)
{
    for (Node& element : list.items) {
        if (nameOf(element) == part) return element;
    }
    std::size_t index = list.items.size();
    const auto [end, error] = std::from_chars(part.data(), part.data() + part.size(), index);
    const bool isNumber = error == std::errc() && end == part.data() + part.size();
    if (isNumber && index < list.items.size()) return list.items[index];

    std::vector<std::string> names;
    for (const Node& element : list.items) {
        if (!nameOf(element).empty()) names.push_back(nameOf(element));
    }
    if (isNumber || names.empty()) {
        fail(change.value.location, fmt::format("{} has no element {}; it has {}, counted from 0", before, inQuotes(part), list.items.size()));
    }
    fail(change.value.location, fmt::format("{} has no element {}{}", before, inQuotes(part), suggestion(part, names)));
}

/// The key a single word stands for in place of a whole map; "" where there is no short form.
std::string shortFormKey(const std::vector<std::string>& path)
{
    if (path.size() == 1 && path[0] == "transfer") return "method";
    if (path.size() == 4 && path[0] == "liquid" && path[1] == "sources" && path[3] == "fill") return "pattern";
    return "";
}

Node wrapped(const Node& value, const std::string& key)
{
    Node map = Node::map(value.location);
    map.keys.push_back(key);
    map.items.push_back(value);
    return map;
}

bool isPhase(const std::string& key) { return key == "liquid" || key == "fabric"; }

/// One value there stands for both phases.
bool isOfBothPhases(const std::string& path) { return path == "transfer.method" || path == "transfer.modes" || path == "transfer.xi"; }

Node perPhase(const Node& value)
{
    Node map = Node::map(value.location);
    map.keys = {"liquid", "fabric"};
    map.items = {value, value};
    return map;
}

/// transfer: {liquid: polypic, fabric: apic} speaks of the method too.
bool isPerPhase(const Node& value) { return value.isMap() && !value.keys.empty() && std::all_of(value.keys.begin(), value.keys.end(), isPhase); }

Node longForm(const Node& value, const std::vector<std::string>& path)
{
    const std::string key = shortFormKey(path);
    if (key.empty()) return value;
    if (value.isScalar() || (key == "method" && isPerPhase(value))) return wrapped(value, key);
    return value;
}

}  // namespace

void checkPath(const std::string& path, const SourceLocation& location)
{
    bool isPath = path.find('=') == std::string::npos;
    for (const std::string& part : splitPath(path)) isPath = isPath && !part.empty();
    if (!isPath) fail(location, fmt::format("{} is no path of keys; write key.key, like transfer.method", inQuotes(path)));
}

Override parseOverride(const std::string& text, bool isSi, std::vector<std::string>* notes)
{
    auto source = std::make_shared<TextSource>();
    source->name = fmt::format("--set {}", text);
    source->numbered = false;
    source->isSi = isSi;
    const SourceLocation location{source, 1};
    const std::size_t equals = text.find('=');
    if (equals == std::string::npos || equals == 0) fail(location, "an override reads key.key=value, like transfer.method=apic");
    Node value = parseYaml(text.substr(equals + 1), source);
    if (value.isNull()) fail(location, "no value after the = sign");
    Node set = Node::map(location);
    set.at(text.substr(0, equals), location) = std::move(value);
    std::vector<std::string> unheard;
    renameOldKeys(set, notes ? *notes : unheard);
    return {set.keys.front(), std::move(set.items.front())};
}

void mergeOver(Node& base, const Node& over)
{
    if (!base.isMap() || !over.isMap()) {
        base = over;
        return;
    }
    for (std::size_t i = 0; i < over.keys.size(); ++i) {
        if (Node* there = base.find(over.keys[i])) {
            mergeOver(*there, over.items[i]);
        } else {
            base.keys.push_back(over.keys[i]);
            base.items.push_back(over.items[i]);
        }
    }
}

void apply(const Override& change, Node& root)
{
    const SourceLocation& location = change.value.location;
    checkPath(change.path, location);
    const std::vector<std::string> path = splitPath(change.path);
    Node* node = &root;
    std::string before;
    for (const std::string& part : path) {
        if (node->isList()) {
            node = &elementOf(*node, part, before, change);
        } else if (node->isMap()) {
            node = &node->at(part, location);
        } else if (node->isNull()) {
            *node = Node::map(location);
            node = &node->at(part, location);
        } else if (isOfBothPhases(before) && isPhase(part)) {
            *node = perPhase(*node);
            node = node->find(part);
        } else {
            fail(location, fmt::format("{} is {}, it has no key {}", before, node->called(), inQuotes(part)));
        }
        before = joinPath(before, part);
    }
    mergeOver(*node, longForm(change.value, path));
}

void expandShortForms(Node& root)
{
    if (Node* transfer = root.find("transfer")) *transfer = longForm(*transfer, {"transfer"});
    Node* liquid = root.find("liquid");
    Node* sources = liquid ? liquid->find("sources") : nullptr;
    if (!sources) return;
    for (Node& source : sources->items) {
        if (Node* fill = source.find("fill")) *fill = longForm(*fill, {"liquid", "sources", "", "fill"});
    }
}

std::vector<Override> overridesOf(const Node& map, const std::vector<std::string>& except)
{
    std::vector<Override> changes;
    for (std::size_t i = 0; i < map.keys.size(); ++i) {
        if (std::find(except.begin(), except.end(), map.keys[i]) != except.end()) continue;
        checkPath(map.keys[i], map.items[i].location);
        changes.push_back({map.keys[i], map.items[i]});
    }
    return changes;
}

}  // namespace sim
