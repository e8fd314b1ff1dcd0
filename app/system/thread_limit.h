#pragma once

#include <oneapi/tbb/global_control.h>
#include <oneapi/tbb/task_arena.h>
#include <oneapi/tbb/version.h>

#include <string>
#include <utility>

namespace app {

/// Run body() with exactly `threads` threads for every parallel loop in it, also where that is more than there are cores:
/// oneTBB needs both the limit and an arena of that size.
template <class Body>
auto withThreads(int threads, Body&& body)
{
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(threads));
    tbb::task_arena arena(threads);
    return arena.execute(std::forward<Body>(body));
}

/// Version of the library that is loaded.
inline std::string tbbVersion() { return TBB_runtime_version(); }

}  // namespace app
