#include "sim/coupling/porous_elements.h"

namespace sim {

PorousElements::PorousElements(const Fabric& fabric)
{
    for (std::size_t e = 0; e < fabric.edges.size(); ++e) {
        const auto [a, b] = fabric.strands.radius[fabric.edges.strand[e]];
        vertices.push_back({fabric.edges.vertices[e][0], fabric.edges.vertices[e][1], -1});
        crossSection.push_back(kPi * a * b);
    }
    for (std::size_t f = 0; f < fabric.faces.size(); ++f) {
        const Vec3i& corner = fabric.faces.vertices[f];
        vertices.push_back({corner[0], corner[1], corner[2]});
        crossSection.push_back(fabric.faces.thickness[f]);
    }

    begin.assign(fabric.vertexCount() + 1, 0);
    for (std::size_t e = 0; e < size(); ++e)
        for (int c = 0; c < corners(e); ++c) ++begin[vertices[e][c] + 1];
    for (std::size_t v = 0; v < fabric.vertexCount(); ++v) begin[v + 1] += begin[v];
    at.resize(begin.back());
    std::vector<int> next(begin.begin(), begin.end() - 1);
    for (std::size_t e = 0; e < size(); ++e)
        for (int c = 0; c < corners(e); ++c) at[next[vertices[e][c]]++] = static_cast<int>(e);
}

}  // namespace sim
