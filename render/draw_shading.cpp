#include "render/draw_shading.h"

namespace render {

DrawShading::DrawShading(const Gl& gl, const std::filesystem::path& shaderDir)
    : gl_(gl), program_(gl, shaderDir, "shading"), noVertices_(gl)
{
}

void DrawShading::draw(GLuint colorTexture, GLuint depthTexture, const ViewTransforms& transforms, float strength,
                       float step, const Solids& solids)
{
    program_.use();
    gl_.Uniform1i(program_["colors"], 0);
    gl_.Uniform1i(program_["depths"], 1);
    gl_.Uniform2f(program_["nearFar"], transforms.zNear, transforms.zFar);
    gl_.Uniform1f(program_["strength"], strength);
    gl_.Uniform1f(program_["depthStep"], step);
    gl_.Uniform1f(program_["pixelsPerTangent"], transforms.pixelsPerTangent());
    gl_.Uniform1f(program_["reach"], static_cast<float>(transforms.height) / 720.0f);
    gl_.Uniform1i(program_["openness"], 2);
    gl_.Uniform1i(program_["hasSolids"], solids.any ? 1 : 0);
    gl_.Uniform1f(program_["occlusion"], solids.occlusion);
    gl_.ActiveTexture(GL_TEXTURE2);
    gl_.BindTexture(GL_TEXTURE_2D, solids.openness);
    gl_.ActiveTexture(GL_TEXTURE1);
    gl_.BindTexture(GL_TEXTURE_2D, depthTexture);
    gl_.ActiveTexture(GL_TEXTURE0);
    gl_.BindTexture(GL_TEXTURE_2D, colorTexture);
    gl_.Disable(GL_DEPTH_TEST);
    gl_.Disable(GL_BLEND);
    gl_.Disable(GL_CULL_FACE);
    gl_.BindVertexArray(noVertices_.id());
    gl_.DrawArrays(GL_TRIANGLES, 0, 3);
    requireNoGlError(gl_, "shading by depth");
}

}  // namespace render
