#pragma once

#include "sim/shapes/triangle_mesh.h"

#include <Eigen/Geometry>

#include <array>

namespace sim {

/// Bounding boxes around triangles, halved again and again: for the nearest point of a mesh and for its winding number.
class TriangleTree {
 public:
    /// Triangles without area are left out.
    explicit TriangleTree(const TriangleMesh& mesh);

    bool empty() const { return corners_.empty(); }

    /// The nearest triangle.
    struct Nearest {
        double distance;  ///< [cm]
        int triangle;     ///< number in the tree
    };
    /// `guess` is a triangle of the tree: the nearer it is, the quicker the search.
    Nearest nearest(const Vec3& x, int guess = 0) const;

    /// How often the mesh goes around x: 1 inside and 0 outside of a closed one, in between near holes. Far groups of
    /// triangles act as one, to a few percent. Source: Barill et al. 2018, "Fast Winding Numbers for Soups and Clouds".
    double windingNumber(const Vec3& x) const;

    /// Negative for a closed mesh that is turned inside out [cm^3].
    double signedVolume() const;

 private:
    using Corners = std::array<Vec3, 3>;
    struct Node {
        Eigen::AlignedBox3d box;
        Vec3 areaNormal = Vec3::Zero();  ///< sum of the triangles' area vectors
        Vec3 middle = Vec3::Zero();      ///< mean place of the triangles, weighted by area
        double radius = 0.0;             ///< radius of the ball around the middle that holds them all
        int first = 0, last = 0;         ///< range of triangles
        int right = 0;                   ///< second child; the first is the next node; 0 for a leaf
    };

    int build(int first, int last);

    std::vector<Corners> corners_;
    std::vector<Node> nodes_;
};

}  // namespace sim
