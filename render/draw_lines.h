#pragma once

#include "render/frame_view.h"
#include "render/gl_objects.h"
#include "render/view_transforms.h"

#include <span>

namespace render {

/// Line segments over the finished scene. They are hidden by what is in front of them, hide nothing themselves, and
/// their edges are smooth with one sample too. The rims of all lie below all.
class DrawLines {
 public:
    DrawLines(const Gl& gl, const std::filesystem::path& shaderDir);
    void draw(std::span<const FrameView::Lines> groups, const ViewTransforms& transforms);

 private:
    void drawGroup(const FrameView::Lines& lines, const Eigen::Vector3f& color, float rim, const ViewTransforms& transforms);

    const Gl& gl_;
    Program program_;
    VertexArray vertices_;
    Buffer segments_;
};

}  // namespace render
