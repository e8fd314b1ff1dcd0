#include "render/renderer.h"

#include "render/draw_cloth.h"
#include "render/draw_lines.h"
#include "render/draw_liquid.h"
#include "render/draw_liquid_surface.h"
#include "render/draw_obstacles.h"
#include "render/draw_occlusion.h"
#include "render/draw_overlay.h"
#include "render/draw_shading.h"
#include "render/draw_targets.h"
#include "render/draw_yarns.h"
#include "render/font.h"
#include "render/overlay.h"
#include "render/validate_frame_view.h"

#include <algorithm>
#include <optional>

namespace render {

struct Renderer::Parts {
    Parts(GlContext& c, const std::filesystem::path& shaderDir)
        : context(c),
          gl(c.gl()),
          liquid(gl, shaderDir, c.isSoftware()),
          surface(gl, shaderDir),
          yarns(gl, shaderDir),
          cloth(gl, shaderDir),
          obstacles(gl, shaderDir),
          lines(gl, shaderDir),
          occlusion(gl, shaderDir),
          shading(gl, shaderDir),
          overlay(gl, shaderDir)
    {
        gl.GetIntegerv(GL_MAX_SAMPLES, &maxSamples);
    }

    GlContext& context;
    const Gl& gl;
    DrawLiquid liquid;
    DrawLiquidSurface surface;
    DrawYarns yarns;
    DrawCloth cloth;
    DrawObstacles obstacles;
    DrawLines lines;
    DrawOcclusion occlusion;
    DrawShading shading;
    DrawOverlay overlay;
    Font font;
    GLint maxSamples = 1;
    std::optional<DrawTargets> targets;  ///< targets of the last picture's size
};

namespace {

/// Half the thickness of the thickest fabric [cm]; 0 without.
float fabricRadius(const FrameView& view)
{
    float radius = 0.0f;
    for (const auto& [a, b] : view.yarns.halfAxes) radius = std::max({radius, a, b});
    if (!view.cloth.triangles.empty())
        for (const float t : view.cloth.thickness) radius = std::max(radius, 0.5f * t);
    return radius;
}

/// Something is drawn that is shaded as a solid.
bool hasSolids(const FrameView& view, const Look& look)
{
    const bool solidObstacle =
        look.obstacles.style == ObstacleStyle::Solid && std::ranges::any_of(view.obstacles, [](const FrameView::Mesh& m) { return !m.inside; });
    return solidObstacle || !view.surface.triangles.empty() || view.yarns.begin.size() > 1 || !view.cloth.triangles.empty();
}

/// Distances from which on solids darken each other [cm]: from what is next to the thickness of the fabric, or else small
/// in the scene, up to what makes folds and contacts read.
std::array<float, 2> occlusionReach(const FrameView& view)
{
    constexpr float kInner = 0.005f, kOuter = 0.06f;  // of the diagonal of everything
    const Eigen::AlignedBox3d box = bounds(view);
    const float diagonal = box.isEmpty() ? 1.0f : std::max(static_cast<float>(box.diagonal().norm()), 1.0e-3f);
    const float outer = kOuter * diagonal, fabric = fabricRadius(view);
    return {fabric > 0.0f ? std::min(fabric, 0.25f * outer) : kInner * diagonal, outer};
}

/// Nearest and farthest distance of anything drawn, along the view and with some air: depth is spent on what is there.
ViewTransforms transformsFor(const FrameView& view, const Camera& camera, const Look& look)
{
    Eigen::AlignedBox3d box = bounds(view);
    for (const FrameView::Lines& lines : view.lines)
        for (const Eigen::Vector3f& x : lines.points)
            if (x.allFinite()) box.extend(x.cast<double>());
    const Eigen::Isometry3d toEye = viewTransform(camera);
    double zNear = 1.0, zFar = 1.0;
    if (!box.isEmpty()) {
        const double radius = 0.5 * box.diagonal().norm() + view.liquid.radius + fabricRadius(view);
        const double middle = -(toEye * box.center()).z();
        zFar = std::max(1.01 * (middle + radius), 1e-3);
        zNear = std::max(0.99 * (middle - radius), 1e-3 * zFar);
    }
    zFar = std::max(zFar, 1.001 * zNear);
    const double aspect = static_cast<double>(look.width) / look.height;
    return {toEye.matrix().cast<float>(),
            projection(camera, aspect, zNear, zFar).cast<float>(),
            camera.eye.cast<float>(),
            static_cast<float>(zNear),
            static_cast<float>(zFar),
            look.width,
            look.height};
}

/// The view without what the look does not show.
FrameView seenIn(FrameView view, const Look& look)
{
    const bool isSurface = look.liquid.style == LiquidStyle::Surface;
    if (!look.liquid.isShown || isSurface) view.liquid.positions = {}, view.liquid.values = {};
    if (!look.liquid.isShown || !isSurface) view.surface = {};
    if (!look.yarns.isShown) view.yarns = {};
    if (!look.cloth.isShown) view.cloth = {};
    return view;
}

Annotations annotationsOf(const FrameView& view, const Look& look)
{
    const OverlayLook& overlay = look.overlay;
    Annotations annotations;
    const Rgb paper = toRgb(look.background);
    annotations.ink = {contrastingColor(paper), paper};
    annotations.label = overlay.label;
    if (overlay.timeStamp) annotations.time = timeText(view.time);
    if (!overlay.colorBar) return annotations;
    // From the right edge on; what is coloured alike shares one.
    const auto add = [&](const ColorBar& bar) {
        if (std::ranges::find(annotations.bars, bar) == annotations.bars.end()) annotations.bars.push_back(bar);
    };
    if (overlay.liquidBar && look.liquid.isShown && !look.liquid.flat) add({look.liquid.colorMap, look.liquid.range, overlay.colorBarTitle});
    if (look.yarns.byValue && view.yarns.begin.size() > 1) add({look.yarns.colorMap, look.yarns.range, look.yarns.colorBarTitle});
    if (look.cloth.byValue && !view.cloth.triangles.empty()) add({look.cloth.colorMap, look.cloth.range, look.cloth.colorBarTitle});
    return annotations;
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
        parts_->context.makeCurrent();  // what is deleted belongs to this context
    } catch (const std::exception&) {
        // A context that cannot be made current is gone, and its objects with it.
    }
}

Image Renderer::draw(const FrameView& view, const Camera& camera, const Look& look)
{
    const FrameView seen = seenIn(view, look);
    paint(seen, camera, look);
    Image image = parts_->targets->read();
    drawAnnotations(image, parts_->font, annotationsOf(seen, look));
    return image;
}

void Renderer::show(const FrameView& view, const Camera& camera, const Look& look, const Viewport& part)
{
    Look fitted = look;
    fitted.width = part.width;
    fitted.height = part.height;
    const FrameView seen = seenIn(view, look);
    paint(seen, camera, fitted);
    parts_->overlay.draw(annotationsOf(seen, look), parts_->font, part.width, part.height);
    parts_->targets->show(part.x, part.y);
}

void Renderer::paint(const FrameView& view, const Camera& camera, const Look& look)
{
    validate(view, look);
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
    p.yarns.draw(view.yarns, transforms, look.yarns);
    p.cloth.draw(view.cloth, transforms, look.cloth);
    p.obstacles.drawSolid(view.obstacles, transforms, look.obstacles);
    p.surface.draw(view.surface, transforms, look.liquid);
    p.liquid.draw(view.liquid, transforms, look.liquid, samples);
    p.obstacles.draw(view.obstacles, transforms, look.obstacles);
    p.lines.draw(view.lines, transforms);
    p.targets->resolve();
    DrawShading::Solids solids;
    solids.any = hasSolids(view, look);
    solids.all = solids.any && view.liquid.positions.empty();
    if (solids.any && look.occlusion > 0.0f) {
        p.targets->beginOcclusion();
        p.occlusion.draw(p.targets->colorTexture(), p.targets->depthTexture(), transforms, occlusionReach(view));
        p.targets->endOcclusion();
        solids.openness = p.targets->opennessTexture();
        solids.occlusion = look.occlusion;
    }
    constexpr float kStepInRadii = 12.0f;  // a drop in depth of this many particles is an edge
    p.shading.draw(p.targets->colorTexture(), p.targets->depthTexture(), transforms, look.liquid.depthShading,
                   std::max(kStepInRadii * view.liquid.radius, 1e-6f), solids);
}

Eigen::AlignedBox3d bounds(const FrameView& view)
{
    Eigen::AlignedBox3f box;
    for (const Eigen::Vector3f& x : view.liquid.positions)
        if (x.allFinite()) box.extend(x);
    for (const Eigen::Vector3f& x : view.surface.positions)
        if (x.allFinite()) box.extend(x);
    for (const FrameView::Mesh& mesh : view.obstacles)
        for (const Eigen::Vector3f& x : mesh.positions)
            if (x.allFinite()) box.extend(x);
    if (view.yarns.begin.size() > 1)
        for (const Eigen::Vector3f& x : view.yarns.positions)
            if (x.allFinite()) box.extend(x);
    for (const Eigen::Vector3i& triangle : view.cloth.triangles)
        for (const int v : triangle)
            if (static_cast<std::size_t>(v) < view.cloth.positions.size() && view.cloth.positions[v].allFinite()) box.extend(view.cloth.positions[v]);
    return box.isEmpty() ? Eigen::AlignedBox3d() : box.cast<double>();
}

}  // namespace render
