#pragma once

#include "render/gl_objects.h"
#include "render/view_transforms.h"

namespace render {

/// The last pass over the picture: what lies behind something nearer gets darker towards its edge, so that a cloud of
/// small spheres reads as a volume. Needs the depth of the liquid alone.
/// Idea: Boucheny 2009, eye-dome lighting.
class DrawShading {
 public:
    struct Openness {
        GLuint texture = 0;
        float strength = 0.0f;                     ///< 0 … 1
    };

    DrawShading(const Gl& gl, const std::filesystem::path& shaderDir);
    /// @param strength  0 = copy the colours as they are … 1 = dark
    /// @param step      drop in depth [cm] that counts as a full edge
    /// @param solids    what DrawOcclusion found for pixels of alpha 0, and how much it darkens them; none: 0
    void draw(GLuint colorTexture, GLuint depthTexture, const ViewTransforms& transforms, float strength, float step,
              const Openness& solids);

 private:
    const Gl& gl_;
    Program program_;
    VertexArray noVertices_;
};

}  // namespace render
