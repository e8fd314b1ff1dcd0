#pragma once

#include "render/color_map_texture.h"
#include "render/frame_view.h"
#include "render/gl_objects.h"
#include "render/look.h"
#include "render/view_transforms.h"

namespace render {

/// The liquid as one smooth, glossy body in the colours of its values.
class DrawLiquidSurface {
 public:
    DrawLiquidSurface(const Gl& gl, const std::filesystem::path& shaderDir);
    /// Draws with depth test and depth write, and alpha 0: the picture's pixels that are shaded as solids.
    void draw(const FrameView::LiquidSurface& surface, const ViewTransforms& transforms, const LiquidLook& look);

 private:
    const Gl& gl_;
    Program program_;
    VertexArray vertexArray_;
    Buffer positions_, normals_, values_, indices_;
    ColorMapTexture colorMap_;
};

}  // namespace render
