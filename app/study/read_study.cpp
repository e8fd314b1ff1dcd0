#include "app/study/study.h"

#include "app/output_files.h"
#include "sim/core/check.h"
#include "sim/scene/section_reader.h"
#include "sim/scene/variants.h"

#include <fmt/format.h>

#include <algorithm>

namespace app {

namespace {

using sim::Node;

const std::vector<std::string> kKeys = {"study", "scene", "variant", "set", "runs", "retries"};

Node readFile(const std::filesystem::path& file)
{
    if (!std::filesystem::is_regular_file(file)) throw sim::InputError(fmt::format("{}: there is no such study", file.string()));
    auto source = std::make_shared<sim::TextSource>();
    source->name = file.string();
    Node root = sim::parseYaml(readWhole(file), source);
    if (!root.isMap()) sim::fail(file.string(), "a study is a map with scene and runs, not " + root.called());
    for (std::size_t k = 0; k < root.keys.size(); ++k)
        if (std::ranges::find(kKeys, root.keys[k]) == kKeys.end())
            sim::fail(root.items[k].place,
                      fmt::format("unknown key {} of a study{}", sim::inQuotes(root.keys[k]), sim::suggestion(root.keys[k], kKeys)));
    return root;
}

const Node& required(const Node& root, const char* key, const std::string& example)
{
    const Node* node = root.find(key);
    if (!node) sim::fail(root.place, fmt::format("a study needs {}, like {}", key, example));
    return *node;
}

std::string textOf(const Node& root, const char* key, const std::string& otherwise)
{
    const Node* node = root.find(key);
    return node ? sim::readText(*node, key) : otherwise;
}

std::vector<std::string> setsForAll(const Node& root)
{
    std::vector<std::string> sets;
    const Node* node = root.find("set");
    if (!node) return sets;
    if (!node->isMap()) sim::fail(node->place, "set maps dotted keys to values, like {time.duration: 0.1}, not " + node->called());
    for (const sim::Override& set : sim::overridesOf(*node, {})) sets.push_back(set.text());
    return sets;
}

}  // namespace

std::vector<std::string> Study::parameters() const
{
    std::vector<std::string> keys;
    for (const StudyRun& run : runs)
        for (const auto& [key, value] : run.values)
            if (std::ranges::find(keys, key) == keys.end()) keys.push_back(key);
    return keys;
}

Study readStudy(const std::filesystem::path& file, const std::function<SceneSetup(const SceneRequest&)>& load)
{
    const Node root = readFile(file);
    Study study = {.name = textOf(root, "study", file.stem().string()), .file = file, .runs = {}};
    if (study.name.empty() || study.name != sim::asName(study.name))
        sim::fail(required(root, "study", "study: cells").place,
                  fmt::format("a study's name may have a-z, 0-9 and _ only; {} would do", sim::asName(study.name)));
    if (const Node* retries = root.find("retries")) study.retries = static_cast<int>(sim::readInteger(*retries, "retries", 0, 100));
    const Node& scene = required(root, "scene", "scene: drop.yaml");
    const std::filesystem::path sceneFile = file.parent_path() / sim::readText(scene, "scene");
    const std::vector<std::string> sets = setsForAll(root);
    for (const sim::SceneVariant& variant : sim::listedVariants(required(root, "runs", "runs: {grid.cell: [0.3, 0.4]}"), "runs")) {
        StudyRun run = {.name = variant.name, .values = {}, .request = {sceneFile.string(), textOf(root, "variant", ""), sets}, .setup = {}};
        for (const sim::Override& set : variant.overrides) {
            run.values.emplace_back(set.path, set.value.isScalar() ? set.value.text : set.value.flow());
            run.request.sets.push_back(set.text());
        }
        run.setup = load(run.request);
        study.runs.push_back(std::move(run));
    }
    return study;
}

}  // namespace app
