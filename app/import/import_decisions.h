#pragma once

#include "app/import/write_scene.h"

namespace app {

/// Tells the report what of a file was taken one way and might be taken another, and what has no counterpart.
void reportDecisions(const ImportedScene& scene, const ImportOptions& options, ImportReport& report);

/// Numbers of particles, vertices, edges, faces, held vertices, sources, obstacles.
void reportCounts(const ImportedScene& scene, ImportReport& report);

}  // namespace app
