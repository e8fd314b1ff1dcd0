#pragma once

#include "sim/core/types.h"
#include "sim/fabric/fabric.h"
#include "sim/fabric/friction_law.h"
#include "sim/grid/obstacles.h"
#include "sim/scene/scene.h"

#include <optional>
#include <span>
#include <vector>

namespace sim {

/// A vertex, or the middle of an edge, that touches an obstacle.
struct ObstacleContact {
    int vertex = 0, other = kNone;  ///< ends of the edge, or kNone
    Vec2i between = {0, 0};         ///< the point's number, vertices first, and the obstacle's among those that fabric feels
    Vec3 gradient = Vec3::Zero();   ///< of the penalty and of friction by the position of the point [dyn]
    Mat3 stiffness = Mat3::Zero();  ///< [dyn/cm]

    static constexpr int kNone = -1;
    bool isEdge() const { return other != kNone; }
};

/// Fabric on obstacles: a penalty on the signed distance of vertices and of the middles of edges at the end-of-step pose, without
/// continuous collision detection: the sign survives penetration, so that a fast obstacle never blocks the step (contact-design 3.2);
/// Coulomb's friction (friction.h) relative to the obstacle, which takes its forces along where it turns.
class FabricObstacles {
 public:
    FabricObstacles() = default;
    /// Those of the scene that fabric feels.
    FabricObstacles(const Fabric& fabric, std::span<const ObstacleSettings> obstacles);

    bool empty() const { return bodies_.empty(); }
    /// Poses and motion of a step from t0 to t1 [s].
    void moveTo(double t0, double t1);
    /// How the points of the fabric come into a step of h [s].
    struct Start {
        std::span<const Vec3> x;             ///< [cm]
        std::span<const double> mass;        ///< [g]
        const Grips& held;            ///< FabricState::onObstacles
        double h;
        /// Given where contacts are looked for at a prediction, a step of free fall ahead, which presses far too hard and slides too fast:
        /// force and slip of friction then follow from what presses at the start, and from where these moves [cm] and the friction that
        /// is held take the vertices.
        std::span<const Vec3> moves = {};
    };
    /// Contacts at x, of the vertices and then of the edges.
    const std::vector<ObstacleContact>& at(const Fabric& fabric, std::span<const Vec3> x, const Start& start);
    /// What of the friction is held at the end of the step, at x, where the contacts found last still touch.
    void keepFriction(const Fabric& fabric, std::span<const Vec3> x, const Start& start, Grips& held) const;
    /// Deepest that a vertex, or the middle of an edge, reaches with its radius into an obstacle [cm]; negative: the least gap.
    double deepest(const Fabric& fabric, std::span<const Vec3> x) const;

 private:
    struct Body {
        Obstacles pose;                     ///< the obstacle alone
        Motion motion;
        Eigen::Isometry3d carry;            ///< from where the obstacle is at the start of the step to where it is at the end
        std::vector<double> friction;       ///< Coulomb's coefficient against each material of the fabric [-]
    };
    /// A point of the fabric that may touch.
    struct Point {
        int number;       ///< ObstacleContact::between
        Vec3 x, start;    ///< [cm]
        double reach;     ///< distance at which it touches [cm]
        double mass;      ///< [g]
        int material;
        Vec3 move;        ///< Start::moves, where they are given [cm]
    };
    /// What a body does to a point.
    struct Touch {
        Vec3 normal;
        double push, stiffness;   ///< of the penalty [dyn, dyn/cm]
        Friction friction;
    };
    void findEdges(const Fabric& fabric);
    Point vertexPoint(const Fabric& fabric, int v, std::span<const Vec3> x, const Start& start) const;
    Point edgePoint(const Fabric& fabric, int edge, std::span<const Vec3> x, const Start& start) const;
    std::optional<Touch> touch(const Point& point, int obstacle, const Start& start) const;
    Vec3 collect(const Point& point, int vertex, int other, const Start& start, std::vector<ObstacleContact>& out) const;
    bool touches(const Vec3& x, double reach) const;

    std::vector<Body> bodies_;
    std::vector<Vec2i> edges_;              ///< of yarns and of cloth
    std::vector<double> share_;             ///< of each vertex: part of its mass that each of its edges stands for [-]
    std::vector<double> nearest_;           ///< of each vertex: distance of the nearest obstacle [cm]
    std::vector<Vec3> pushedOut_;           ///< of each vertex: how far it is pushed out of obstacles [cm]
    std::vector<std::vector<ObstacleContact>> ofChunk_;
    std::vector<ObstacleContact> contacts_;
};

}  // namespace sim
