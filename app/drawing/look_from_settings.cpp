#include "app/drawing/look_from_settings.h"

#include <utility>

namespace app {

namespace {

const char* const kSpeedTitle = "speed [cm/s]";
const char* const kPressureTitle = "pressure [dyn/cm²]";
const char* const kStrainTitle = "strain";
const char* const kSaturationTitle = "saturation";

render::ColorMap colorMapOf(ColorMap map)
{
    switch (map) {
        case ColorMap::Turbo: return render::ColorMap::Turbo;
        case ColorMap::Viridis: return render::ColorMap::Viridis;
        default: return render::ColorMap::Jet;
    }
}

render::ObstacleStyle obstacleStyleOf(ObstacleStyle style, const SceneContents& contents)
{
    switch (style) {
        case ObstacleStyle::Auto: return contents.fabric() ? render::ObstacleStyle::Solid : render::ObstacleStyle::Translucent;
        case ObstacleStyle::Solid: return render::ObstacleStyle::Solid;
        case ObstacleStyle::Wire: return render::ObstacleStyle::Wire;
        case ObstacleStyle::Hidden: return render::ObstacleStyle::Hidden;
        default: return render::ObstacleStyle::Translucent;
    }
}

void fillIn(const FabricLookSettings& settings, render::FabricLook& look)
{
    look.byValue = settings.colorBy != FabricColorBy::Material;
    if (settings.ownColor) look.colors = {settings.color};
    look.wetColor = settings.wetColor;
    look.colorMap = colorMapOf(settings.colorMap);
    look.range = toFloat(settings.range);
    look.colorBarTitle = titleOf(settings.colorBy);
}

}  // namespace

std::array<float, 2> toFloat(const std::array<double, 2>& range) { return {static_cast<float>(range[0]), static_cast<float>(range[1])}; }

const char* titleOf(ColorBy colorBy) { return colorBy == ColorBy::Pressure ? kPressureTitle : kSpeedTitle; }

const char* titleOf(FabricColorBy colorBy)
{
    return colorBy == FabricColorBy::Strain ? kStrainTitle : colorBy == FabricColorBy::Saturation ? kSaturationTitle : kSpeedTitle;
}

render::LiquidStyle liquidStyleOf(LiquidStyle style)
{
    return style == LiquidStyle::Points    ? render::LiquidStyle::Points
           : style == LiquidStyle::Surface ? render::LiquidStyle::Surface
                                           : render::LiquidStyle::Spheres;
}

render::Look lookOf(const PictureSettings& pictures, const std::string& label, bool asPanel)
{
    const RenderSettings& settings = pictures.render;
    render::Look look;
    look.width = settings.width;
    look.height = settings.height;
    look.background = settings.background;
    look.samples = settings.samples;
    look.liquid.style = liquidStyleOf(settings.liquidStyle);
    look.liquid.flat = settings.colorBy == ColorBy::Flat;
    look.liquid.colorMap = colorMapOf(settings.colorMap);
    look.liquid.range = toFloat(settings.range);
    fillIn(settings.cloth, look.cloth);
    fillIn(settings.yarns, look.yarns);
    look.yarns.tubeSides = settings.yarns.tubeSides;
    look.obstacles.style = obstacleStyleOf(settings.obstacleStyle, pictures.contents);
    look.obstacles.opacity = static_cast<float>(settings.obstacleOpacity);
    look.overlay.label = settings.hud && !asPanel ? label : "";
    look.overlay.timeStamp = settings.hud && !asPanel;
    look.overlay.colorBar = settings.colorBar && !asPanel;
    look.overlay.liquidBar = pictures.contents.liquid;
    look.overlay.colorBarTitle = titleOf(settings.colorBy);
    return look;
}

std::optional<render::ColorBar> sharedBar(const PictureSettings& pictures)
{
    const RenderSettings& settings = pictures.render;
    if (!settings.colorBar) return std::nullopt;
    if (pictures.contents.liquid && settings.colorBy != ColorBy::Flat)
        return render::ColorBar{.map = colorMapOf(settings.colorMap), .range = toFloat(settings.range), .title = titleOf(settings.colorBy)};
    const auto barOf = [](const FabricLookSettings& fabric) {
        render::FabricLook look;
        fillIn(fabric, look);
        return render::ColorBar{.map = look.colorMap, .range = look.range, .title = look.colorBarTitle};
    };
    if (pictures.contents.yarns && settings.yarns.colorBy != FabricColorBy::Material) return barOf(settings.yarns);
    if (pictures.contents.cloth && settings.cloth.colorBy != FabricColorBy::Material) return barOf(settings.cloth);
    return std::nullopt;
}

render::Camera cameraAt(const CameraSettings& settings, double time, const Eigen::AlignedBox3d& everything, double aspect)
{
    if (settings.orbit) {
        auto camera = render::orbitCamera(settings.lookAt, settings.distance, settings.azimuthDegrees + time * settings.turnDegreesPerSecond,
                                          settings.elevationDegrees, settings.fovDegrees);
        camera.up = settings.up;
        return camera;
    }
    render::Camera camera = {.eye = settings.eye, .target = settings.lookAt, .up = settings.up, .fovDegrees = settings.fovDegrees};
    if (!settings.autoFrame) return camera;
    camera.eye = Eigen::Vector3d::UnitZ();
    camera.target = Eigen::Vector3d::Zero();
    return render::frameBox(everything, aspect, camera);
}

}  // namespace app
