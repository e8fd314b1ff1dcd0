#pragma once

#include "render/color_map_texture.h"
#include "render/frame_view.h"
#include "render/gl_objects.h"
#include "render/look.h"
#include "render/tube_mesh.h"
#include "render/view_transforms.h"

namespace render {

/// Yarns as lit tubes whose plies show their twist. Those too thin for plies are lit at their vertices: in a software
/// renderer small triangles cost what their pixels do.
class DrawYarns {
 public:
    DrawYarns(const Gl& gl, const std::filesystem::path& shaderDir);
    /// Draws with depth test and depth write, and alpha 0: the picture's pixels that are shaded as solids.
    void draw(const FrameView::Yarns& yarns, const ViewTransforms& transforms, const YarnLook& look);

 private:
    struct Batch {
        const Program& program;
        TubeMesh mesh;  ///< kept for its storage
    };
    void setUniforms(const Program& program, const ViewTransforms& transforms, const YarnLook& look) const;
    void drawMesh(Batch& batch);

    const Gl& gl_;
    Program program_, thinProgram_;
    VertexArray vertexArray_;
    Buffer vertices_, indices_;
    ColorMapTexture colorMap_;
    Batch thick_ = {program_, {}}, thin_ = {thinProgram_, {}};
};

}  // namespace render
