#include "render/gl_context.h"

#include <algorithm>
#include <array>
#include <utility>

namespace render {

bool GlContext::isSoftware() const
{
    const std::string name = rendererName();
    constexpr std::array kNames = {"llvmpipe", "softpipe", "swrast", "SWR", "Software", "SwiftShader", "GDI Generic"};
    return std::ranges::any_of(kNames, [&](const char* known) { return name.find(known) != std::string::npos; });
}

std::vector<std::string> GlContext::takeGlMessages()
{
    if (!hasMessages_)
        if (const GLenum error = gl_.GetError(); error != GL_NO_ERROR) complain(glErrorName(error));
    return std::exchange(complaints_, {});
}

void GlContext::complain(const std::string& message)
{
    constexpr std::size_t kMost = 100;  // that wait to be taken
    if (complaints_.size() < kMost) complaints_.push_back(message);
}

}  // namespace render
