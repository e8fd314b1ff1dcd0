#include "app/probes/probe_log.h"
#include "app/runs/probe_stored.h"
#include "app/system/atomic_files.h"
#include "app/system/interrupt.h"
#include "app/verbs/verbs.h"
#include "sim/core/check.h"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

namespace app {

namespace {

/// A file of probes as an override of the scene.
std::string probesOverride(const std::filesystem::path& file)
{
    if (!std::filesystem::is_regular_file(file)) throw sim::InputError(fmt::format("{}: there is no such file of probes", file.string()));
    auto source = std::make_shared<sim::TextSource>();
    source->name = file.string();
    const sim::Node node = sim::parseYaml(readWhole(file), source);
    if (!node.isMap()) sim::fail(file.string(), "probes are a map like {readings: [{name: height, unit: cm, read: liquid_y}]}, not " + node.called());
    return "output.probes=" + node.flow();
}

}  // namespace

int runVerbProbe(const Options& options, const Backends& backends)
{
    std::vector<std::string> sets = options.sets;
    if (!options.probes.empty()) sets.insert(sets.begin(), probesOverride(options.probes));
    const StoredRun run = openStoredRun(options.scene, sets, backends);
    const std::filesystem::path out = options.out.empty() ? run.folder / "probes" : options.out;
    if (std::filesystem::weakly_canonical(out) == std::filesystem::weakly_canonical(run.folder))
        throw sim::InputError(fmt::format("--out {}: there are the readings of the run itself; choose another folder", out.string()));
    if (!probeStoredRun(run, out, stopWanted)) {
        spdlog::error("stopped by the user");
        return 1;
    }
    fmt::print("readings of {} states, in {}\n", run.frames.size(), (out / kProbesFile).string());
    return 0;
}

}  // namespace app
