#include "render/draw_liquid.h"

#include "render/draw_targets.h"

#include <cmath>

namespace render {

namespace {

/// A software renderer keeps what is drawn until it is told to finish: 150 MB more for 500 k spheres drawn at once.
constexpr GLsizei kPointsPerBatch = 1 << 15;

/// Mean place of what is dark, x to the right and y up [pixels].
Eigen::Vector2f inkCentroid(const Image& image)
{
    Eigen::Vector2f sum(0.0f, 0.0f);
    float total = 0.0f;
    for (int y = 0; y < image.height; ++y)
        for (int x = 0; x < image.width; ++x) {
            const float ink = static_cast<float>(255 - image.at(x, y)[0]);
            sum += ink * Eigen::Vector2f(static_cast<float>(x) + 0.5f, static_cast<float>(image.height - y) - 0.5f);
            total += ink;
        }
    return total > 0.0f ? Eigen::Vector2f(sum / total) : 0.5f * Eigen::Vector2f(static_cast<float>(image.width), static_cast<float>(image.height));
}

}  // namespace

DrawLiquid::DrawLiquid(const Gl& gl, const std::filesystem::path& shaderDir, bool isSoftware)
    : gl_(gl), isSoftware_(isSoftware), program_(gl, shaderDir, "liquid"), vertices_(gl), positions_(gl), values_(gl), colorMap_(gl)
{
    gl.BindVertexArray(vertices_.id());
    gl.BindBuffer(GL_ARRAY_BUFFER, positions_.id());
    gl.VertexAttribPointer(0, 3, GL_FLOAT, GL_FALSE, 0, nullptr);
    gl.EnableVertexAttribArray(0);
    gl.BindBuffer(GL_ARRAY_BUFFER, values_.id());
    gl.VertexAttribPointer(1, 1, GL_FLOAT, GL_FALSE, 0, nullptr);
}

void DrawLiquid::draw(const FrameView::Liquid& all, const ViewTransforms& transforms, const LiquidLook& look, int samples)
{
    const FrameView::Liquid liquid = isSoftware_ ? visible_.of(all, transforms, look, samples) : all;
    if (liquid.positions.empty()) return;
    const auto known = pointShift_.find(samples);
    const Eigen::Vector2f shift = known == pointShift_.end() ? Eigen::Vector2f(0.0f, 0.0f) : known->second;
    gl_.BindVertexArray(vertices_.id());
    upload(liquid, !look.flat);
    colorMap_.bind(look.colorMap);
    program_.use();
    setUniforms(liquid, transforms, look, samples > 1, shift);

    gl_.Enable(GL_PROGRAM_POINT_SIZE);
    gl_.Enable(GL_DEPTH_TEST);
    gl_.DepthFunc(GL_LESS);
    gl_.DepthMask(GL_TRUE);
    gl_.Disable(GL_BLEND);
    if (samples > 1) gl_.Enable(GL_SAMPLE_ALPHA_TO_COVERAGE);
    const GLsizei count = static_cast<GLsizei>(liquid.positions.size());
    const GLsizei batch = isSoftware_ ? kPointsPerBatch : count;
    for (GLsizei first = 0; first < count; first += batch) {
        gl_.DrawArrays(GL_POINTS, first, std::min(batch, count - first));
        if (isSoftware_) gl_.Finish();
    }
    gl_.Disable(GL_SAMPLE_ALPHA_TO_COVERAGE);
    requireNoGlError(gl_, "drawing the liquid");
}

void DrawLiquid::calibrate(int samples)
{
    if (pointShift_.contains(samples)) return;
    constexpr int kSize = 32;
    constexpr float kMiddle = 0.5f * kSize;
    const Eigen::Vector3f position(0.0f, 0.0f, -1.0f);
    const float noValue = 0.0f;
    LiquidLook black;
    black.style = LiquidStyle::Points;
    black.flat = true;
    black.flatColor.setZero();
    black.pointPixels = 12.0f * 720.0f / kSize;
    const ViewTransforms transforms = {
        Eigen::Matrix4f::Identity(), projection({}, 1.0, 0.5, 2.0).cast<float>(), {0.0f, 0.0f, 0.0f}, 0.5f, 2.0f, kSize, kSize};
    const DrawTargets targets(gl_, kSize, kSize, samples);
    targets.beginScene({1.0f, 1.0f, 1.0f});
    draw({{&position, 1}, {&noValue, 1}, 0.1f}, transforms, black, samples);
    targets.resolve();
    const Eigen::Vector2f place = inkCentroid(targets.readResolved());
    const auto toHalves = [](float x) { return 0.5f * std::round(2.0f * x); };
    pointShift_[samples] = {toHalves(kMiddle - place.x()), toHalves(kMiddle - place.y())};
}

void DrawLiquid::upload(const FrameView::Liquid& liquid, bool withValues) const
{
    const auto fillBuffer = [this](const Buffer& buffer, auto data) {
        gl_.BindBuffer(GL_ARRAY_BUFFER, buffer.id());
        gl_.BufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(data.size_bytes()), data.data(), GL_STREAM_DRAW);
    };
    fillBuffer(positions_, liquid.positions);
    fillBuffer(values_, liquid.values);
    if (withValues) gl_.EnableVertexAttribArray(1);
    else gl_.DisableVertexAttribArray(1);
}

void DrawLiquid::setUniforms(const FrameView::Liquid& liquid, const ViewTransforms& transforms, const LiquidLook& look, bool smoothEdges,
                             const Eigen::Vector2f& pointShift) const
{
    const bool dots = look.style == LiquidStyle::Points;
    gl_.UniformMatrix4fv(program_["view"], 1, GL_FALSE, transforms.view.data());
    gl_.UniformMatrix4fv(program_["projection"], 1, GL_FALSE, transforms.projection.data());
    gl_.Uniform1f(program_["radius"], liquid.radius * look.radiusFactor);
    gl_.Uniform1f(program_["pixelsPerTangent"], transforms.pixelsPerTangent());
    gl_.Uniform1f(program_["smallestDisc"], kSmallestDisc);
    gl_.Uniform1f(program_["dotPixels"], dots ? look.pointPixels * static_cast<float>(transforms.height) / 720.0f : 0.0f);
    gl_.Uniform2f(program_["range"], look.range[0], look.range[1]);
    gl_.Uniform4f(program_["flatColor"], look.flatColor.x(), look.flatColor.y(), look.flatColor.z(), look.flat ? 1.0f : 0.0f);
    gl_.Uniform1i(program_["colorMap"], 0);
    gl_.Uniform1i(program_["smoothEdges"], smoothEdges ? 1 : 0);
    gl_.Uniform2f(program_["clipShift"], 2.0f * pointShift.x() / static_cast<float>(transforms.width),
                  2.0f * pointShift.y() / static_cast<float>(transforms.height));
}

}  // namespace render
