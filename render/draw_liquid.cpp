#include "render/draw_liquid.h"

#include <array>

namespace render {

DrawLiquid::DrawLiquid(const Gl& gl, const std::filesystem::path& shaderDir)
    : gl_(gl), program_(gl, shaderDir, "liquid"), vertices_(gl), positions_(gl), values_(gl), colorMap_(gl)
{
    gl.BindVertexArray(vertices_.id());
    gl.BindBuffer(GL_ARRAY_BUFFER, positions_.id());
    gl.VertexAttribPointer(0, 3, GL_FLOAT, GL_FALSE, 0, nullptr);
    gl.EnableVertexAttribArray(0);
    gl.BindBuffer(GL_ARRAY_BUFFER, values_.id());
    gl.VertexAttribPointer(1, 1, GL_FLOAT, GL_FALSE, 0, nullptr);
}

void DrawLiquid::draw(const FrameView::Liquid& liquid, const ViewTransforms& transforms, const LiquidLook& look,
                      int samples)
{
    if (liquid.positions.empty()) return;
    gl_.BindVertexArray(vertices_.id());
    gl_.BindBuffer(GL_ARRAY_BUFFER, positions_.id());
    gl_.BufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(liquid.positions.size_bytes()), liquid.positions.data(),
                   GL_STREAM_DRAW);
    gl_.BindBuffer(GL_ARRAY_BUFFER, values_.id());
    gl_.BufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(liquid.values.size_bytes()), liquid.values.data(),
                   GL_STREAM_DRAW);
    if (look.flat) gl_.DisableVertexAttribArray(1);  // values may be missing then
    else gl_.EnableVertexAttribArray(1);
    useColorMap(look.colorMap);
    program_.use();
    setUniforms(liquid, transforms, look, samples > 1);

    gl_.Enable(GL_PROGRAM_POINT_SIZE);
    gl_.Enable(GL_DEPTH_TEST);
    gl_.DepthFunc(GL_LESS);
    gl_.DepthMask(GL_TRUE);
    gl_.Disable(GL_BLEND);
    if (samples > 1) gl_.Enable(GL_SAMPLE_ALPHA_TO_COVERAGE);
    gl_.DrawArrays(GL_POINTS, 0, static_cast<GLsizei>(liquid.positions.size()));
    gl_.Disable(GL_SAMPLE_ALPHA_TO_COVERAGE);
    requireNoGlError(gl_, "drawing the liquid");
}

void DrawLiquid::useColorMap(ColorMap map)
{
    gl_.ActiveTexture(GL_TEXTURE0);
    gl_.BindTexture(GL_TEXTURE_2D, colorMap_.id());
    if (uploadedMap_ == map) return;
    const ColorTable table = colorTable(map);
    gl_.TexImage2D(GL_TEXTURE_2D, 0, GL_RGB32F, kColorMapSize, 1, 0, GL_RGB, GL_FLOAT, table.data());
    for (const GLenum filter : {GL_TEXTURE_MIN_FILTER, GL_TEXTURE_MAG_FILTER})
        gl_.TexParameteri(GL_TEXTURE_2D, filter, GL_LINEAR);
    for (const GLenum wrap : {GL_TEXTURE_WRAP_S, GL_TEXTURE_WRAP_T})
        gl_.TexParameteri(GL_TEXTURE_2D, wrap, GL_CLAMP_TO_EDGE);
    uploadedMap_ = map;
}

void DrawLiquid::setUniforms(const FrameView::Liquid& liquid, const ViewTransforms& transforms, const LiquidLook& look,
                             bool smoothEdges) const
{
    const bool dots = look.style == LiquidStyle::Points;
    gl_.UniformMatrix4fv(program_["view"], 1, GL_FALSE, transforms.view.data());
    gl_.UniformMatrix4fv(program_["projection"], 1, GL_FALSE, transforms.projection.data());
    gl_.Uniform1f(program_["radius"], liquid.radius * look.radiusFactor);
    gl_.Uniform1f(program_["pixelsPerTangent"], transforms.pixelsPerTangent());
    gl_.Uniform1f(program_["dotPixels"],
                  dots ? look.pointPixels * static_cast<float>(transforms.height) / 720.0f : 0.0f);
    gl_.Uniform2f(program_["range"], look.range[0], look.range[1]);
    gl_.Uniform4f(program_["flatColor"], look.flatColor.x(), look.flatColor.y(), look.flatColor.z(),
                  look.flat ? 1.0f : 0.0f);
    gl_.Uniform1i(program_["colorMap"], 0);
    gl_.Uniform1i(program_["smoothEdges"], smoothEdges ? 1 : 0);
}

}  // namespace render
