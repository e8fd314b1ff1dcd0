#include "sim/scene/read_changes.h"

#include "sim/scene/overrides.h"
#include "sim/scene/parameters.h"
#include "sim/scene/read_list.h"
#include "sim/scene/section_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

namespace sim {

namespace {

constexpr std::size_t kMostChanges = 10'000;  // each is read as a whole scene's settings are

bool isBelow(const std::string& path, const std::string& section)
{
    return path == section || (path.starts_with(section) && path[section.size()] == '.');
}

/// Refuses what is no plain setting: it is built at the start, and a change would do nothing.
void requireSettings(const std::string& path, const Node& value, const std::vector<Parameter>& parameters)
{
    if (value.isMap()) {
        for (std::size_t i = 0; i < value.keys.size(); ++i) requireSettings(joinPath(path, value.keys[i]), value.items[i], parameters);
        return;
    }
    const bool isSetting = path == "liquid.preset" ||
                           std::ranges::any_of(parameters, [&](const Parameter& p) { return isBelow(p.path, path) || isBelow(path, p.path); });
    if (!isSetting)
        fail(value.location, fmt::format("changes: {} cannot change during a run; only settings of time, transfer, liquid, "
                                         "coupling, fabric, materials, solver and gravity can",
                                         path));
}

/// Refuses settings that hold for a whole run.
void requireUnchanged(const SourceLocation& location, const std::vector<Parameter>& before, const std::vector<Parameter>& after)
{
    for (std::size_t i = 0; i < std::min(before.size(), after.size()); ++i)
        if (before[i].isFixed && before[i].path == after[i].path && before[i].value != after[i].value)
            fail(location, fmt::format("changes: {} holds for a whole run; give it its value at the start", before[i].path));
}

const std::vector<NamedMaterial>& materialsBefore(const Scene& scene, std::size_t i)
{
    return i == 0 ? scene.materials : scene.changes[i - 1].materials;
}

const Settings& settingsBefore(const Scene& scene, std::size_t i) { return i == 0 ? scene.settings : scene.changes[i - 1].settings; }

}  // namespace

std::vector<SettingsChange> readChanges(const Node& root, const Scene& scene)
{
    std::vector<SettingsChange> changes;
    const Node* list = listAt(&root, "changes", "changes", "- {step: 100, set: {time.dt: 1.0e-3}}");
    if (!list) return changes;
    if (list->items.size() > kMostChanges)
        fail(list->location, fmt::format("changes: {} are too many; at most {} are possible", list->items.size(), kMostChanges));
    Node changed = root;
    const std::vector<Parameter> atStart = parametersOf(scene.settings, scene.materials);
    for (std::size_t i = 0; i < list->items.size(); ++i) {
        const Node& item = list->items[i];
        const std::string path = fmt::format("changes.{}", i);
        int step = 0;
        SectionReader::read(&item, path, [&](auto& v) {
            v.required("step", "the first step with what is set, like step: 100");
            v.integer("step", step, 1, std::numeric_limits<int>::max(), "");
            v.required("set", "what holds from then on, like set: {time.dt: 1.0e-3}");
            v.other("set", "");
        });
        if (i > 0 && step < changes.back().step)
            fail(item.location, fmt::format("{}.step: {} comes after step {}; write changes in their order", path, step, changes.back().step));
        const Node& set = *item.find("set");
        if (!set.isMap()) fail(set.location, fmt::format("{}.set: needs a map like {{time.dt: 1.0e-3}}, not {}", path, set.called()));
        for (const Override& change : overridesOf(set, {})) {
            requireSettings(change.path, change.value, atStart);
            apply(change, changed);
        }
        SettingsChange& next = changes.emplace_back();
        next.step = step;
        readSettings(changed, next.settings, next.materials);
        requireUnchanged(item.location, atStart, parametersOf(next.settings, next.materials));
    }
    return changes;
}

std::vector<std::string> changedSettings(const Scene& scene, std::size_t i)
{
    const std::vector<Parameter> before = parametersOf(settingsBefore(scene, i), materialsBefore(scene, i)),
                                 after = parametersOf(scene.changes[i].settings, scene.changes[i].materials);
    std::vector<std::string> sets;
    for (std::size_t p = 0; p < std::min(before.size(), after.size()); ++p)
        if (before[p].path == after[p].path && before[p].value != after[p].value && !after[p].value.empty())
            sets.push_back(overrideText(after[p], after[p].value));
    return sets;
}

std::string changeText(std::int64_t step, const std::vector<std::string>& sets)
{
    std::string all;
    for (const std::string& set : sets) {
        const std::size_t equals = set.find('=');
        all += fmt::format("{}{}: {}", all.empty() ? "" : ", ", set.substr(0, equals), set.substr(equals + 1));
    }
    return fmt::format("{{step: {}, set: {{{}}}}}", step, all);
}

}  // namespace sim
