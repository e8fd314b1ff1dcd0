#include "render/draw_lines.h"

#include <algorithm>

namespace render {

namespace {

struct Segment {
    Eigen::Vector3f a, b;
};
static_assert(sizeof(Segment) == 2 * sizeof(Eigen::Vector3f), "two points of FrameView::Lines are one segment");

}  // namespace

DrawLines::DrawLines(const Gl& gl, const std::filesystem::path& shaderDir) : gl_(gl), program_(gl, shaderDir, "lines"), vertices_(gl), segments_(gl)
{
    gl.BindVertexArray(vertices_.id());
    gl.BindBuffer(GL_ARRAY_BUFFER, segments_.id());
    describeAttribute(gl, 0, 3, sizeof(Segment), offsetof(Segment, a));
    describeAttribute(gl, 1, 3, sizeof(Segment), offsetof(Segment, b));
    for (GLuint index = 0; index < 2; ++index) gl.VertexAttribDivisor(index, 1);
}

void DrawLines::draw(std::span<const FrameView::Lines> groups, const ViewTransforms& transforms)
{
    const auto isEmpty = [](const FrameView::Lines& lines) { return lines.points.empty(); };
    if (std::ranges::all_of(groups, isEmpty)) return;
    gl_.Enable(GL_DEPTH_TEST);
    gl_.DepthFunc(GL_LEQUAL);
    gl_.DepthMask(GL_FALSE);
    gl_.ColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_FALSE);  // alpha tells solids from liquid: it is left to what is behind
    gl_.Enable(GL_BLEND);
    gl_.BlendFunc(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
    gl_.BindVertexArray(vertices_.id());
    for (const FrameView::Lines& lines : groups)
        if (!isEmpty(lines) && lines.rim > 0.0f) drawGroup(lines, Eigen::Vector3f::Ones(), lines.rim, transforms);
    for (const FrameView::Lines& lines : groups)
        if (!isEmpty(lines)) drawGroup(lines, lines.color, 0.0f, transforms);
    gl_.DepthMask(GL_TRUE);
    gl_.ColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
    gl_.Disable(GL_BLEND);
    requireNoGlError(gl_, "drawing lines");
}

void DrawLines::drawGroup(const FrameView::Lines& lines, const Eigen::Vector3f& color, float rim, const ViewTransforms& transforms)
{
    gl_.BindBuffer(GL_ARRAY_BUFFER, segments_.id());
    gl_.BufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(lines.points.size_bytes()), lines.points.data(), GL_STREAM_DRAW);
    program_.use();
    gl_.UniformMatrix4fv(program_["view"], 1, GL_FALSE, transforms.view.data());
    gl_.UniformMatrix4fv(program_["projection"], 1, GL_FALSE, transforms.projection.data());
    gl_.Uniform2f(program_["halfPicture"], 0.5f * static_cast<float>(transforms.width), 0.5f * static_cast<float>(transforms.height));
    const float perUnit = static_cast<float>(transforms.height) / 720.0f;
    gl_.Uniform1f(program_["linePixels"], std::max(1.0f, lines.width * perUnit));
    gl_.Uniform1f(program_["rimPixels"], rim * perUnit);
    gl_.Uniform1i(program_["isTapered"], lines.isTapered ? 1 : 0);
    gl_.Uniform1f(program_["lift"], lines.lift);
    gl_.Uniform3f(program_["color"], color.x(), color.y(), color.z());
    gl_.DrawArraysInstanced(GL_TRIANGLE_STRIP, 0, 4, static_cast<GLsizei>(lines.points.size() / 2));
}

}  // namespace render
