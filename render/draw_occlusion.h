#pragma once

#include "render/gl_objects.h"
#include "render/view_transforms.h"

namespace render {

/// How much of the surroundings each pixel of a solid is shut off from, by the depths about it: dark in folds, at
/// contacts and between yarns. Pairs of opposite neighbours are compared, so that a plane shuts off nothing however it
/// lies.
class DrawOcclusion {
 public:
    DrawOcclusion(const Gl& gl, const std::filesystem::path& shaderDir);
    /// Writes openness (1 = open) and distance from the eye [cm] into the bound framebuffer.
    /// @param reach  smallest and largest distance from which anything darkens [cm]
    void draw(GLuint colorTexture, GLuint depthTexture, const ViewTransforms& transforms, const std::array<float, 2>& reach);

 private:
    const Gl& gl_;
    Program program_;
    VertexArray noVertices_;
};

}  // namespace render
