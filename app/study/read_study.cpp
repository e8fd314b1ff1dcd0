#include "app/study/study.h"

#include "app/system/atomic_files.h"
#include "sim/core/check.h"
#include "sim/scene/section_reader.h"
#include "sim/scene/variants.h"

#include <fmt/format.h>

namespace app {

namespace {

using sim::Node;

Node readFile(const std::filesystem::path& file)
{
    if (!std::filesystem::is_regular_file(file)) throw sim::InputError(fmt::format("{}: there is no such study", file.string()));
    auto source = std::make_shared<sim::TextSource>();
    source->name = file.string();
    Node root = sim::parseYaml(readWhole(file), source);
    if (!root.isMap()) sim::fail(file.string(), "a study is a map with scene and runs, not " + root.called());
    return root;
}

std::vector<std::string> setsForAll(const Node& root)
{
    std::vector<std::string> sets;
    const Node* node = root.find("set");
    if (!node) return sets;
    if (!node->isMap()) sim::fail(node->location, "set maps dotted keys to values, like {time.duration: 0.1}, not " + node->called());
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

Study readStudy(const std::filesystem::path& file, const std::function<LoadedScene(const SceneRequest&)>& load)
{
    const Node root = readFile(file);
    StudyFields fields = {.name = file.stem().string(), .scene = "", .variant = "", .retries = 1};
    sim::SectionReader::read(&root, "", [&](auto& v) { visitFields(v, fields); });
    Study study = {.name = fields.name, .file = file, .runs = {}, .retries = fields.retries};
    if (study.name.empty() || study.name != sim::asName(study.name)) {
        const Node* name = root.find("study");
        sim::fail((name ? *name : root).location,
                  fmt::format("a study's name may have a-z, 0-9 and _ only; study: {} would do", sim::asName(study.name)));
    }
    const std::string sceneFile = (file.parent_path() / fields.scene).string();
    const std::vector<std::string> sets = setsForAll(root);
    for (const sim::SceneVariant& variant : sim::listedVariants(*root.find("runs"), "runs")) {
        StudyRun run = {.name = variant.name, .values = {}, .request = {sceneFile, fields.variant, sets}, .setup = {}};
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
