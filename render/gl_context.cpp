#include "render/gl_context.h"

#include <utility>

namespace render {

std::vector<std::string> GlContext::takeComplaints()
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
