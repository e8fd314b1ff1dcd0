#include "app/provenance/repeat.h"

#include "app/system/atomic_files.h"
#include "sim/core/check.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <array>

namespace app {

namespace fs = std::filesystem;

namespace {

using RepeatJson = nlohmann::json;

[[noreturn]] void refuseReport(const fs::path& report, const std::string& why)
{
    throw sim::InputError(fmt::format("--again {}: {}", report.string(), why));
}

RepeatJson reportIn(const fs::path& file)
{
    if (!fs::is_regular_file(file)) refuseReport(file, "there is no such file; a run leaves its report.json in its folder");
    RepeatJson json = RepeatJson::parse(readWhole(file), nullptr, false);
    if (!json.is_object()) refuseReport(file, "this is no report of a run");
    if (!json.contains("provenance")) refuseReport(file, "it does not say of what the run was made; was it written by an older version?");
    const std::string status = json.value("status", "");
    if (status != "done") refuseReport(file, fmt::format("status \"{}\": only a run that is done has a last state to compare with", status));
    return json;
}

/// Numbers and words of a provenance that results may depend on, by the names they are told with.
std::vector<std::pair<std::string, std::string>> conditionsOf(const RepeatJson& provenance)
{
    std::vector<std::pair<std::string, std::string>> all;
    const auto add = [&](const std::string& name, const RepeatJson& value) {
        all.emplace_back(name, value.is_string() ? value.get<std::string>() : value.dump());
    };
    for (const char* name : {"version", "commit", "compiler", "flags", "processor", "vector_bits"}) add(name, provenance.at(name));
    for (const char* name : {"eigen", "glibc", "hdf5", "tbb"}) add(name, provenance.at("libraries").at(name));
    return all;
}

/// "; commit 12ab against 34cd, vector_bits 512 against 256", or "; program and machine are the same".
std::string changedConditions(const RepeatJson& before, const RepeatJson& now)
{
    std::string text;
    const auto was = conditionsOf(before), is = conditionsOf(now);
    for (std::size_t i = 0; i < was.size(); ++i)
        if (was[i] != is[i]) text += fmt::format("{}{} {} against {}", text.empty() ? "; " : ", ", was[i].first, was[i].second, is[i].second);
    return text.empty() ? "; program and machine are those of the report" : text;
}

}  // namespace

RunToRepeat readRunToRepeat(const fs::path& report)
{
    const fs::path file = fs::is_directory(report) ? report / "report.json" : report;
    const RepeatJson json = reportIn(file);
    try {
        const RepeatJson& provenance = json.at("provenance");
        conditionsOf(provenance);
        const RepeatJson& scene = provenance.at("scene");
        return {.report = file,
                .request = {.file = scene.at("file"), .variant = "", .sets = {}, .text = scene.at("resolved").get<std::string>()},
                .variant = json.at("variant"),
                .label = json.at("label"),
                .stateHash = json.at("state_hash"),
                .provenance = provenance.dump()};
    } catch (const RepeatJson::exception& error) {
        refuseReport(file, fmt::format("not understood: {}; was it written by another version?", error.what()));
    }
}

bool isSame(const RunToRepeat& run, const RunSummary& again) { return run.stateHash == again.stateHash; }

std::string verdictOf(const RunToRepeat& run, const RunSummary& again)
{
    const std::string conditions = changedConditions(RepeatJson::parse(run.provenance), RepeatJson::parse(again.provenance));
    if (isSame(run, again)) return fmt::format("same: state hash {}{}", again.stateHash, conditions);
    return fmt::format("different: state hash {} against {}{}", run.stateHash, again.stateHash, conditions);
}

}  // namespace app
