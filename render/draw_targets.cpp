#include "render/draw_targets.h"

#include <stdexcept>
#include <string>

namespace render {

namespace {

/// How a texture keeps its pixels, and how it would be given them.
struct TextureFormat {
    GLint kept;
    GLenum layout, type;
};

void makeTexture(const Gl& gl, GLuint id, int width, int height, const TextureFormat& format)
{
    gl.BindTexture(GL_TEXTURE_2D, id);
    gl.TexImage2D(GL_TEXTURE_2D, 0, format.kept, width, height, 0, format.layout, format.type, nullptr);
    for (const GLenum filter : {GL_TEXTURE_MIN_FILTER, GL_TEXTURE_MAG_FILTER}) gl.TexParameteri(GL_TEXTURE_2D, filter, GL_NEAREST);
    for (const GLenum wrap : {GL_TEXTURE_WRAP_S, GL_TEXTURE_WRAP_T}) gl.TexParameteri(GL_TEXTURE_2D, wrap, GL_CLAMP_TO_EDGE);
}

void requireComplete(const Gl& gl, int width, int height)
{
    if (gl.CheckFramebufferStatus(GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE)
        throw std::runtime_error("OpenGL: cannot draw pictures of " + std::to_string(width) + " x " + std::to_string(height) + " pixels");
}

}  // namespace

Image readFramebuffer(const Gl& gl, GLuint framebuffer, int width, int height)
{
    gl.BindFramebuffer(GL_FRAMEBUFFER, framebuffer);
    std::vector<std::uint8_t> rgba(4 * static_cast<std::size_t>(width) * height);
    gl.PixelStorei(GL_PACK_ALIGNMENT, 4);
    gl.ReadPixels(0, 0, width, height, GL_RGBA, GL_UNSIGNED_BYTE, rgba.data());
    Image image(width, height);
    for (int y = 0; y < height; ++y) {
        const std::uint8_t* from = &rgba[4 * static_cast<std::size_t>(height - 1 - y) * width];
        std::uint8_t* to = image.at(0, y);
        for (int x = 0; x < width; ++x, from += 4, to += 3) to[0] = from[0], to[1] = from[1], to[2] = from[2];
    }
    return image;
}

DrawTargets::DrawTargets(const Gl& gl, int width, int height, int samples)
    : gl_(gl),
      width_(width),
      height_(height),
      samples_(samples),
      sceneColor_(gl),
      sceneDepth_(gl),
      pictureColor_(gl),
      color_(gl),
      depth_(gl),
      openness_(gl),
      scene_(gl),
      resolved_(gl),
      occlusion_(gl),
      picture_(gl)
{
    const auto makeRenderbuffer = [&](GLuint id, GLenum format, int perPixel) {
        gl.BindRenderbuffer(GL_RENDERBUFFER, id);
        gl.RenderbufferStorageMultisample(GL_RENDERBUFFER, perPixel, format, width, height);
    };
    const auto attach = [&](GLuint framebuffer, GLenum where, GLuint renderbuffer) {
        gl.BindFramebuffer(GL_FRAMEBUFFER, framebuffer);
        gl.FramebufferRenderbuffer(GL_FRAMEBUFFER, where, GL_RENDERBUFFER, renderbuffer);
    };
    const int perPixel = samples > 1 ? samples : 0;
    makeRenderbuffer(sceneColor_.id(), GL_RGBA8, perPixel);
    makeRenderbuffer(sceneDepth_.id(), GL_DEPTH_COMPONENT24, perPixel);
    attach(scene_.id(), GL_COLOR_ATTACHMENT0, sceneColor_.id());
    attach(scene_.id(), GL_DEPTH_ATTACHMENT, sceneDepth_.id());
    requireComplete(gl, width, height);

    makeTexture(gl, color_.id(), width, height, {GL_RGBA8, GL_RGBA, GL_UNSIGNED_BYTE});
    makeTexture(gl, depth_.id(), width, height, {GL_DEPTH_COMPONENT24, GL_DEPTH_COMPONENT, GL_UNSIGNED_INT});
    gl.BindFramebuffer(GL_FRAMEBUFFER, resolved_.id());
    gl.FramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, color_.id(), 0);
    gl.FramebufferTexture2D(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_TEXTURE_2D, depth_.id(), 0);
    requireComplete(gl, width, height);

    makeRenderbuffer(pictureColor_.id(), GL_RGBA8, 0);
    attach(picture_.id(), GL_COLOR_ATTACHMENT0, pictureColor_.id());
    requireComplete(gl, width, height);
    requireNoGlError(gl, "making framebuffers");
}

bool DrawTargets::fits(int width, int height, int samples) const { return width == width_ && height == height_ && samples == samples_; }

void DrawTargets::beginScene(const Eigen::Vector3f& background) const
{
    gl_.BindFramebuffer(GL_FRAMEBUFFER, scene_.id());
    gl_.Viewport(0, 0, width_, height_);
    gl_.DepthMask(GL_TRUE);
    gl_.ClearColor(background.x(), background.y(), background.z(), 1.0f);
    gl_.Clear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
}

void DrawTargets::resolve() const
{
    gl_.BindFramebuffer(GL_READ_FRAMEBUFFER, scene_.id());
    gl_.BindFramebuffer(GL_DRAW_FRAMEBUFFER, resolved_.id());
    for (const GLbitfield what : {GL_COLOR_BUFFER_BIT, GL_DEPTH_BUFFER_BIT})
        gl_.BlitFramebuffer(0, 0, width_, height_, 0, 0, width_, height_, what, GL_NEAREST);
    gl_.BindFramebuffer(GL_FRAMEBUFFER, picture_.id());
    gl_.Viewport(0, 0, width_, height_);
}

void DrawTargets::beginOcclusion()
{
    gl_.BindFramebuffer(GL_FRAMEBUFFER, occlusion_.id());
    if (hasOpenness_) return;
    makeTexture(gl_, openness_.id(), width_, height_, {GL_RG16F, GL_RG, GL_FLOAT});
    gl_.FramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, openness_.id(), 0);
    requireComplete(gl_, width_, height_);
    hasOpenness_ = true;
}

void DrawTargets::endOcclusion() const { gl_.BindFramebuffer(GL_FRAMEBUFFER, picture_.id()); }

void DrawTargets::show(int x, int y) const
{
    gl_.BindFramebuffer(GL_READ_FRAMEBUFFER, picture_.id());
    gl_.BindFramebuffer(GL_DRAW_FRAMEBUFFER, 0);
    gl_.BlitFramebuffer(0, 0, width_, height_, x, y, x + width_, y + height_, GL_COLOR_BUFFER_BIT, GL_NEAREST);
    gl_.BindFramebuffer(GL_FRAMEBUFFER, 0);
    requireNoGlError(gl_, "showing a picture");
}

}  // namespace render
