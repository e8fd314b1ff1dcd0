#include "render/draw_yarns.h"

#include "render/vertex_color.h"

namespace render {

namespace {

/// A software renderer keeps what is drawn until it is told to finish.
constexpr std::size_t kVerticesPerBatch = 1 << 17;

}  // namespace

DrawYarns::DrawYarns(const Gl& gl, const std::filesystem::path& shaderDir)
    : gl_(gl),
      program_(gl, shaderDir, "yarns"),
      thinProgram_(gl, shaderDir, "thin_yarns"),
      vertexArray_(gl),
      vertices_(gl),
      indices_(gl),
      colorMap_(gl)
{
    using Vertex = TubeMesh::Vertex;
    gl.BindVertexArray(vertexArray_.id());
    gl.BindBuffer(GL_ARRAY_BUFFER, vertices_.id());
    describeAttribute(gl, 0, 3, sizeof(Vertex), offsetof(Vertex, position));
    describeAttribute(gl, 1, 3, sizeof(Vertex), offsetof(Vertex, normal));
    describeAttribute(gl, 2, 1, sizeof(Vertex), offsetof(Vertex, turn));
    describeAttribute(gl, 3, 1, sizeof(Vertex), offsetof(Vertex, angle));
    describeAttribute(gl, 4, 1, sizeof(Vertex), offsetof(Vertex, value));
    describeColorAttribute(gl, 5, sizeof(Vertex), offsetof(Vertex, color));
}

void DrawYarns::draw(const FrameView::Yarns& yarns, const ViewTransforms& transforms, const YarnLook& look)
{
    const int strands = static_cast<int>(yarns.begin.size()) - 1;
    if (strands < 1) return;
    colorMap_.bind(look.colorMap);
    setUniforms(program_, transforms, look);
    setUniforms(thinProgram_, transforms, look);
    drawOpaque(gl_);

    const TubeDetail detail = {transforms.eye, transforms.pixelsPerTangent(), look.tubeSides};
    for (int s = 0; s < strands; ++s) {
        Batch& batch = isThin(yarns, s, detail) ? thin_ : thick_;
        addTube(
            yarns, s, detail, [&](float wetness) { return vertexColorOf(look, yarns.materials[s], wetness); }, batch.mesh);
        if (batch.mesh.vertices.size() > kVerticesPerBatch) drawMesh(batch);
    }
    drawMesh(thick_);
    drawMesh(thin_);
    gl_.Disable(GL_CULL_FACE);
    requireNoGlError(gl_, "drawing the yarns");
}

void DrawYarns::setUniforms(const Program& program, const ViewTransforms& transforms, const YarnLook& look) const
{
    program.use();
    gl_.UniformMatrix4fv(program["view"], 1, GL_FALSE, transforms.view.data());
    gl_.UniformMatrix4fv(program["projection"], 1, GL_FALSE, transforms.projection.data());
    gl_.Uniform2f(program["range"], look.range[0], look.range[1]);
    gl_.Uniform1i(program["colorMap"], 0);
    gl_.Uniform1f(program["plyDepth"], look.plies);
}

void DrawYarns::drawMesh(Batch& batch)
{
    if (batch.mesh.indices.empty()) return;
    batch.program.use();
    gl_.BindVertexArray(vertexArray_.id());
    upload(gl_, GL_ARRAY_BUFFER, vertices_, batch.mesh.vertices);
    upload(gl_, GL_ELEMENT_ARRAY_BUFFER, indices_, batch.mesh.indices);
    gl_.DrawElements(GL_TRIANGLES, static_cast<GLsizei>(batch.mesh.indices.size()), GL_UNSIGNED_INT, nullptr);
    gl_.Finish();
    batch.mesh.clear();
}

}  // namespace render
