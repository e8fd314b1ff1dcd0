#include "render/gl.h"

#include <stdexcept>
#include <string>

namespace render {

const char* glErrorName(GLenum error)
{
    switch (error) {
        case GL_INVALID_ENUM: return "invalid enum";
        case GL_INVALID_VALUE: return "invalid value";
        case GL_INVALID_OPERATION: return "invalid operation";
        case GL_INVALID_FRAMEBUFFER_OPERATION: return "incomplete framebuffer";
        case GL_OUT_OF_MEMORY: return "out of memory";
        default: return "unknown error";
    }
}

Gl loadGl(const std::function<void*(const char*)>& getProcAddress)
{
    Gl gl;
#define RENDER_GL_LOAD(type, name)                                \
    gl.name = reinterpret_cast<type>(getProcAddress("gl" #name)); \
    if (gl.name == nullptr) throw std::runtime_error("OpenGL: this context has no function gl" #name);
    RENDER_GL_FUNCTIONS(RENDER_GL_LOAD)
#undef RENDER_GL_LOAD
    return gl;
}

void requireNoGlError(const Gl& gl, const char* doing)
{
    const GLenum error = gl.GetError();
    if (error != GL_NO_ERROR) throw std::runtime_error(std::string("OpenGL: ") + glErrorName(error) + " while " + doing);
}

}  // namespace render
