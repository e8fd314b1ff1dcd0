#include "sim/scene/surface_order.h"

#include "sim/grid/obstacles.h"

#include <algorithm>

namespace sim {

bool hasWallsInPlanesOfFaces(const Scene& scene)
{
    constexpr std::size_t kSides = 2 * kAxes;
    Obstacles obstacles;
    for (const ObstacleSettings& solid : scene.obstacles) obstacles.add(solid.shape, solid.motion);
    BlockGrid grid;
    grid.dx = scene.settings.cell;
    return obstacles.planeWalls().size() == kSides * scene.obstacles.size() &&
           std::ranges::all_of(obstacles.planeWalls(), [&](const Obstacles::Wall& wall) { return planeOfFaces(grid, wall).has_value(); });
}

bool correctsStrain(const Scene& scene)
{
    const LiquidSettings& liquid = scene.settings.liquid;
    return liquid.surfaceOrder == 2 && !liquid.full && hasWallsInPlanesOfFaces(scene);
}

}  // namespace sim
