#pragma once

#include "sim/core/types.h"
#include "sim/fabric/fabric.h"
#include "sim/grid/obstacles.h"
#include "sim/scene/scene.h"

#include <span>
#include <vector>

namespace sim {

/// A vertex, or the middle of an edge, that touches an obstacle.
struct ObstacleContact {
    int vertex = 0, other = kNone;  ///< ends of the edge, or kNone
    Vec3 gradient = Vec3::Zero();   ///< of the penalty and of friction by the position of the point [dyn]
    Mat3 stiffness = Mat3::Zero();  ///< [dyn/cm]

    static constexpr int kNone = -1;
    bool isEdge() const { return other != kNone; }
};

/// Fabric on obstacles: a penalty on the signed distance of vertices and of the middles of edges at the end-of-step pose, without
/// continuous collision detection: the sign survives penetration, so that a fast obstacle never blocks the step (contact-design 3.2);
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
    const std::vector<ObstacleContact>& at(const Fabric& fabric, std::span<const Vec3> x, std::span<const Vec3> start,
                                           std::span<const Vec3> velocity, std::span<const double> mass, double h);
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
