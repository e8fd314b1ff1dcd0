#include "render/draw_shading.h"

namespace render {

DrawShading::DrawShading(const Gl& gl, const std::filesystem::path& shaderDir)
    : gl_(gl),
      liquidProgram_(gl, shaderDir, "shading", "ONLY_LIQUID"),
      solidsProgram_(gl, shaderDir, "shading", "ONLY_SOLIDS"),
      mixedProgram_(gl, shaderDir, "shading"),
      noVertices_(gl)
{
}

void DrawShading::draw(GLuint colorTexture, GLuint depthTexture, const ViewTransforms& transforms, float strength, float step, const Solids& solids)
{
    const Program& program = solids.all ? solidsProgram_ : solids.any ? mixedProgram_ : liquidProgram_;
    program.use();
    gl_.Uniform1i(program["colors"], 0);
    gl_.Uniform1i(program["depths"], 1);
    gl_.Uniform2f(program["nearFar"], transforms.zNear, transforms.zFar);
    gl_.Uniform1f(program["strength"], strength);
    gl_.Uniform1f(program["depthStep"], step);
    gl_.Uniform1f(program["pixelsPerTangent"], transforms.pixelsPerTangent());
    gl_.Uniform1f(program["reach"], static_cast<float>(transforms.height) / 720.0f);
    gl_.Uniform1i(program["openness"], 2);
    gl_.Uniform1f(program["occlusion"], solids.occlusion);
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
