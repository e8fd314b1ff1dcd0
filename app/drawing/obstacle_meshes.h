#pragma once

#include "app/backends.h"

namespace app {

/// Triangles of all obstacles of a scene, made once, and where they are at any time.
/// Throws InputError for an obstacle without bounds, which no triangles can show.
PlaceObstacles meshObstacles(const sim::Scene& scene);

}  // namespace app
