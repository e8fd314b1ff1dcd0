#include "app/export/geometry_files.h"
#include "app/pictures/video.h"
#include "app/reports/output_folder.h"
#include "app/runs/stored_run.h"
#include "app/system/atomic_files.h"
#include "app/system/interrupt.h"
#include "app/system/thread_limit.h"
#include "app/verbs/verbs.h"
#include "sim/core/check.h"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

namespace app {

int runVerbRender(const Options& options, const Backends& backends)
{
    const StoredRun run = openStoredRun(options.scene, options.sets, backends);
    const std::filesystem::path out = options.out.empty() ? run.folder / "pictures" : options.out;
    if (std::filesystem::weakly_canonical(out) == std::filesystem::weakly_canonical(run.folder))
        throw sim::InputError(fmt::format("--out {}: there are the pictures of the run itself; choose another folder", out.string()));
    claimFolder(out, {run.setup.scene.name, run.setup.variant});
    removeGeometryAfter(-1, out);
    // Whose pictures they are, so that they can be made anew and compared.
    writeWhole(out / "report.json", readWhole(run.folder / "report.json"));
    writeWhole(out / "resolved.yaml", run.setup.resolved);
    const bool ended = withThreads(options.threads, [&] { return drawStoredRun(run, out, options.asPanel, backends, stopWanted); });
    if (!ended) {
        spdlog::error("stopped by the user; what was drawn is in {}", out.string());
        return 1;
    }
    if (options.video) makeVideo(out, run.setup.pictures.output);
    fmt::print("{} pictures, in {}\n", run.frames.size(), out.string());
    return 0;
}

}  // namespace app
