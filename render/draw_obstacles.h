#pragma once

#include "render/frame_view.h"
#include "render/gl_objects.h"
#include "render/look.h"
#include "render/view_transforms.h"

#include <span>

namespace render {

/// Obstacles. Solid ones come before the liquid, with depth, and alpha 0: the picture's pixels that are shaded as
/// solids. All others come over the finished liquid: faint faces and clean outlines. They are hidden by liquid in front
/// of them and never write depth; of containers only the far walls are filled, so the liquid inside keeps its colours.
class DrawObstacles {
 public:
    DrawObstacles(const Gl& gl, const std::filesystem::path& shaderDir);
    void drawSolid(std::span<const FrameView::Mesh> meshes, const ViewTransforms& transforms, const ObstacleLook& look);
    void draw(std::span<const FrameView::Mesh> meshes, const ViewTransforms& transforms, const ObstacleLook& look);

 private:
    void drawFaces(GLenum culled, GLsizei vertices, const ViewTransforms& transforms, const ObstacleLook& look) const;
    void drawEdges(GLsizei edges, const ViewTransforms& transforms, const ObstacleLook& look) const;

    const Gl& gl_;
    Program faceProgram_, edgeProgram_, solidProgram_;
    VertexArray faceVertices_, edgeVertices_;
    Buffer faces_, edges_;
};

}  // namespace render
