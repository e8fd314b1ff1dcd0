#include "app/frames/frame_snapshot.h"

namespace app {

render::FrameView FrameSnapshot::view()
{
    borrowedObstacles.clear();
    for (const Mesh& mesh : obstacles) borrowedObstacles.push_back({.positions = mesh.positions, .triangles = mesh.triangles, .inside = mesh.inside});
    borrowedLines.clear();
    for (const Lines& l : lines) borrowedLines.push_back({l.points, l.color, l.width, l.isTapered, l.rim, l.lift});
    return {.time = time,
            .liquid = {.positions = positions, .values = values, .radius = radius},
            .obstacles = borrowedObstacles,
            .yarns = {.positions = yarns.positions,
                      .directions = yarns.directions,
                      .along = yarns.along,
                      .begin = yarns.begin,
                      .halfAxes = yarns.halfAxes,
                      .materials = yarns.materials,
                      .values = yarns.values,
                      .wetness = yarns.wetness},
            .cloth = {.positions = cloth.positions,
                      .triangles = cloth.triangles,
                      .thickness = cloth.thickness,
                      .materials = cloth.materials,
                      .values = cloth.values,
                      .wetness = cloth.wetness},
            .lines = borrowedLines,
            .surface = {.positions = surface.positions, .normals = surface.normals, .values = surface.values, .triangles = surface.triangles}};
}

}  // namespace app
