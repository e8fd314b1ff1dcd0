#include "app/export/geometry_files.h"
#include "app/export/geometry_sink.h"
#include "app/provenance/provenance.h"
#include "app/runs/stored_run.h"
#include "app/system/interrupt.h"
#include "app/system/thread_limit.h"
#include "app/verbs/verbs.h"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

namespace app {

int runVerbExport(const Options& options, const Backends& backends)
{
    std::vector<std::string> sets = options.sets;
    if (!options.formats.empty()) sets.push_back(fmt::format("output.geometry_format=[{}]", fmt::join(options.formats, ", ")));
    StoredRun run = openStoredRun(options.scene, sets, backends);
    run.setup.pictures.output.geometry = true;
    const std::filesystem::path out = options.out.empty() ? run.folder : options.out;
    const sim::Fabric fabric = sim::assembleFabric(run.setup.scene.fabrics);
    removeGeometryAfter(-1, out);
    const std::string ofRun = loadCheckpoint(stateFile(run.folder, run.kind, run.frames.front())).origin.provenance;
    GeometrySink sink(run.setup, backends, out, provenanceOf(run.setup, options.threads, "", ofRun));
    const bool ended = withThreads(options.threads, [&] {
        return forEachState(run, stopWanted, [&](const Checkpoint& stored) { sink.take(stored.state, fabric, stored.origin.frame); });
    });
    if (!ended) {
        spdlog::error("stopped by the user; what was written is in {}", geometryFolder(out).string());
        return 1;
    }
    fmt::print("{} frames, in {}\n", run.frames.size(), geometryFolder(out).string());
    return 0;
}

}  // namespace app
