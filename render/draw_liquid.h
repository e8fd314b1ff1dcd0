#pragma once

#include "render/frame_view.h"
#include "render/gl_objects.h"
#include "render/look.h"
#include "render/view_transforms.h"

#include <optional>

namespace render {

/// Liquid particles as shaded spheres: one point sprite each, shaped and lit in the fragment shader.
class DrawLiquid {
 public:
    DrawLiquid(const Gl& gl, const std::filesystem::path& shaderDir);
    /// Draws with depth test and depth write. `samples` > 1: edges of spheres are blended between samples.
    void draw(const FrameView::Liquid& liquid, const ViewTransforms& transforms, const LiquidLook& look, int samples);

 private:
    void useColorMap(ColorMap map);
    void setUniforms(const FrameView::Liquid& liquid, const ViewTransforms& transforms, const LiquidLook& look,
                     bool smoothEdges) const;

    const Gl& gl_;
    Program program_;
    VertexArray vertices_;
    Buffer positions_, values_;
    Texture colorMap_;
    std::optional<ColorMap> uploadedMap_;
};

}  // namespace render
