#include "app/scene/changed_scene.h"

#include "sim/core/check.h"
#include "sim/scene/read_changes.h"

#include <algorithm>
#include <limits>

namespace app {

namespace {

std::vector<sim::Parameter> parametersAt(const sim::Scene& scene, std::int64_t step)
{
    const sim::Settings* settings = &scene.settings;
    const std::vector<sim::NamedMaterial>* materials = &scene.materials;
    for (const sim::SettingsChange& change : scene.changes) {
        if (change.step > step + 1) break;
        settings = &change.settings;
        materials = &change.materials;
    }
    return sim::parametersOf(*settings, *materials);
}

std::string keyOf(const std::string& set) { return set.substr(0, set.find('=')); }

/// Adds overrides; plain values replace what was said of their keys before.
void append(std::vector<std::string>& all, const std::vector<std::string>& more)
{
    for (const std::string& set : more) {
        if (set.find('{') == std::string::npos) std::erase_if(all, [&](const std::string& s) { return keyOf(s) == keyOf(set); });
        all.push_back(set);
    }
}

}  // namespace

ChangedScene::ChangedScene(SceneRequest request, Load load) : load_(std::move(load)), start_(std::move(request)) { begin(load_(start_)); }

/// States of one scene are none of another.
void ChangedScene::requireSameFile() const
{
    if (load_(start_).identity != identity_) throw sim::InputError(start_.file + ": was changed since the start; restart to take it as it is now");
}

/// Puts changes in the order of their steps, one for each.
void ChangedScene::tidy(std::vector<Change>& changes)
{
    std::ranges::stable_sort(changes, {}, &Change::step);
    for (std::size_t i = changes.size(); i-- > 1;) {
        Change &first = changes[i - 1], &second = changes[i];
        if (first.step != second.step || first.isOfScene || second.isOfScene) continue;
        append(first.sets, second.sets);
        changes.erase(changes.begin() + static_cast<std::ptrdiff_t>(i));
    }
}

SceneRequest ChangedScene::requestOf(const std::vector<std::string>& sets, const std::vector<Change>& changes) const
{
    SceneRequest request = start_;
    append(request.sets, sets);
    std::string list;
    for (const Change& change : changes) list += (list.empty() ? "" : ", ") + sim::changeText(change.step, change.sets);
    if (!list.empty()) request.sets.push_back("changes=[" + list + "]");
    return request;
}

LiveScene ChangedScene::scene(std::int64_t step) const { return {requestOf({}, changes_), setup_, parametersAt(setup_.scene, step), waiting_}; }

std::int64_t ChangedScene::nextChange(std::int64_t step) const
{
    const auto next = std::ranges::find_if(changes_, [&](const Change& c) { return c.step > step + 1; });
    return next == changes_.end() ? std::numeric_limits<std::int64_t>::max() : next->step;
}

bool ChangedScene::change(const std::vector<std::string>& sets, std::int64_t step)
{
    std::vector<std::string> now, later = waiting_;
    const std::vector<sim::Parameter> parameters = parametersAt(setup_.scene, step);
    for (const std::string& set : sets) {
        const auto parameter = std::ranges::find(parameters, keyOf(set), &sim::Parameter::path);
        const bool canChange = step > 0 && parameter != parameters.end() && !parameter->isFixed;
        append(canChange ? now : later, {set});
    }
    std::vector<Change> changes = changes_;
    if (!now.empty()) changes.push_back({step + 1, now, false});
    tidy(changes);
    requireSameFile();
    if (!now.empty()) load_(requestOf(sets, {}));  // complains about values, not about a list of changes
    LoadedScene all = load_(requestOf(later, changes));
    setup_ = later.empty() || step == 0 ? std::move(all) : load_(requestOf({}, changes));
    changes_ = std::move(changes);
    if (step == 0) append(start_.sets, later);
    waiting_ = step == 0 ? std::vector<std::string>() : std::move(later);
    return step == 0;
}

void ChangedScene::goBackTo(std::int64_t step)
{
    std::vector<Change> changes = changes_;
    for (Change& change : changes)
        if (!change.isOfScene) change.step = std::min(change.step, step + 1);
    tidy(changes);
    requireSameFile();
    setup_ = load_(requestOf({}, changes));
    changes_ = std::move(changes);
}

bool ChangedScene::restart()
{
    std::vector<std::string> sets;
    for (const Change& change : changes_)
        if (!change.isOfScene) append(sets, change.sets);
    append(sets, waiting_);
    LoadedScene setup = load_(requestOf(sets, {}));
    const bool isOther = !sets.empty() || setup.identity != identity_;
    append(start_.sets, sets);
    waiting_.clear();
    begin(std::move(setup));
    return isOther;
}

/// Begins with a scene, and with what it changes itself on the way.
void ChangedScene::begin(LoadedScene setup)
{
    setup_ = std::move(setup);
    identity_ = setup_.identity;
    changes_.clear();
    for (std::size_t i = 0; i < setup_.scene.changes.size(); ++i)
        changes_.push_back({setup_.scene.changes[i].step, sim::changedSettings(setup_.scene, i), true});
}

}  // namespace app
