#include "render/gl_context_glfw.h"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

namespace render {

namespace {

class GlfwContext final : public GlContext {
 public:
    explicit GlfwContext(GLFWwindow* window) : window_(window)
    {
        GlfwContext::makeCurrent();
        gl_ = loadGl([](const char* name) { return reinterpret_cast<void*>(glfwGetProcAddress(name)); });
        collectMessages();
    }
    void makeCurrent() override
    {
        if (glfwGetCurrentContext() != window_) glfwMakeContextCurrent(window_);
    }

 private:
    /// Where the driver tells what it does not like; it does in a debug context.
    void collectMessages()
    {
        const bool isKhr = glfwExtensionSupported("GL_KHR_debug") == GLFW_TRUE;
        const bool isArb = glfwExtensionSupported("GL_ARB_debug_output") == GLFW_TRUE;
        const char* const name = isKhr ? "glDebugMessageCallback" : isArb ? "glDebugMessageCallbackARB" : nullptr;
        const auto listen = name == nullptr ? nullptr : reinterpret_cast<PFNGLDEBUGMESSAGECALLBACKPROC>(glfwGetProcAddress(name));
        if (listen == nullptr) return;
        if (isKhr) gl_.Enable(GL_DEBUG_OUTPUT);
        gl_.Enable(GL_DEBUG_OUTPUT_SYNCHRONOUS);
        listen(&GlfwContext::hear, this);
        hasMessages_ = true;
    }
    static void APIENTRY hear(GLenum, GLenum type, GLuint, GLenum, GLsizei, const GLchar* message, const void* context)
    {
        if (type != GL_DEBUG_TYPE_ERROR) return;
        static_cast<GlfwContext*>(const_cast<void*>(context))->complain(message);
    }

    GLFWwindow* const window_;
};

}  // namespace

std::unique_ptr<GlContext> contextOf(GLFWwindow* window) { return std::make_unique<GlfwContext>(window); }

}  // namespace render
