#include "app/draw_frames.h"

#include "render/compose.h"
#include "render/renderer.h"

#include <memory>
#include <optional>

namespace app {

namespace {

const char* const kColorBarTitle = "speed [cm/s]";

render::ColorMap colorMapOf(ColorMap map)
{
    switch (map) {
        case ColorMap::Turbo: return render::ColorMap::Turbo;
        case ColorMap::Viridis: return render::ColorMap::Viridis;
        default: return render::ColorMap::Jet;
    }
}

render::ObstacleStyle obstacleStyleOf(ObstacleStyle style)
{
    switch (style) {
        case ObstacleStyle::Wire: return render::ObstacleStyle::Wire;
        case ObstacleStyle::Hidden: return render::ObstacleStyle::Hidden;
        default: return render::ObstacleStyle::Translucent;
    }
}

std::array<float, 2> rangeOf(const RenderSettings& settings)
{
    return {static_cast<float>(settings.range[0]), static_cast<float>(settings.range[1])};
}

render::Look lookOf(const RenderSettings& settings, const std::string& label, bool asPanel)
{
    render::Look look;
    look.width = settings.width;
    look.height = settings.height;
    look.background = settings.background;
    look.samples = settings.samples;
    look.liquid.style = settings.liquidStyle == LiquidStyle::Points ? render::LiquidStyle::Points : render::LiquidStyle::Spheres;
    look.liquid.flat = settings.colorBy == ColorBy::Flat;
    look.liquid.colorMap = colorMapOf(settings.colorMap);
    look.liquid.range = rangeOf(settings);
    look.obstacles.style = obstacleStyleOf(settings.obstacleStyle);
    look.obstacles.opacity = static_cast<float>(settings.obstacleOpacity);
    look.overlay.label = settings.hud && !asPanel ? label : "";
    look.overlay.timeStamp = settings.hud && !asPanel;
    look.overlay.colorBar = settings.colorBar && !asPanel;
    look.overlay.colorBarTitle = kColorBarTitle;
    return look;
}

/// Where the camera is at view.time.
/// @param everything  box about the first frame [cm]
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
    const render::Look look = lookOf(setup.pictures.render, setup.label, asPanel);
    return [drawer = std::make_shared<Drawer>(), look, settings = setup.pictures.render.camera](FrameSnapshot& snapshot) {
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
    if (settings.colorBar && settings.colorBy == ColorBy::Speed)
        look.colorBar = render::ColorBar{.map = colorMapOf(settings.colorMap), .range = rangeOf(settings), .title = kColorBarTitle};
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
