#include "sim/coupling/wet_elements.h"

#include <Eigen/Geometry>

#include <cmath>

namespace sim {

namespace {

/// Perimeter of an ellipse (Ramanujan's second formula) [cm].
double perimeter(double a, double b)
{
    const double h = std::pow((a - b) / (a + b), 2);
    return kPi * (a + b) * (1.0 + 3.0 * h / (10.0 + std::sqrt(4.0 - 3.0 * h)));
}

}  // namespace

WetElements::WetElements(const Fabric& fabric)
{
    std::vector<double> surface;  // that falls to each corner [cm^2]
    for (std::size_t e = 0; e < fabric.edges.size(); ++e) {
        const auto [a, b] = fabric.strands.radius[fabric.edges.strand[e]];
        vertices.push_back({fabric.edges.vertices[e][0], fabric.edges.vertices[e][1], -1});
        crossSection.push_back(kPi * a * b);
        surface.push_back(0.5 * fabric.edges.restLength[e] * perimeter(a, b));
    }
    for (std::size_t f = 0; f < fabric.faces.size(); ++f) {
        const Vec3i& corner = fabric.faces.vertices[f];
        const Vec3& x = fabric.rest[corner[0]];
        vertices.push_back({corner[0], corner[1], corner[2]});
        crossSection.push_back(fabric.faces.thickness[f]);
        surface.push_back((fabric.rest[corner[1]] - x).cross(fabric.rest[corner[2]] - x).norm() / 6.0);
    }

    std::vector<double> whole(fabric.vertexCount(), 0.0);
    begin.assign(fabric.vertexCount() + 1, 0);
    for (std::size_t e = 0; e < size(); ++e)
        for (int c = 0; c < corners(e); ++c) {
            whole[vertices[e][c]] += surface[e];
            ++begin[vertices[e][c] + 1];
        }
    for (std::size_t v = 0; v < fabric.vertexCount(); ++v) begin[v + 1] += begin[v];
    at.resize(begin.back());
    std::vector<int> next(begin.begin(), begin.end() - 1);
    for (std::size_t e = 0; e < size(); ++e) {
        share.push_back({0.0, 0.0, 0.0});
        for (int c = 0; c < corners(e); ++c) {
            share[e][c] = surface[e] / whole[vertices[e][c]];
            at[next[vertices[e][c]]++] = static_cast<int>(e);
        }
    }
}

}  // namespace sim
