#include "render/draw_cloth.h"

#include "render/vertex_color.h"

namespace render {

struct DrawCloth::Vertex {
    Eigen::Vector3f position, normal;
    float value;
    float back;  ///< 1 on the back side
    VertexColor color;
};

DrawCloth::DrawCloth(const Gl& gl, const std::filesystem::path& shaderDir)
    : gl_(gl), program_(gl, shaderDir, "cloth"), vertexArray_(gl), vertices_(gl), indices_(gl), colorMap_(gl)
{
    gl.BindVertexArray(vertexArray_.id());
    gl.BindBuffer(GL_ARRAY_BUFFER, vertices_.id());
    describeAttribute(gl, 0, 3, sizeof(Vertex), offsetof(Vertex, position));
    describeAttribute(gl, 1, 3, sizeof(Vertex), offsetof(Vertex, normal));
    describeAttribute(gl, 2, 1, sizeof(Vertex), offsetof(Vertex, value));
    describeAttribute(gl, 3, 1, sizeof(Vertex), offsetof(Vertex, back));
    describeColorAttribute(gl, 4, sizeof(Vertex), offsetof(Vertex, color));
}

void DrawCloth::draw(const FrameView::Cloth& cloth, const ViewTransforms& transforms, const FabricLook& look)
{
    if (cloth.triangles.empty()) return;
    makeClothMesh(cloth, mesh_);
    std::vector<Vertex> vertices;
    vertices.reserve(mesh_.vertices.size());
    for (const ClothMesh::Vertex& v : mesh_.vertices)
        vertices.push_back({v.position, v.normal, cloth.values.empty() ? 0.0f : cloth.values[v.source], v.isBack ? 1.0f : 0.0f,
                            vertexColorOf(look, cloth.materials[v.source], cloth.wetness.empty() ? 0.0f : cloth.wetness[v.source])});

    colorMap_.bind(look.colorMap);
    program_.use();
    gl_.UniformMatrix4fv(program_["view"], 1, GL_FALSE, transforms.view.data());
    gl_.UniformMatrix4fv(program_["projection"], 1, GL_FALSE, transforms.projection.data());
    gl_.Uniform2f(program_["range"], look.range[0], look.range[1]);
    gl_.Uniform1i(program_["colorMap"], 0);
    drawOpaque(gl_);
    gl_.BindVertexArray(vertexArray_.id());
    upload(gl_, GL_ARRAY_BUFFER, vertices_, vertices);
    upload(gl_, GL_ELEMENT_ARRAY_BUFFER, indices_, mesh_.indices);
    gl_.DrawElements(GL_TRIANGLES, static_cast<GLsizei>(mesh_.indices.size()), GL_UNSIGNED_INT, nullptr);
    gl_.Finish();
    gl_.Disable(GL_CULL_FACE);
    requireNoGlError(gl_, "drawing the cloth");
}

}  // namespace render
