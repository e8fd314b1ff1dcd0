#pragma once

#include "render/gl_objects.h"
#include "render/overlay.h"

#include <optional>

namespace render {

/// What is written over a picture that stays with OpenGL: the same letters and bars, laid over it as a texture. It is
/// made anew only when it changes.
class DrawOverlay {
 public:
    DrawOverlay(const Gl& gl, const std::filesystem::path& shaderDir);
    /// Over the framebuffer that is bound, whose viewport has this size [pixels].
    void draw(const Annotations& annotations, const Font& font, int width, int height);

 private:
    void write(const Annotations& annotations, const Font& font, int width, int height);

    const Gl& gl_;
    Program program_;
    VertexArray noVertices_;
    Texture texture_;
    std::optional<Annotations> written_;  ///< what the texture holds
    int width_ = 0, height_ = 0;          ///< size of the texture [pixels]
};

}  // namespace render
