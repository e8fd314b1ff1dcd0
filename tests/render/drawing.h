#pragma once

#include "render/renderer.h"

#include <cmath>
#include <numbers>
#include <vector>

/// A renderer with a context of its own and a few particles to draw: 320 x 180, no overlay, one sample, seen from
/// (0, 0, 10) with a vertical field of view of 40 degrees.
struct Drawing {
    Drawing()
    {
        look.width = 320;
        look.height = 180;
        look.samples = 1;
        look.overlay = {.label = "", .timeStamp = false, .colorBar = false, .colorBarTitle = ""};
        camera.eye = {0.0, 0.0, 10.0};
    }

    void add(const Eigen::Vector3f& x, float value) { positions.push_back(x), values.push_back(value); }
    render::FrameView view() const { return {0.0, {positions, values, radius}, meshes}; }
    render::Image draw() { return renderer.draw(view(), camera, look); }

    /// Radius of a ball's outline in the picture, its centre on the axis `distance` away [pixels].
    double outlineRadius(double distance) const
    {
        const double pixelsPerTangent = 0.5 * look.height / std::tan(0.5 * camera.fovDegrees * std::numbers::pi / 180.0);
        return pixelsPerTangent * radius / std::sqrt(distance * distance - radius * radius);
    }

    std::unique_ptr<render::GlContext> context = render::makeOsMesaContext();
    render::Renderer renderer{*context};
    std::vector<Eigen::Vector3f> positions;
    std::vector<float> values;
    std::vector<render::FrameView::Mesh> meshes;
    float radius = 1.0f;  ///< of every particle [cm]
    render::Camera camera;
    render::Look look;
};

/// A cube from −half to half, faces outwards.
struct CubeMesh {
    explicit CubeMesh(float half)
    {
        for (int i = 0; i < 8; ++i) positions.emplace_back((i & 1 ? half : -half), (i & 2 ? half : -half), (i & 4 ? half : -half));
        triangles = {{0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}, {0, 1, 5}, {0, 5, 4},
                     {2, 6, 7}, {2, 7, 3}, {0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}};
    }
    render::FrameView::Mesh mesh(bool inside) const { return {positions, triangles, inside}; }
    std::vector<Eigen::Vector3f> positions;
    std::vector<Eigen::Vector3i> triangles;
};

inline int countUnlike(const render::Image& image, render::Rgb background)
{
    int count = 0;
    for (int y = 0; y < image.height; ++y)
        for (int x = 0; x < image.width; ++x) count += image.color(x, y) != background;
    return count;
}
