#pragma once

#include "render/color_map.h"

#include <Eigen/Core>

#include <array>
#include <string>
#include <vector>

namespace render {

enum class LiquidStyle { Spheres, Points, Surface };            ///< shaded balls, plain dots of `pointPixels`, or the view's surface
enum class ObstacleStyle { Translucent, Wire, Hidden, Solid };  ///< of Solid ones containers are translucent

struct LiquidLook {
    bool isShown = true;
    LiquidStyle style = LiquidStyle::Spheres;
    bool flat = false;  ///< one colour for all instead of the colour map
    Eigen::Vector3f flatColor = {0.20f, 0.45f, 0.80f};
    ColorMap colorMap = ColorMap::Jet;
    std::array<float, 2> range = {0.0f, 200.0f};  ///< values at the ends of the colour map
    float radiusFactor = 1.0f;                    ///< drawn radius / FrameView radius [-]
    float pointPixels = 2.0f;                     ///< diameter of dots in a picture 720 pixels high [pixels]
    float depthShading = 1.0f;                    ///< how strongly its shape shades the liquid: 0 = pure colours … 1
};

/// Muted colours that are told apart, for one material after the other.
inline const std::vector<Eigen::Vector3f> kFabricColors = {{0.80f, 0.70f, 0.55f}, {0.30f, 0.47f, 0.66f}, {0.72f, 0.33f, 0.28f},
                                                           {0.42f, 0.58f, 0.38f}, {0.55f, 0.42f, 0.62f}, {0.84f, 0.56f, 0.25f},
                                                           {0.35f, 0.60f, 0.62f}, {0.72f, 0.50f, 0.58f}};

struct FabricLook {
    bool isShown = true;
    bool byValue = false;                                 ///< colour map instead of one colour per material
    std::vector<Eigen::Vector3f> colors = kFabricColors;  ///< colours of the materials, again from the first when they run out
    Eigen::Vector3f wetColor = {0.10f, 0.20f, 0.60f};     ///< colour of what is soaked; between, where it is less wet
    ColorMap colorMap = ColorMap::Viridis;
    std::array<float, 2> range = {0.0f, 1.0f};  ///< values at the ends of the colour map
    std::string colorBarTitle = "strain";
};

struct YarnLook : FabricLook {
    int tubeSides = 10;  ///< number of sides of tubes near the eye; thin ones in the picture have fewer
    float plies = 1.0f;  ///< depth of the grooves between the plies: 0 = smooth … 1
};

struct ObstacleLook {
    ObstacleStyle style = ObstacleStyle::Translucent;
    Eigen::Vector3f color = {0.36f, 0.42f, 0.50f};
    float opacity = 0.15f;  ///< opacity of the faces, 0 … 1
    Eigen::Vector3f solidColor = {0.70f, 0.72f, 0.75f};
};

/// What is written over the picture. An empty text is not drawn.
struct OverlayLook {
    std::string label;      ///< top left
    bool timeStamp = true;  ///< top right: t = 0.124 s
    bool colorBar = true;   ///< right edge, for all that is coloured by value
    bool liquidBar = true;  ///< the liquid's is among them, unless it is flat
    std::string colorBarTitle = "speed [cm/s]";
};

/// How a picture is drawn: everything but the scene and the camera.
struct Look {
    int width = 960, height = 540;  ///< [pixels]
    Eigen::Vector3f background = Eigen::Vector3f::Ones();
    int samples = 4;  ///< multisampling, 1 = off; at most what the context offers
    LiquidLook liquid;
    YarnLook yarns;
    FabricLook cloth;
    float occlusion = 1.0f;  ///< how dark fabric and solid obstacles are in folds and at contacts: 0 … 1
    ObstacleLook obstacles;
    OverlayLook overlay;
};

}  // namespace render
