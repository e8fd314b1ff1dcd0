#pragma once

#include "render/gl.h"

#include <memory>
#include <string>
#include <vector>

namespace render {

/// An OpenGL 3.3 core context. Several may live in one process; each is used by one thread at a time.
class GlContext {
 public:
    GlContext() = default;
    virtual ~GlContext() = default;
    GlContext(const GlContext&) = delete;
    GlContext& operator=(const GlContext&) = delete;

    /// Make this the calling thread's context.
    virtual void makeCurrent() = 0;
    const Gl& gl() const { return gl_; }
    /// What draws, say "llvmpipe (LLVM 15.0.6, 256 bits)". The context must be current.
    std::string rendererName() const { return reinterpret_cast<const char*>(gl_.GetString(GL_RENDERER)); }
    /// Version of OpenGL and of what brings it, say "3.3 (Core Profile) Mesa 22.3.6". The context must be current.
    std::string versionName() const { return reinterpret_cast<const char*>(gl_.GetString(GL_VERSION)); }
    /// Is it drawn by the processor? The context must be current.
    bool isSoftware() const;
    /// The errors OpenGL has told of since the last call, for tests: its own messages where the context has them (those
    /// of windows, with most drivers), else the error that is pending. The context must be current.
    std::vector<std::string> takeGlMessages();

 protected:
    void complain(const std::string& message);

    Gl gl_;
    bool hasMessages_ = false;  ///< errors come to complain() of themselves

 private:
    std::vector<std::string> complaints_;
};

/// A context that needs neither a display nor a graphics card (OSMesa). Current on return.
/// Throws std::runtime_error if the installed Mesa cannot offer OpenGL 3.3 core.
/// Mesa reads LP_NUM_THREADS when the process makes its first context: 0 = draw in the calling thread alone.
std::unique_ptr<GlContext> makeOsMesaContext();

}  // namespace render
