#include "app/study/ensemble_study.h"

#include "app/ensemble/ensemble.h"
#include "sim/scene/overrides.h"
#include "sim/scene/variants.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

namespace app {

namespace {

/// Text for a value in YAML.
std::string quoted(std::string text)
{
    for (std::size_t at = 0; (at = text.find('\'', at)) != std::string::npos; at += 2) text.insert(at, 1, '\'');
    return '\'' + text + '\'';
}

/// Overrides as a map on one line; of those with one key the last counts, as on the command line.
std::string mapOf(const std::vector<std::string>& sets)
{
    std::vector<sim::Override> kept;
    for (const std::string& set : sets) {
        sim::Override parsed = sim::parseOverride(set, false);
        std::erase_if(kept, [&](const sim::Override& earlier) { return earlier.path == parsed.path; });
        kept.push_back(std::move(parsed));
    }
    std::vector<std::string> pairs;
    for (const sim::Override& set : kept) pairs.push_back(fmt::format("{}: {}", set.path, set.value.flow()));
    return fmt::format("{}", fmt::join(pairs, ", "));
}

}  // namespace

Study ensembleStudy(const EnsembleRequest& request, const std::function<LoadedScene(const SceneRequest&)>& load)
{
    const LoadedScene asWritten = load(request.scene);
    Study study = {.name = sim::asName(asWritten.scene.name + "_ensemble"), .file = request.folder / kEnsembleFile, .runs = {}, .retries = 1};
    for (int n = 0; n < request.count; ++n) {
        const std::uint64_t number = static_cast<std::uint64_t>(request.first) + static_cast<std::uint64_t>(n);
        StudyRun run = {.name = fmt::format("{:03}", number), .values = {}, .request = request.scene, .setup = {}};
        for (const std::string& set : setsOfRun(request.varied, asWritten.scene, number)) {
            const std::size_t equals = set.find('=');
            run.values.emplace_back(set.substr(0, equals), set.substr(equals + 1));
            run.request.sets.push_back(set);
        }
        run.setup = load(run.request);
        study.runs.push_back(std::move(run));
    }
    return study;
}

std::string ensembleText(const Study& study, const EnsembleRequest& request)
{
    std::string text = fmt::format("# Of drench ensemble. drench sweep does the same runs.\nstudy: {}\nscene: {}\n", study.name,
                                   quoted(std::filesystem::absolute(request.scene.file).lexically_normal().string()));
    if (!request.scene.variant.empty()) text += fmt::format("variant: {}\n", request.scene.variant);
    if (!request.scene.sets.empty()) text += fmt::format("set: {{{}}}\n", mapOf(request.scene.sets));
    text += "runs:\n";
    for (const StudyRun& run : study.runs) {
        std::vector<std::string> sets;
        for (const auto& [key, value] : run.values) sets.push_back(fmt::format("{}={}", key, value));
        text += fmt::format("  - {{name: '{}', {}}}\n", run.name, mapOf(sets));
    }
    return text;
}

}  // namespace app
