#pragma once

#include "render/gl_context.h"

struct GLFWwindow;

namespace render {

/// The context of a window, which must outlive it. Current on return.
/// Throws std::runtime_error if it lacks something of OpenGL 3.3 core.
std::unique_ptr<GlContext> contextOf(GLFWwindow* window);

}  // namespace render
