#include "render/renderer.h"

#include "render/draw_liquid.h"
#include "render/draw_obstacles.h"
#include "render/draw_shading.h"
#include "render/draw_targets.h"
#include "render/font.h"
#include "render/overlay.h"

#include <algorithm>
#include <optional>
#include <stdexcept>

namespace render {

struct Renderer::Parts {
    Parts(GlContext& c, const std::filesystem::path& shaderDir)
        : context(c), gl(c.gl()), liquid(gl, shaderDir), obstacles(gl, shaderDir), shading(gl, shaderDir)
    {
        gl.GetIntegerv(GL_MAX_SAMPLES, &maxSamples);
    }

    GlContext& context;
    const Gl& gl;
    DrawLiquid liquid;
    DrawObstacles obstacles;
    DrawShading shading;
    Font font;
    GLint maxSamples = 1;
    std::optional<DrawTargets> targets;            ///< of the last picture's size
};

namespace {

void requireConsistent(const FrameView& view, const Look& look)
{
    if (look.width <= 0 || look.height <= 0) throw std::invalid_argument("picture: width and height must be positive");
    if (!look.liquid.flat && view.liquid.values.size() != view.liquid.positions.size())
        throw std::invalid_argument("picture: the liquid needs one value per position");
    if (!(look.liquid.range[0] < look.liquid.range[1]))
        throw std::invalid_argument("picture: the colour range must grow from its first to its second number");
}

/// Nearest and farthest distance of anything drawn, along the view and with some air: depth is spent on what is there.
ViewTransforms transformsFor(const FrameView& view, const Camera& camera, const Look& look)
{
    const Eigen::AlignedBox3d box = bounds(view);
    const Eigen::Isometry3d toEye = viewTransform(camera);
    double zNear = 1.0, zFar = 1.0;
    if (!box.isEmpty()) {
        const double radius = 0.5 * box.diagonal().norm() + view.liquid.radius;
        const double middle = -(toEye * box.center()).z();
        zFar = std::max(1.01 * (middle + radius), 1e-3);
        zNear = std::max(0.99 * (middle - radius), 1e-3 * zFar);
    }
    zFar = std::max(zFar, 1.001 * zNear);
    const double aspect = static_cast<double>(look.width) / look.height;
    return {toEye.matrix().cast<float>(), projection(camera, aspect, zNear, zFar).cast<float>(),
            camera.eye.cast<float>(), static_cast<float>(zNear), static_cast<float>(zFar), look.width, look.height};
}

void drawOverlay(const FrameView& view, const Look& look, const Font& font, Image& image)
{
    const OverlayLook& overlay = look.overlay;
    const Rgb ink = inkOn(toRgb(look.background));
    drawLabel(image, font, overlay.label, Corner::TopLeft, ink);
    if (overlay.timeStamp) drawLabel(image, font, timeText(view.time), Corner::TopRight, ink);
    if (overlay.colorBar && !look.liquid.flat)
        drawColorBar(image, font, {look.liquid.colorMap, look.liquid.range, overlay.colorBarTitle}, ink);
}

}  // namespace

Renderer::Renderer(GlContext& context, const std::filesystem::path& shaderDir)
{
    context.makeCurrent();
    parts_ = std::make_unique<Parts>(context, findShaderDir(shaderDir));
}

Renderer::~Renderer()
{
    try {
        parts_->context.makeCurrent();             // what is deleted belongs to this context
    } catch (const std::exception&) {
        // A context that cannot be made current is gone, and its objects with it.
    }
}

Image Renderer::draw(const FrameView& view, const Camera& camera, const Look& look)
{
    requireConsistent(view, look);
    Parts& p = *parts_;
    p.context.makeCurrent();
    const int samples = std::clamp(look.samples, 1, std::max(1, p.maxSamples));
    if (!p.targets || !p.targets->fits(look.width, look.height, samples)) {
        p.targets.reset();
        p.liquid.calibrate(samples);
        p.targets.emplace(p.gl, look.width, look.height, samples);
    }
    const ViewTransforms transforms = transformsFor(view, camera, look);

    p.targets->beginScene(look.background);
    p.liquid.draw(view.liquid, transforms, look.liquid, samples);
    p.obstacles.draw(view.obstacles, transforms, look.obstacles);
    p.targets->resolve();
    constexpr float kStepInRadii = 12.0f;          // a drop in depth of this many particles is an edge
    p.shading.draw(p.targets->colorTexture(), p.targets->depthTexture(), transforms, look.liquid.depthShading,
                   std::max(kStepInRadii * view.liquid.radius, 1e-6f));

    Image image = p.targets->read();
    drawOverlay(view, look, p.font, image);
    return image;
}

Eigen::AlignedBox3d bounds(const FrameView& view)
{
    Eigen::AlignedBox3f box;
    for (const Eigen::Vector3f& x : view.liquid.positions)
        if (x.allFinite()) box.extend(x);
    for (const FrameView::Mesh& mesh : view.obstacles)
        for (const Eigen::Vector3f& x : mesh.positions)
            if (x.allFinite()) box.extend(x);
    return box.isEmpty() ? Eigen::AlignedBox3d() : box.cast<double>();
}

}  // namespace render
