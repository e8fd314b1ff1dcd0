#include "render/renderer.h"

#include "render/draw_cloth.h"
#include "render/draw_liquid.h"
#include "render/draw_obstacles.h"
#include "render/draw_occlusion.h"
#include "render/draw_shading.h"
#include "render/draw_targets.h"
#include "render/draw_yarns.h"
#include "render/font.h"
#include "render/overlay.h"

#include <algorithm>
#include <optional>
#include <stdexcept>

namespace render {

struct Renderer::Parts {
    Parts(GlContext& c, const std::filesystem::path& shaderDir)
        : context(c),
          gl(c.gl()),
          liquid(gl, shaderDir),
          yarns(gl, shaderDir),
          cloth(gl, shaderDir),
          obstacles(gl, shaderDir),
          occlusion(gl, shaderDir),
          shading(gl, shaderDir)
    {
        gl.GetIntegerv(GL_MAX_SAMPLES, &maxSamples);
    }

    GlContext& context;
    const Gl& gl;
    DrawLiquid liquid;
    DrawYarns yarns;
    DrawCloth cloth;
    DrawObstacles obstacles;
    DrawOcclusion occlusion;
    DrawShading shading;
    Font font;
    GLint maxSamples = 1;
    std::optional<DrawTargets> targets;  ///< of the last picture's size
};

namespace {

void require(bool isMet, const char* what)
{
    if (!isMet) throw std::invalid_argument(what);
}

void requireConsistent(const FrameView::Yarns& yarns, const YarnLook& look)
{
    if (yarns.begin.empty()) return;
    const std::size_t count = yarns.positions.size(), strands = yarns.begin.size() - 1;
    require(yarns.begin.front() == 0 && yarns.begin.back() == static_cast<int>(count) &&
                std::ranges::is_sorted(yarns.begin),
            "picture: the strands must begin one behind the other and end with the last position");
    require(yarns.directions.size() == count && yarns.along.size() == count,
            "picture: the yarns need one direction and length per position");
    require(yarns.halfAxes.size() == strands && yarns.materials.size() == strands,
            "picture: the yarns need one section and material per strand");
    require(yarns.values.size() == (look.byValue           ? count
                                    : yarns.values.empty() ? 0
                                                           : count),
            "picture: the yarns need one value per position");
    require(look.range[0] < look.range[1],
            "picture: the colour range of yarns must grow from its first to its second number");
}

void requireConsistent(const FrameView::Cloth& cloth, const FabricLook& look)
{
    if (cloth.triangles.empty()) return;
    const std::size_t count = cloth.positions.size();
    require(cloth.thickness.size() == count && cloth.materials.size() == count,
            "picture: the cloth needs one thickness and material per position");
    require(cloth.values.size() == (look.byValue           ? count
                                    : cloth.values.empty() ? 0
                                                           : count),
            "picture: the cloth needs one value per position");
    require(look.range[0] < look.range[1],
            "picture: the colour range of cloth must grow from its first to its second number");
}

void requireConsistent(const FrameView& view, const Look& look)
{
    requireConsistent(view.yarns, look.yarns);
    requireConsistent(view.cloth, look.cloth);
    if (look.width <= 0 || look.height <= 0) throw std::invalid_argument("picture: width and height must be positive");
    if (!look.liquid.flat && view.liquid.values.size() != view.liquid.positions.size())
        throw std::invalid_argument("picture: the liquid needs one value per position");
    if (!(look.liquid.range[0] < look.liquid.range[1]))
        throw std::invalid_argument("picture: the colour range must grow from its first to its second number");
}

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
    const bool solidObstacle = look.obstacles.style == ObstacleStyle::Solid &&
                               std::ranges::any_of(view.obstacles, [](const FrameView::Mesh& m) { return !m.inside; });
    return solidObstacle || view.yarns.begin.size() > 1 || !view.cloth.triangles.empty();
}

/// From which distances solids darken each other [cm]: from what is next to the thickness of the fabric, or else small
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
    const Eigen::AlignedBox3d box = bounds(view);
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

void drawOverlay(const FrameView& view, const Look& look, const Font& font, Image& image)
{
    const OverlayLook& overlay = look.overlay;
    const Rgb ink = inkOn(toRgb(look.background));
    drawLabel(image, font, overlay.label, Corner::TopLeft, ink);
    if (overlay.timeStamp) drawLabel(image, font, timeText(view.time), Corner::TopRight, ink);
    if (!overlay.colorBar) return;
    // From the right edge on; what is coloured alike shares one.
    std::vector<ColorBar> bars;
    const auto add = [&](const ColorBar& bar) {
        if (std::ranges::find(bars, bar) == bars.end()) bars.push_back(bar);
    };
    if (overlay.liquidBar && !look.liquid.flat) add({look.liquid.colorMap, look.liquid.range, overlay.colorBarTitle});
    if (look.yarns.byValue && view.yarns.begin.size() > 1)
        add({look.yarns.colorMap, look.yarns.range, look.yarns.colorBarTitle});
    if (look.cloth.byValue && !view.cloth.triangles.empty())
        add({look.cloth.colorMap, look.cloth.range, look.cloth.colorBarTitle});
    drawColorBars(image, font, bars, ink);
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
    paint(view, camera, look);
    Image image = parts_->targets->read();
    drawOverlay(view, look, parts_->font, image);
    return image;
}

void Renderer::show(const FrameView& view, const Camera& camera, const Look& look)
{
    paint(view, camera, look);
    parts_->targets->show();
}

void Renderer::paint(const FrameView& view, const Camera& camera, const Look& look)
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
    p.yarns.draw(view.yarns, transforms, look.yarns);
    p.cloth.draw(view.cloth, transforms, look.cloth);
    p.obstacles.drawSolid(view.obstacles, transforms, look.obstacles);
    p.liquid.draw(view.liquid, transforms, look.liquid, samples);
    p.obstacles.draw(view.obstacles, transforms, look.obstacles);
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
    for (const FrameView::Mesh& mesh : view.obstacles)
        for (const Eigen::Vector3f& x : mesh.positions)
            if (x.allFinite()) box.extend(x);
    if (view.yarns.begin.size() > 1)
        for (const Eigen::Vector3f& x : view.yarns.positions)
            if (x.allFinite()) box.extend(x);
    for (const Eigen::Vector3i& triangle : view.cloth.triangles)
        for (const int v : triangle)
            if (static_cast<std::size_t>(v) < view.cloth.positions.size() && view.cloth.positions[v].allFinite())
                box.extend(view.cloth.positions[v]);
    return box.isEmpty() ? Eigen::AlignedBox3d() : box.cast<double>();
}

}  // namespace render
