#include "app/diff/read_tolerance.h"

#include "app/scene/describe_picture.h"
#include "app/system/atomic_files.h"
#include "sim/core/check.h"
#include "sim/scene/overrides.h"
#include "sim/scene/scene_file.h"
#include "sim/scene/section_reader.h"

#include <fmt/format.h>

namespace app {

namespace {

/// The keys as they stand in the file: a map, empty where it says nothing of them.
sim::Node toleranceNode(const std::filesystem::path& file, bool isRun)
{
    const auto source = std::make_shared<sim::TextSource>();
    source->name = file.string();
    const sim::Node nothing = sim::Node::map({source, 1});
    if (file.empty()) return nothing;
    if (!std::filesystem::is_regular_file(file)) throw sim::InputError(fmt::format("{}: there is no such file of tolerances", file.string()));
    sim::Node root = sim::parseYaml(readWhole(file), source);
    if (root.isNull()) return nothing;
    const bool isScene = root.find("drench") != nullptr;
    if (!isScene && !isRun) return root;
    if (isScene) root = sim::loadSceneFile(file).root;
    const sim::Node* compare = root.find("compare");
    const sim::Node* tolerance = compare ? compare->find("tolerance") : nullptr;
    return tolerance ? *tolerance : nothing;
}

}  // namespace

Tolerance readTolerance(const std::filesystem::path& file, bool isRun, const std::vector<std::string>& sets)
{
    sim::Node node = toleranceNode(file, isRun);
    const bool isSi = node.location.source && node.location.source->isSi;
    for (const std::string& set : sets) sim::apply(sim::parseOverride(set, isSi), node);
    Tolerance tolerance;
    sim::SectionReader::read(&node, "tolerance", [&](auto& v) { visitFields(v, tolerance); });
    return tolerance;
}

}  // namespace app
