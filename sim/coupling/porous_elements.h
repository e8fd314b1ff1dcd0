#pragma once

#include "sim/fabric/fabric.h"

#include <array>
#include <vector>

namespace sim {

/// What liquid in fabric moves through and drips from: yarn edges, then faces, alike but for the number of their corners.
struct PorousElements {
    std::vector<std::array<int, 3>> vertices;  ///< the third of an edge is −1
    std::vector<double> crossSection;          ///< area of an edge [cm^2], thickness of a face [cm]
    std::vector<int> begin, at;                ///< elements of vertex v: at[begin[v]] … at[begin[v + 1] − 1]

    explicit PorousElements(const Fabric& fabric);
    std::size_t size() const { return vertices.size(); }
    int corners(std::size_t e) const { return vertices[e][2] < 0 ? 2 : 3; }
};

}  // namespace sim
