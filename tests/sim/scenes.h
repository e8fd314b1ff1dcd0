#pragma once

#include "sim/scene/scene.h"

namespace sim::test {

/// Recipe 3.1 of the published study: a 9.84 × 16.56 × 2.88 cm column in the right end of a round-edged tank.
inline Scene damBreakSmall(TransferMethod method = TransferMethod::PolyPic, int modes = 8)
{
    Scene scene;
    scene.name = "dam_break_small";
    scene.settings.cell = 0.288;
    scene.settings.time.dt = 2.0e-4;
    scene.settings.transfer.method = method;
    scene.settings.transfer.modes = modes;
    scene.settings.liquid.wallFriction = 1.0;
    const Shape tank = Shape::roundedBox({-7.2, 14.4, 0.72}, {14.4, 14.4, 0.72}, 0.72);
    SourceSettings source;
    source.name = "column";
    source.shape = Shape::intersect({Shape::box({13.92, 0.0, 0.72}, {15.84, 15.84, 1.44}), tank});
    source.fill.pattern = FillSettings::Pattern::Reference;
    source.emissions.push_back({});
    scene.sources.push_back(source);
    ObstacleSettings obstacle;
    obstacle.name = "tank";
    obstacle.shape = tank.inverted();
    scene.obstacles.push_back(obstacle);
    return scene;
}

}  // namespace sim::test
