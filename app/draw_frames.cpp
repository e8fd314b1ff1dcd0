#include "app/draw_frames.h"

#include "render/compose.h"
#include "render/renderer.h"

#include <memory>
#include <optional>

namespace app {

namespace {

const char* const kSpeedTitle = "speed [cm/s]";
const char* const kStrainTitle = "strain";
const char* const kSaturationTitle = "saturation";

render::ColorMap colorMapOf(ColorMap map)
{
    switch (map) {
        case ColorMap::Turbo:
            return render::ColorMap::Turbo;
        case ColorMap::Viridis:
            return render::ColorMap::Viridis;
        default:
            return render::ColorMap::Jet;
    }
}

render::ObstacleStyle obstacleStyleOf(ObstacleStyle style, const SceneContents& contents)
{
    switch (style) {
        case ObstacleStyle::Auto:
            return contents.fabric() ? render::ObstacleStyle::Solid : render::ObstacleStyle::Translucent;
        case ObstacleStyle::Solid:
            return render::ObstacleStyle::Solid;
        case ObstacleStyle::Wire:
            return render::ObstacleStyle::Wire;
        case ObstacleStyle::Hidden:
            return render::ObstacleStyle::Hidden;
        default:
            return render::ObstacleStyle::Translucent;
    }
}

std::array<float, 2> toFloat(const std::array<double, 2>& range)
{
    return {static_cast<float>(range[0]), static_cast<float>(range[1])};
}

void fillIn(const FabricLookSettings& settings, render::FabricLook& look)
{
    look.byValue = settings.colorBy != FabricColorBy::Material;
    if (settings.ownColor) look.colors = {settings.color};
    look.wetColor = settings.wetColor;
    look.colorMap = colorMapOf(settings.colorMap);
    look.range = toFloat(settings.range);
    look.colorBarTitle = settings.colorBy == FabricColorBy::Strain       ? kStrainTitle
                         : settings.colorBy == FabricColorBy::Saturation ? kSaturationTitle
                                                                         : kSpeedTitle;
}

render::Look lookOf(const PictureSettings& pictures, const std::string& label, bool asPanel)
{
    const RenderSettings& settings = pictures.render;
    render::Look look;
    look.width = settings.width;
    look.height = settings.height;
    look.background = settings.background;
    look.samples = settings.samples;
    look.liquid.style =
        settings.liquidStyle == LiquidStyle::Points ? render::LiquidStyle::Points : render::LiquidStyle::Spheres;
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
    look.overlay.colorBarTitle = kSpeedTitle;
    return look;
}

/// The bar that panels of a comparison share: the liquid's if there is one, or that of fabric coloured by value.
std::optional<render::ColorBar> sharedBar(const PictureSettings& pictures)
{
    const RenderSettings& settings = pictures.render;
    if (!settings.colorBar) return std::nullopt;
    if (pictures.contents.liquid && settings.colorBy == ColorBy::Speed)
        return render::ColorBar{
            .map = colorMapOf(settings.colorMap), .range = toFloat(settings.range), .title = kSpeedTitle};
    const auto barOf = [](const FabricLookSettings& fabric) {
        render::FabricLook look;
        fillIn(fabric, look);
        return render::ColorBar{.map = look.colorMap, .range = look.range, .title = look.colorBarTitle};
    };
    if (pictures.contents.yarns && settings.yarns.colorBy != FabricColorBy::Material) return barOf(settings.yarns);
    if (pictures.contents.cloth && settings.cloth.colorBy != FabricColorBy::Material) return barOf(settings.cloth);
    return std::nullopt;
}

/// Where the camera is at view.time.
/// @param everything  box about the first frame [cm]
render::Camera cameraAt(const CameraSettings& settings, double time, const Eigen::AlignedBox3d& everything,
                        double aspect)
{
    if (settings.orbit) {
        auto camera = render::orbitCamera(settings.lookAt, settings.distance,
                                          settings.azimuthDegrees + time * settings.turnDegreesPerSecond,
                                          settings.elevationDegrees, settings.fovDegrees);
        camera.up = settings.up;
        return camera;
    }
    render::Camera camera = {
        .eye = settings.eye, .target = settings.lookAt, .up = settings.up, .fovDegrees = settings.fovDegrees};
    if (!settings.autoFrame) return camera;
    camera.eye = Eigen::Vector3d::UnitZ();
    camera.target = Eigen::Vector3d::Zero();
    return render::frameBox(everything, aspect, camera);
}

/// What draws, and what it keeps from frame to frame; all of it belongs to one thread.
struct Drawer {
    std::unique_ptr<render::GlContext> context = render::makeOsMesaContext();
    render::Renderer renderer{*context};
    std::optional<Eigen::AlignedBox3d> everything;
};

Picture pictureOf(render::Image&& image)
{
    return [image = std::make_shared<const render::Image>(std::move(image))](const std::filesystem::path& file) {
        render::writePng(*image, file);
    };
}

}  // namespace

DrawFrame startOffscreenRenderer(const SceneSetup& setup, bool asPanel)
{
    const render::Look look = lookOf(setup.pictures, setup.label, asPanel);
    return [drawer = std::make_shared<Drawer>(), look,
            settings = setup.pictures.render.camera](FrameSnapshot& snapshot) {
        const render::FrameView view = snapshot.view();
        if (!drawer->everything) drawer->everything = render::bounds(view);
        const double aspect = static_cast<double>(look.width) / look.height;
        return pictureOf(drawer->renderer.draw(view, cameraAt(settings, view.time, *drawer->everything, aspect), look));
    };
}

RgbPicture putSideBySide(const std::vector<Panel>& panels, const PictureSettings& pictures, double time)
{
    std::vector<render::Image> images;
    std::vector<std::string> labels;
    for (const auto& panel : panels) {
        images.push_back(render::readPng(panel.picture));
        labels.push_back(panel.label);
    }
    const auto& settings = pictures.render;
    render::ComposeLook look;
    look.layout = pictures.compare.layout == CompareLayout::Rows   ? render::PanelLayout::Rows
                  : pictures.compare.layout == CompareLayout::Grid ? render::PanelLayout::Grid
                                                                   : render::PanelLayout::Columns;
    if (settings.hud) look.time = time;
    look.colorBar = sharedBar(pictures);
    look.background = render::toRgb(settings.background);
    const render::Font font;
    render::Image image = render::compose(images, labels, font, look).image;
    return {.width = image.width, .height = image.height, .rgb = std::move(image.pixels)};
}

void writeRgbPng(const RgbPicture& picture, const std::filesystem::path& file)
{
    render::Image image(picture.width, picture.height);
    image.pixels = picture.rgb;
    render::writePng(image, file);
}

}  // namespace app
