#pragma once

#include "sim/core/types.h"
#include "sim/fabric/fabric.h"
#include "sim/fabric/solids/guard.h"
#include "sim/grid/obstacles.h"
#include "sim/scene/scene.h"

#include <array>
#include <span>
#include <vector>

namespace sim {

/// A vertex, the middle of an edge, or the nearest point of an edge or a face, that touches an obstacle.
struct ObstacleContact {
    int vertex = 0, other = kNone;  ///< ends of the edge, or kNone
    Vec3 gradient = Vec3::Zero();   ///< of the penalty and of friction by the position of the point [dyn]
    Mat3 stiffness = Mat3::Zero();  ///< [dyn/cm]
    int third = kNone;              ///< corner of a face, or kNone
    Vec3 weights = Vec3::Zero();    ///< of the corners at a nearest point; zero for a vertex or a middle [-]

    static constexpr int kNone = -1;
    bool isEdge() const { return other != kNone; }
    /// Vertices and their shares in the point; what there is none of is the first vertex again, with the share 0.
    std::array<int, 3> vertices() const { return {vertex, isEdge() ? other : vertex, third != kNone ? third : vertex}; }
    std::array<double, 3> shares() const
    {
        if (!weights.isZero()) return {weights[0], weights[1], weights[2]};
        return {isEdge() ? 0.5 : 1.0, isEdge() ? 0.5 : 0.0, 0.0};
    }
};

/// Fabric on obstacles: a penalty on the signed distance of vertices, of the middles of edges and of the points at which edges and faces are
/// nearest, at the end-of-step pose (contact-design 3.2); SolidGuard keeps them in front of the surface. With it
/// lagged Coulomb friction relative to the obstacle's motion (model-fabric 13.4).
class FabricObstacles {
 public:
    FabricObstacles() = default;
    /// Those of the scene that fabric feels.
    FabricObstacles(const Fabric& fabric, std::span<const ObstacleSettings> obstacles);

    bool empty() const { return bodies_.empty(); }
    /// Poses and motion of a step from t0 to t1 [s].
    void moveTo(double t0, double t1);
    /// Contacts at x, of the vertices and then of the edges. `start`: positions at the start of the step [cm]; mass [g]; h [s].
    /// `velocity`: given where x is a prediction, a step of free fall ahead, which presses far too hard and slides too fast: force and
    /// speed of friction then are those at the start of the step [cm/s]. Without, they are those at x.
    /// `nearest`: points of edges and faces that touch besides.
    const std::vector<ObstacleContact>& at(const Fabric& fabric, std::span<const Vec3> x, std::span<const Vec3> start,
                                           std::span<const Vec3> velocity, std::span<const double> mass, double h,
                                           std::span<const NearestPoint> nearest = {});
    /// Deepest that a vertex, or the middle of an edge, reaches with its radius into an obstacle [cm]; negative: the least gap.
    double deepest(const Fabric& fabric, std::span<const Vec3> x) const;

 private:
    struct Body {
        Obstacles pose;                     ///< the obstacle alone
        std::vector<double> friction;       ///< Coulomb's coefficient against each material of the fabric [-]
    };
    /// A point of the fabric that may touch.
    struct Point {
        Vec3 x, start;    ///< [cm]
        double reach;     ///< distance at which it touches [cm]
        double mass;      ///< [g]
        int material;
        const Vec3* velocity;  ///< at the start of the step, where friction goes by it [cm/s]; or null
    };
    void findEdges(const Fabric& fabric);
    void touch(const Point& point, double h, auto&& give) const;

    std::vector<Body> bodies_;
    std::vector<Vec2i> edges_;              ///< of yarns and of cloth
    std::vector<double> share_;             ///< of each vertex: part of its mass that each of its edges stands for [-]
    std::vector<double> nearest_;           ///< of each vertex: distance of the nearest obstacle [cm]
    std::vector<std::vector<ObstacleContact>> ofChunk_;
    std::vector<ObstacleContact> contacts_;
};

}  // namespace sim
