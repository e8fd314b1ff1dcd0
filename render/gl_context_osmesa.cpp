#include "render/gl_context.h"

#include <GL/osmesa.h>

#include <array>
#include <cstdint>
#include <mutex>
#include <stdexcept>

namespace render {

namespace {

/// OSMesa keeps lists of its own that are not locked: making, binding and destroying contexts take turns.
std::mutex& osMesaLock()
{
    static std::mutex lock;
    return lock;
}

class OsMesaContext final : public GlContext {
 public:
    OsMesaContext()
    {
        {
            const std::lock_guard guard(osMesaLock());
            const std::array attributes = {OSMESA_FORMAT, OSMESA_RGBA, OSMESA_DEPTH_BITS, 0, OSMESA_STENCIL_BITS, 0,
                                           OSMESA_PROFILE, OSMESA_CORE_PROFILE, OSMESA_CONTEXT_MAJOR_VERSION, 3,
                                           OSMESA_CONTEXT_MINOR_VERSION, 3, 0};
            context_ = OSMesaCreateContextAttribs(attributes.data(), nullptr);
        }
        if (context_ == nullptr)
            throw std::runtime_error("OSMesa cannot make an OpenGL 3.3 core context (is libosmesa6 installed?)");
        try {
            OsMesaContext::makeCurrent();
            gl_ = loadGl([](const char* name) { return reinterpret_cast<void*>(OSMesaGetProcAddress(name)); });
        } catch (...) {
            destroy();
            throw;
        }
    }

    ~OsMesaContext() override { destroy(); }

    void makeCurrent() override
    {
        const std::lock_guard guard(osMesaLock());
        if (OSMesaGetCurrentContext() == context_) return;
        if (!OSMesaMakeCurrent(context_, window_.data(), GL_UNSIGNED_BYTE, kWindowSize, kWindowSize))
            throw std::runtime_error("OSMesa cannot make its context current");
    }

 private:
    void destroy()
    {
        const std::lock_guard guard(osMesaLock());
        OSMesaDestroyContext(context_);
    }

    // Pictures are drawn into framebuffer objects; the window OSMesa insists on stays unused.
    static constexpr int kWindowSize = 4;
    std::array<std::uint32_t, kWindowSize * kWindowSize> window_{};
    OSMesaContext context_ = nullptr;
};

}  // namespace

std::unique_ptr<GlContext> makeOsMesaContext()
{
    return std::make_unique<OsMesaContext>();
}

}  // namespace render
