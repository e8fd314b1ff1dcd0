#pragma once

#include "render/color_map.h"

#include <Eigen/Core>

#include <array>
#include <string>

namespace render {

enum class LiquidStyle { Spheres, Points };          ///< shaded balls, or plain dots of `pointPixels`
enum class ObstacleStyle { Translucent, Wire, Hidden };

struct LiquidLook {
    LiquidStyle style = LiquidStyle::Spheres;
    bool flat = false;                             ///< one colour for all instead of the colour map
    Eigen::Vector3f flatColor = {0.20f, 0.45f, 0.80f};
    ColorMap colorMap = ColorMap::Jet;
    std::array<float, 2> range = {0.0f, 200.0f};   ///< values at the ends of the colour map
    float radiusFactor = 1.0f;                     ///< drawn radius / FrameView radius [-]
    float pointPixels = 2.0f;                      ///< diameter of dots in a picture 720 pixels high [pixels]
    float depthShading = 1.0f;                     ///< how strongly its shape shades the liquid: 0 = pure colours … 1
};

struct ObstacleLook {
    ObstacleStyle style = ObstacleStyle::Translucent;
    Eigen::Vector3f color = {0.36f, 0.42f, 0.50f};
    float opacity = 0.15f;                         ///< of the faces, 0 … 1
};

/// What is written over the picture. An empty text is not drawn.
struct OverlayLook {
    std::string label;                             ///< top left
    bool timeStamp = true;                         ///< top right: t = 0.124 s
    bool colorBar = true;                          ///< right edge; never for flat liquid
    std::string colorBarTitle = "speed [cm/s]";
};

/// How a picture is drawn: everything but the scene and the camera.
struct Look {
    int width = 960, height = 540;                 ///< [pixels]
    Eigen::Vector3f background = Eigen::Vector3f::Ones();
    int samples = 4;                               ///< multisampling, 1 = off; at most what the context offers
    LiquidLook liquid;
    ObstacleLook obstacles;
    OverlayLook overlay;
};

}  // namespace render
