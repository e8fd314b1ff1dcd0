#pragma once

#include "sim/grid/obstacles.h"

namespace sim {

/// Fraction of a square face that is outside the solid, from the distances at its corners, going round (grid/README.md, Open fractions), and the
/// share of the edge from each corner to the next before the surface, read where these two are on different sides. Without a corner outside it is
/// closed: also a face in the plane of a wall, all of whose corners are 0.
double openFraction(const std::array<double, 4>& distance, const std::array<double, 4>& crossing);

/// How far the faces of one block are open: by the distances at their corners, and, where more than one surface or an edge of a solid is on
/// a face, those at the corners of ever smaller parts of it.
class OpenFaces {
 public:
    /// @param solid  the only one that counts, or all
    OpenFaces(const BlockGrid& grid, int block, const Obstacles& obstacles, int solid = Obstacles::kAll);

    /// Open fraction of the face normal to `axis` at the lower side of cell (i, j, k), one of which may be 8.
    double open(int axis, int i, int j, int k) const;

 private:
    static constexpr int kEdge = kBlockEdge + 1;
    static constexpr int index(int i, int j, int k) { return (k * kEdge + j) * kEdge + i; }

    /// Part of a face: from the corner `low` along u and v [cm], with the distances at its corners.
    struct Part {
        Vec3 low, u, v;
        std::array<double, 4> distance;
    };
    double distanceAt(const Vec3& x) const;
    double openPart(const Part& part, int depth) const;
    double openWithin(const Part& part) const;
    double crossing(const Vec3& from, const Vec3& to, double first, double last) const;

    const BlockGrid& grid_;
    const Obstacles& obstacles_;
    int solid_;
    Vec3 corner_;
    std::array<double, kEdge * kEdge * kEdge> distance_;  ///< distance to the nearest of the solids that count, at the 9³ nodes [cm]
};

}  // namespace sim
