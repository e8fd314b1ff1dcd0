#include "render/draw_yarns.h"

#include "render/fabric_paint.h"

namespace render {

namespace {

/// A software renderer keeps what is drawn until it is told to finish.
constexpr std::size_t kVerticesPerBatch = 1 << 17;

}  // namespace

DrawYarns::DrawYarns(const Gl& gl, const std::filesystem::path& shaderDir)
    : gl_(gl), program_(gl, shaderDir, "yarns"), vertexArray_(gl), vertices_(gl), indices_(gl), colorMap_(gl)
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
    program_.use();
    gl_.UniformMatrix4fv(program_["view"], 1, GL_FALSE, transforms.view.data());
    gl_.UniformMatrix4fv(program_["projection"], 1, GL_FALSE, transforms.projection.data());
    gl_.Uniform2f(program_["range"], look.range[0], look.range[1]);
    gl_.Uniform1i(program_["colorMap"], 0);
    gl_.Uniform1f(program_["plyDepth"], look.plies);
    drawOpaque(gl_);

    const TubeDetail detail = {transforms.eye, transforms.pixelsPerTangent(), look.tubeSides};
    mesh_.clear();
    for (int s = 0; s < strands; ++s) {
        addTube(yarns, s, detail, paintOf(look, yarns.materials[s]), mesh_);
        if (mesh_.vertices.size() > kVerticesPerBatch || s + 1 == strands) drawMesh();
    }
    gl_.Disable(GL_CULL_FACE);
    requireNoGlError(gl_, "drawing the yarns");
}

void DrawYarns::drawMesh()
{
    gl_.BindVertexArray(vertexArray_.id());
    upload(gl_, GL_ARRAY_BUFFER, vertices_, mesh_.vertices);
    upload(gl_, GL_ELEMENT_ARRAY_BUFFER, indices_, mesh_.indices);
    gl_.DrawElements(GL_TRIANGLES, static_cast<GLsizei>(mesh_.indices.size()), GL_UNSIGNED_INT, nullptr);
    gl_.Finish();
    mesh_.clear();
}

}  // namespace render
