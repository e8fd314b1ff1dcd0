#include "sim/scene/surface_order.h"

#include "sim/grid/obstacles.h"

#include <algorithm>

namespace sim {

namespace {

/// Do all solids of the scene rest, hold the liquid, and have walls in planes of faces?
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

}  // namespace

bool canCorrectStrain(const Scene& scene)
{
    const LiquidSettings& liquid = scene.settings.liquid;
    if (liquid.full) return false;
    return scene.obstacles.empty() || (liquid.wallFriction < 1.0 && hasWallsInPlanesOfFaces(scene));
}

bool correctsStrain(const Scene& scene) { return scene.settings.liquid.surfaceOrder == 2 && canCorrectStrain(scene); }

}  // namespace sim
