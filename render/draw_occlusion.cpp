#include "render/draw_occlusion.h"

namespace render {

DrawOcclusion::DrawOcclusion(const Gl& gl, const std::filesystem::path& shaderDir) : gl_(gl), program_(gl, shaderDir, "occlusion"), noVertices_(gl) {}

void DrawOcclusion::draw(GLuint colorTexture, GLuint depthTexture, const ViewTransforms& transforms, const std::array<float, 2>& reach)
{
    program_.use();
    gl_.Uniform1i(program_["colors"], 0);
    gl_.Uniform1i(program_["depths"], 1);
    gl_.Uniform2f(program_["nearFar"], transforms.zNear, transforms.zFar);
    gl_.Uniform2f(program_["reach"], reach[0], reach[1]);
    gl_.Uniform1f(program_["pixelsPerTangent"], transforms.pixelsPerTangent());
    gl_.ActiveTexture(GL_TEXTURE1);
    gl_.BindTexture(GL_TEXTURE_2D, depthTexture);
    gl_.ActiveTexture(GL_TEXTURE0);
    gl_.BindTexture(GL_TEXTURE_2D, colorTexture);
    gl_.Disable(GL_DEPTH_TEST);
    gl_.Disable(GL_BLEND);
    gl_.Disable(GL_CULL_FACE);
    gl_.BindVertexArray(noVertices_.id());
    gl_.DrawArrays(GL_TRIANGLES, 0, 3);
    requireNoGlError(gl_, "finding what is shut off");
}

}  // namespace render
