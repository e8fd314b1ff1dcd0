#include "app/export/geometry_files.h"
#include "app/export/geometry_sink.h"
#include "app/interrupt.h"
#include "app/stored_run.h"
#include "app/thread_limit.h"
#include "app/verbs/verbs.h"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

namespace app {

int runVerbExport(const Options& options, const Parts& parts)
{
    std::vector<std::string> sets = options.sets;
    if (!options.formats.empty()) sets.push_back(fmt::format("output.geometry_format=[{}]", fmt::join(options.formats, ", ")));
    StoredRun run = openStoredRun(options.scene, sets, parts);
    run.setup.pictures.output.geometry = true;
    const std::filesystem::path out = options.out.empty() ? run.folder : options.out;
    const sim::Fabric fabric = sim::assembleFabric(run.setup.scene.fabrics);
    forgetGeometryLaterThan(-1, out);
    GeometrySink sink(run.setup, parts, out);
    const bool ended = withThreads(options.threads, [&] {
        return forEachState(run, stopWanted,
                            [&](const sim::State& state, std::int64_t frame) { sink.take(state, fabric, frame); });
    });
    if (!ended) {
        spdlog::error("stopped by the user; what was written is in {}", geometryFolder(out).string());
        return 1;
    }
    fmt::print("{} frames, in {}\n", run.frames.size(), geometryFolder(out).string());
    return 0;
}

}  // namespace app
