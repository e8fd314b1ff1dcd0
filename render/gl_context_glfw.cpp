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
    }
    void makeCurrent() override
    {
        if (glfwGetCurrentContext() != window_) glfwMakeContextCurrent(window_);
    }

 private:
    GLFWwindow* const window_;
};

}  // namespace

std::unique_ptr<GlContext> contextOf(GLFWwindow* window)
{
    return std::make_unique<GlfwContext>(window);
}

}  // namespace render
