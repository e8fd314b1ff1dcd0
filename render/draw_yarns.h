#pragma once

#include "render/color_map_texture.h"
#include "render/frame_view.h"
#include "render/gl_objects.h"
#include "render/look.h"
#include "render/tube_mesh.h"
#include "render/view_transforms.h"

namespace render {

/// Yarns as lit tubes whose plies show their twist.
class DrawYarns {
 public:
    DrawYarns(const Gl& gl, const std::filesystem::path& shaderDir);
    /// Draws with depth test and depth write, and alpha 0: the picture's pixels that are shaded as solids.
    void draw(const FrameView::Yarns& yarns, const ViewTransforms& transforms, const YarnLook& look);

 private:
    void drawMesh();

    const Gl& gl_;
    Program program_;
    VertexArray vertexArray_;
    Buffer vertices_, indices_;
    ColorMapTexture colorMap_;
    TubeMesh mesh_;                                ///< kept for its storage
};

}  // namespace render
