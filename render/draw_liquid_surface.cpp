#include "render/draw_liquid_surface.h"

namespace render {

namespace {

template <class T>
void fill(const Gl& gl, GLenum target, const Buffer& buffer, std::span<const T> data)
{
    gl.BindBuffer(target, buffer.id());
    gl.BufferData(target, static_cast<GLsizeiptr>(data.size_bytes()), data.data(), GL_STREAM_DRAW);
}

}  // namespace

DrawLiquidSurface::DrawLiquidSurface(const Gl& gl, const std::filesystem::path& shaderDir)
    : gl_(gl), program_(gl, shaderDir, "liquid_surface"), vertexArray_(gl), positions_(gl), normals_(gl), values_(gl), indices_(gl), colorMap_(gl)
{
    gl.BindVertexArray(vertexArray_.id());
    gl.BindBuffer(GL_ARRAY_BUFFER, positions_.id());
    describeAttribute(gl, 0, 3, sizeof(Eigen::Vector3f), 0);
    gl.BindBuffer(GL_ARRAY_BUFFER, normals_.id());
    describeAttribute(gl, 1, 3, sizeof(Eigen::Vector3f), 0);
    gl.BindBuffer(GL_ARRAY_BUFFER, values_.id());
    describeAttribute(gl, 2, 1, sizeof(float), 0);
}

void DrawLiquidSurface::draw(const FrameView::LiquidSurface& surface, const ViewTransforms& transforms, const LiquidLook& look)
{
    if (surface.triangles.empty()) return;
    gl_.BindVertexArray(vertexArray_.id());
    fill(gl_, GL_ARRAY_BUFFER, positions_, surface.positions);
    fill(gl_, GL_ARRAY_BUFFER, normals_, surface.normals);
    fill(gl_, GL_ELEMENT_ARRAY_BUFFER, indices_, surface.triangles);
    if (look.flat) gl_.DisableVertexAttribArray(2);
    else {
        fill(gl_, GL_ARRAY_BUFFER, values_, surface.values);
        gl_.EnableVertexAttribArray(2);
    }
    colorMap_.bind(look.colorMap);
    program_.use();
    gl_.UniformMatrix4fv(program_["view"], 1, GL_FALSE, transforms.view.data());
    gl_.UniformMatrix4fv(program_["projection"], 1, GL_FALSE, transforms.projection.data());
    gl_.Uniform2f(program_["range"], look.range[0], look.range[1]);
    gl_.Uniform4f(program_["flatColor"], look.flatColor.x(), look.flatColor.y(), look.flatColor.z(), look.flat ? 1.0f : 0.0f);
    gl_.Uniform1i(program_["colorMap"], 0);
    drawOpaque(gl_);
    gl_.DrawElements(GL_TRIANGLES, static_cast<GLsizei>(3 * surface.triangles.size()), GL_UNSIGNED_INT, nullptr);
    gl_.Finish();
    gl_.Disable(GL_CULL_FACE);
    requireNoGlError(gl_, "drawing the surface of the liquid");
}

}  // namespace render
