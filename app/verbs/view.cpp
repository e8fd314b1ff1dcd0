#include "app/system/thread_limit.h"
#include "app/verbs/verbs.h"
#include "sim/core/check.h"

namespace app {

int runVerbView(const Options& options, const Backends& backends)
{
    SceneRequest request = options.request();
    logNotes(backends.loadScene(request));  // mistakes in it are told with or without a display
    if (!options.view.beside.empty()) {
        request.variant = options.view.beside;
        backends.loadScene(request);
    }
    if (!backends.view) throw sim::RunError("this program was built without windows (libglfw3-dev, libimgui-dev); drench run needs none");
    withThreads(options.threads, [&] {
        backends.view(options.request(), backends, options.view);
        return 0;
    });
    return 0;
}

}  // namespace app
