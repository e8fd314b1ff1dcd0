#pragma once

#include "render/gl_objects.h"
#include "render/image.h"

#include <Eigen/Core>

namespace render {

/// What a framebuffer (0: the context's own) holds in its lower left, rows from the top.
Image readFramebuffer(const Gl& gl, GLuint framebuffer, int width, int height);

/// The framebuffers of one picture size: the scene is drawn into `scene` (multisampled), resolved into textures, and
/// shaded into `picture`, which is read back or shown.
class DrawTargets {
 public:
    /// Throws std::runtime_error if OpenGL cannot hold pictures of this size.
    DrawTargets(const Gl& gl, int width, int height, int samples);

    bool fits(int width, int height, int samples) const;
    void beginScene(const Eigen::Vector3f& background) const;  ///< clear `scene`, draw into it from here on
    void resolve() const;                                      ///< scene → colour and depth textures; draw into `picture` next
    void beginOcclusion();                                     ///< draw into the openness texture from here on
    void endOcclusion() const;                                 ///< draw into `picture` again
    Image read() const { return readFramebuffer(gl_, picture_.id(), width_, height_); }  ///< what `picture` holds, rows from the top
    void show(int x, int y) const;  ///< show the picture with its lower left at (x, y) of the context's own framebuffer, which is bound then
    Image readResolved() const { return readFramebuffer(gl_, resolved_.id(), width_, height_); }  ///< read the scene before shading

    GLuint colorTexture() const { return color_.id(); }
    GLuint depthTexture() const { return depth_.id(); }
    GLuint opennessTexture() const { return openness_.id(); }

 private:
    const Gl& gl_;
    int width_, height_, samples_;
    Renderbuffer sceneColor_, sceneDepth_, pictureColor_;
    Texture color_, depth_, openness_;
    Framebuffer scene_, resolved_, occlusion_, picture_;
    bool hasOpenness_ = false;  ///< whether the texture of openness is there, which is made when it is first needed
};

}  // namespace render
