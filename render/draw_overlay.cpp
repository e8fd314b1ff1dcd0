#include "render/draw_overlay.h"

namespace render {

namespace {

/// Colours times opacity, and opacity, rows from the bottom: what was written on black, and how much of the ground
/// shows through, which is what was written on white less that.
std::vector<std::uint8_t> withoutGround(const Image& onBlack, const Image& onWhite)
{
    std::vector<std::uint8_t> rgba;
    rgba.reserve(onBlack.pixels.size() / 3 * 4);
    for (int y = onBlack.height - 1; y >= 0; --y)
        for (int x = 0; x < onBlack.width; ++x) {
            const Rgb black = onBlack.color(x, y), white = onWhite.color(x, y);
            const int ground = white.g - black.g;
            rgba.insert(rgba.end(), {black.r, black.g, black.b, static_cast<std::uint8_t>(255 - ground)});
        }
    return rgba;
}

}  // namespace

DrawOverlay::DrawOverlay(const Gl& gl, const std::filesystem::path& shaderDir)
    : gl_(gl), program_(gl, shaderDir, "overlay"), noVertices_(gl), texture_(gl)
{
}

void DrawOverlay::draw(const Annotations& annotations, const Font& font, int width, int height)
{
    if (annotations.empty()) return;
    gl_.ActiveTexture(GL_TEXTURE0);
    gl_.BindTexture(GL_TEXTURE_2D, texture_.id());
    if (written_ != annotations || width != width_ || height != height_) write(annotations, font, width, height);
    program_.use();
    gl_.Uniform1i(program_["notes"], 0);
    gl_.Disable(GL_DEPTH_TEST);
    gl_.Enable(GL_BLEND);
    gl_.BlendFunc(GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
    gl_.BindVertexArray(noVertices_.id());
    gl_.DrawArrays(GL_TRIANGLES, 0, 3);
    gl_.Disable(GL_BLEND);
    requireNoGlError(gl_, "writing over a picture");
}

void DrawOverlay::write(const Annotations& annotations, const Font& font, int width, int height)
{
    Image onBlack(width, height, {0, 0, 0}), onWhite(width, height, {255, 255, 255});
    drawAnnotations(onBlack, font, annotations);
    drawAnnotations(onWhite, font, annotations);
    const std::vector<std::uint8_t> rgba = withoutGround(onBlack, onWhite);
    gl_.TexImage2D(GL_TEXTURE_2D, 0, GL_RGBA8, width, height, 0, GL_RGBA, GL_UNSIGNED_BYTE, rgba.data());
    for (const GLenum filter : {GL_TEXTURE_MIN_FILTER, GL_TEXTURE_MAG_FILTER}) gl_.TexParameteri(GL_TEXTURE_2D, filter, GL_NEAREST);
    written_ = annotations;
    width_ = width;
    height_ = height;
}

}  // namespace render
