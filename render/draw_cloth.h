#pragma once

#include "render/cloth_mesh.h"
#include "render/color_map_texture.h"
#include "render/frame_view.h"
#include "render/gl_objects.h"
#include "render/look.h"
#include "render/view_transforms.h"

namespace render {

/// Cloth as a smooth body of its thickness.
class DrawCloth {
 public:
    DrawCloth(const Gl& gl, const std::filesystem::path& shaderDir);
    /// Draws with depth test and depth write, and alpha 0: the picture's pixels that are shaded as solids.
    void draw(const FrameView::Cloth& cloth, const ViewTransforms& transforms, const FabricLook& look);

 private:
    struct Vertex;

    const Gl& gl_;
    Program program_;
    VertexArray vertexArray_;
    Buffer vertices_, indices_;
    ColorMapTexture colorMap_;
    ClothMesh mesh_;  ///< kept for its storage
};

}  // namespace render
