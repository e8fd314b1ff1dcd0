#include "render/gl_context.h"

#include <GL/osmesa.h>
#include <dlfcn.h>

#include <array>
#include <cstdint>
#include <mutex>
#include <stdexcept>
#include <string>

namespace render {

namespace {

/// OSMesa keeps lists of its own that are not locked: making, binding and destroying contexts take turns.
std::mutex& osMesaLock()
{
    static std::mutex lock;
    return lock;
}

/// OSMesa, loaded when the first picture is drawn: it brings a compiler of some 50 MB, which runs without pictures do
/// without.
class OsMesa {
 public:
    OsMesa()
    {
        load(create, "OSMesaCreateContextAttribs");
        load(destroy, "OSMesaDestroyContext");
        load(makeCurrent, "OSMesaMakeCurrent");
        load(current, "OSMesaGetCurrentContext");
        load(procedure, "OSMesaGetProcAddress");
    }

    decltype(&OSMesaCreateContextAttribs) create;
    decltype(&OSMesaDestroyContext) destroy;
    decltype(&OSMesaMakeCurrent) makeCurrent;
    decltype(&OSMesaGetCurrentContext) current;
    decltype(&OSMesaGetProcAddress) procedure;

 private:
    template <class F>
    void load(F& function, const char* name)
    {
        if (library_ == nullptr) library_ = dlopen(RENDER_OSMESA_LIBRARY, RTLD_NOW | RTLD_LOCAL);
        void* const symbol = library_ != nullptr ? dlsym(library_, name) : nullptr;
        if (symbol == nullptr) throw std::runtime_error(std::string("OSMesa cannot be loaded (is libosmesa6 installed?): ") + dlerror());
        function = reinterpret_cast<F>(symbol);
    }

    void* library_ = nullptr;  ///< stays loaded to the end of the program
};

const OsMesa& osMesa()
{
    static const OsMesa library;
    return library;
}

class OsMesaContext final : public GlContext {
 public:
    OsMesaContext()
    {
        {
            const std::lock_guard guard(osMesaLock());
            const std::array attributes = {OSMESA_FORMAT,
                                           OSMESA_RGBA,
                                           OSMESA_DEPTH_BITS,
                                           0,
                                           OSMESA_STENCIL_BITS,
                                           0,
                                           OSMESA_PROFILE,
                                           OSMESA_CORE_PROFILE,
                                           OSMESA_CONTEXT_MAJOR_VERSION,
                                           3,
                                           OSMESA_CONTEXT_MINOR_VERSION,
                                           3,
                                           0};
            context_ = osMesa().create(attributes.data(), nullptr);
        }
        if (context_ == nullptr) throw std::runtime_error("OSMesa cannot make an OpenGL 3.3 core context");
        try {
            OsMesaContext::makeCurrent();
            gl_ = loadGl([](const char* name) { return reinterpret_cast<void*>(osMesa().procedure(name)); });
        } catch (...) {
            destroy();
            throw;
        }
    }

    ~OsMesaContext() override { destroy(); }

    void makeCurrent() override
    {
        const std::lock_guard guard(osMesaLock());
        if (osMesa().current() == context_) return;
        if (!osMesa().makeCurrent(context_, window_.data(), GL_UNSIGNED_BYTE, kWindowSize, kWindowSize))
            throw std::runtime_error("OSMesa cannot make its context current");
    }

 private:
    void destroy()
    {
        const std::lock_guard guard(osMesaLock());
        osMesa().destroy(context_);
    }

    // Pictures are drawn into framebuffer objects; the window OSMesa insists on stays unused.
    static constexpr int kWindowSize = 4;
    std::array<std::uint32_t, kWindowSize * kWindowSize> window_{};
    OSMesaContext context_ = nullptr;
};

}  // namespace

std::unique_ptr<GlContext> makeOsMesaContext() { return std::make_unique<OsMesaContext>(); }

}  // namespace render
