#pragma once

#include "render/color_map_texture.h"
#include "render/frame_view.h"
#include "render/gl_objects.h"
#include "render/look.h"
#include "render/view_transforms.h"
#include "render/visible_particles.h"

#include <map>

namespace render {

/// Liquid particles as shaded spheres: one point sprite each, shaped and lit in the fragment shader.
class DrawLiquid {
 public:
    /// @param isSoftware  hidden spheres cost it much, and what waits to be drawn its memory
    DrawLiquid(const Gl& gl, const std::filesystem::path& shaderDir, bool isSoftware);
    /// Draws with depth test and depth write. `samples` > 1: edges of spheres are blended between samples.
    void draw(const FrameView::Liquid& all, const ViewTransforms& transforms, const LiquidLook& look, int samples);

    /// Draw one dot and see where it lands: llvmpipe (seen in Mesa 22.3) puts multisampled points half a pixel off.
    /// Later draws with so many samples are corrected by what was found. Leaves other framebuffers bound.
    void calibrate(int samples);

 private:
    void upload(const FrameView::Liquid& liquid, bool withValues) const;
    void setUniforms(const FrameView::Liquid& liquid, const ViewTransforms& transforms, const LiquidLook& look, bool smoothEdges,
                     const Eigen::Vector2f& pointShift) const;

    const Gl& gl_;
    const bool isSoftware_;
    Program program_;
    VertexArray vertices_;
    Buffer positions_, values_;
    ColorMapTexture colorMap_;
    VisibleParticles visible_;
    std::map<int, Eigen::Vector2f> pointShift_;  ///< shift of points, by the number of samples [pixels]
};

}  // namespace render
