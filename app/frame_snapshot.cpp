#include "app/frame_snapshot.h"

namespace app {

render::FrameView FrameSnapshot::view()
{
    borrowedObstacles.clear();
    for (const Mesh& mesh : obstacles)
        borrowedObstacles.push_back({.positions = mesh.positions, .triangles = mesh.triangles, .inside = mesh.inside});
    return {.time = time,
            .liquid = {.positions = positions, .values = speeds, .radius = radius},
            .obstacles = borrowedObstacles};
}

}  // namespace app
