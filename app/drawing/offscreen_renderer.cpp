#include "app/drawing/offscreen_renderer.h"

#include "app/drawing/look_from_settings.h"
#include "app/provenance/provenance.h"
#include "render/compose.h"
#include "render/renderer.h"

#include <fmt/format.h>

#include <memory>
#include <optional>

namespace app {

namespace {

/// What draws, and what it keeps from frame to frame; all of it belongs to one thread.
struct Drawer {
    std::unique_ptr<render::GlContext> context = render::makeOsMesaContext();
    render::Renderer renderer{*context};
    std::optional<Eigen::AlignedBox3d> everything;
};

/// What a picture says of itself: the same for the same state, whenever it is drawn.
render::PngTexts textsOf(const std::string& scene, const FrameSnapshot& snapshot)
{
    return {{"Software", programName()},
            {"Scene", scene},
            {"Time", fmt::format("{:.9g} s", snapshot.time)},
            {"State hash", hexDigits(snapshot.stateHash)}};
}

Picture pictureOf(render::Image&& image, render::PngTexts texts)
{
    return [image = std::make_shared<const render::Image>(std::move(image)), texts = std::move(texts)](const std::filesystem::path& file) {
        render::writePng(*image, file, texts);
    };
}

}  // namespace

std::string offscreenRendererName()
{
    const std::unique_ptr<render::GlContext> context = render::makeOsMesaContext();
    return context->versionName() + ", " + context->rendererName();
}

DrawFrame startOffscreenRenderer(const LoadedScene& setup, bool asPanel)
{
    const render::Look look = lookOf(setup.pictures, setup.label, asPanel);
    return [drawer = std::make_shared<Drawer>(), look, scene = setup.scene.name, settings = setup.pictures.render.camera](FrameSnapshot& snapshot) {
        const render::FrameView view = snapshot.view();
        if (!drawer->everything) drawer->everything = render::bounds(view);
        const double aspect = static_cast<double>(look.width) / look.height;
        return pictureOf(drawer->renderer.draw(view, cameraAt(settings, view.time, *drawer->everything, aspect), look), textsOf(scene, snapshot));
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
    render::writePng(image, file, {{"Software", programName()}});
}

}  // namespace app
