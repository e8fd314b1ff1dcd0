#pragma once

#include "render/gl_objects.h"
#include "render/view_transforms.h"

namespace render {

/// The last pass over the picture: what lies behind something nearer gets darker towards its edge, so that a cloud of
/// small spheres reads as a volume. Needs the depth of the liquid alone.
/// Idea: Boucheny 2009, eye-dome lighting.
class DrawShading {
 public:
    struct Solids {
        bool any = false;        ///< whether the picture has solids, pixels of alpha 0
        bool all = false;        ///< whether it has solids only
        GLuint openness = 0;     ///< the texture that DrawOcclusion filled
        float occlusion = 0.0f;  ///< strength with which occlusion darkens them: 0 … 1
    };

    DrawShading(const Gl& gl, const std::filesystem::path& shaderDir);
    /// @param strength  0 = copy the colours as they are … 1 = dark
    /// @param step      drop in depth [cm] that counts as a full edge
    void draw(GLuint colorTexture, GLuint depthTexture, const ViewTransforms& transforms, float strength, float step, const Solids& solids);

 private:
    const Gl& gl_;
    Program liquidProgram_, solidsProgram_, mixedProgram_;  ///< a software renderer pays for what a shader leaves out
    VertexArray noVertices_;
};

}  // namespace render
