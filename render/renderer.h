#pragma once

#include "render/camera.h"
#include "render/frame_view.h"
#include "render/gl_context.h"
#include "render/image.h"
#include "render/look.h"

#include <filesystem>
#include <memory>

namespace render {

/// Part of a framebuffer, from its lower left [pixels].
struct Viewport {
    int x = 0, y = 0, width = 0, height = 0;
};

/// Draws pictures with the OpenGL of one context, which must outlive it. One code for every kind of context.
/// Not to be used by two threads at once; several renderers on contexts of their own may draw at the same time.
class Renderer {
 public:
    /// @param shaderDir  see findShaderDir; empty = look in the usual places
    /// Throws std::runtime_error if a shader or the font is missing, or OpenGL refuses something.
    explicit Renderer(GlContext& context, const std::filesystem::path& shaderDir = {});
    ~Renderer();
    Renderer(const Renderer&) = delete;
    Renderer& operator=(const Renderer&) = delete;

    /// One picture of look.width x look.height. Same input, same machine: same bytes.
    /// Throws std::invalid_argument if the spans of `view` disagree or a size is not positive, std::runtime_error if
    /// OpenGL fails (its reason is in the message).
    Image draw(const FrameView& view, const Camera& camera, const Look& look);

    /// Draws into a part of the context's own framebuffer, whose size stands in for the look's. The rest stays as it
    /// is. Parts of one size may alternate; each change of size makes framebuffers anew. Throws like draw().
    void show(const FrameView& view, const Camera& camera, const Look& look, const Viewport& part);

 private:
    void paint(const FrameView& view, const Camera& camera, const Look& look);

    struct Parts;
    std::unique_ptr<Parts> parts_;
};

/// The box about everything that is drawn, for frameBall and frameBox. Particles that are not finite are left out.
Eigen::AlignedBox3d bounds(const FrameView& view);

}  // namespace render
