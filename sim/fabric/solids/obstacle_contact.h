#pragma once

#include "sim/core/types.h"
#include "sim/fabric/cohesion.h"
#include "sim/fabric/fabric.h"
#include "sim/fabric/friction_law.h"
#include "sim/fabric/solids/solid_limiter.h"
#include "sim/grid/obstacles.h"
#include "sim/obstacle_settings.h"

#include <array>
#include <optional>
#include <span>
#include <vector>

namespace sim {

/// A vertex, the middle of an edge, or the nearest point of an edge or a face, that touches an obstacle.
struct ObstacleContact {
    int vertex = 0, other = kNone;  ///< ends of the edge, or kNone
    Vec2i between = {0, 0};         ///< number of the point (vertices, middles, nearest points), and of the obstacle among those felt
    Vec3 gradient = Vec3::Zero();   ///< gradient of the penalty and of friction by the position of the point [dyn]
    Mat3 stiffness = Mat3::Zero();  ///< [dyn/cm]
    Vec3 place = Vec3::Zero();      ///< place of the point where these are [cm]
    int third = kNone;              ///< corner of a face, or kNone
    Vec3 weights = Vec3::Zero();    ///< weights of the corners at a nearest point; zero for a vertex or a middle [-]
    double pull = 0.0;              ///< force of a liquid bridge on a vertex, part of the gradient [dyn]

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
/// nearest, at the end-of-step pose (fabric/README.md, Solids); SolidLimiter keeps them in front of the surface. With it Coulomb's friction
/// (friction.h) relative to the obstacle, which takes its forces along where it turns. At nearest
/// points, which wander along their edge or face, it remembers those of the edge or face.
class FabricObstacles {
 public:
    FabricObstacles() = default;
    /// Obstacles of the scene that fabric feels.
    /// @param cohesion  liquid bridges of wet fabric, taken up before each step; null without
    FabricObstacles(const Fabric& fabric, std::span<const ObstacleSettings> obstacles, const Cohesion* cohesion = nullptr);

    bool empty() const { return bodies_.empty(); }
    /// Number in the scene of an obstacle among those felt (ObstacleContact::between).
    int inScene(int obstacle) const { return bodies_[obstacle].inScene; }
    /// Nearest of the obstacles felt to a place.
    int nearest(const Vec3& x) const;
    /// Displacement in the step of a place on one of the obstacles felt [cm].
    Vec3 moved(int obstacle, const Vec3& place) const { return bodies_[obstacle].carry * place - place; }
    /// Poses and motion of a step from t0 to t1 [s].
    void moveTo(double t0, double t1);
    /// How the points of the fabric come into a step of h [s].
    struct Start {
        std::span<const Vec3> x;       ///< [cm]
        std::span<const double> mass;  ///< [g]
        const FrictionForces& held;    ///< FabricState::onObstacles
        double h, springStep;          ///< (springStepFor) [s]
        /// Given where contacts are looked for at a prediction, a step of free fall ahead, which presses far too hard and slides too fast:
        /// force and slip of friction then follow from what presses at the start, and from where these moves [cm] and the friction that
        /// is held take the vertices.
        std::span<const Vec3> moves = {};
    };
    /// Contacts that were found in a step, until others are looked for.
    class Found {
     public:
        const std::vector<ObstacleContact>& contacts() const { return in_->contacts_; }
        /// What of the friction is held at the end of the step, at x, where they still touch: what acted there according to their gradients and
        /// stiffnesses.
        /// @param acceleration  of the vertices by forces, if the next step expects these to go on: loses what friction did and no longer does,
        ///                      which after a blow is most of it [cm/s^2]
        void storeFriction(std::span<const Vec3> x, const Start& start, FrictionForces& held, std::span<Vec3> acceleration = {}) const;
        /// Energy that they hold at x, in their penalty and in the friction that is held there [erg].
        double storedEnergy(std::span<const Vec3> x, const Start& start, const FrictionForces& held) const;
        /// Energy that they hold at x in liquid bridges, 0 or below [erg].
        double bridgeEnergy(std::span<const Vec3> x) const;

     private:
        friend FabricObstacles;
        Found(FabricObstacles& in, const Fabric& fabric) : in_(&in), fabric_(&fabric) {}
        FabricObstacles* in_;
        const Fabric* fabric_;
    };
    /// Contacts at x, of the vertices, then of the edges, then of the points of edges and faces that touch besides.
    Found findContacts(const Fabric& fabric, std::span<const Vec3> x, const Start& start, std::span<const NearestPoint> nearest = {});
    /// Deepest that a vertex, or the middle of an edge, reaches with its radius into an obstacle [cm]; negative: the least gap.
    double deepest(const Fabric& fabric, std::span<const Vec3> x) const;

 private:
    struct Body {
        int inScene;     ///< number in the scene
        Obstacles pose;  ///< the obstacle alone
        Motion motion;
        Eigen::Isometry3d carry;       ///< motion of the obstacle from the start of the step to its end
        std::vector<double> friction;  ///< Coulomb's coefficient against each material of the fabric [-]
        bool isCohesive;
    };
    /// A point of the fabric that may touch.
    struct Point {
        int number;     ///< ObstacleContact::between
        Vec3 x, start;  ///< [cm]
        double reach;   ///< distance at which it touches [cm]
        double mass;    ///< [g]
        int material;
        Vec3 move;                        ///< Start::moves, where they are given [cm]
        double pull = 0.0, bridge = 0.0;  ///< force of a liquid bridge [dyn], and its length beyond the reach [cm]
    };
    /// What a body does to a point.
    struct Touch {
        Vec3 normal;
        double overlap, pull, push, stiffness;  ///< pull of a bridge [dyn]; of the penalty [cm, dyn, dyn/cm], without overlap none
        Friction friction;
    };
    void findEdges(const Fabric& fabric);
    Point vertexPoint(const Fabric& fabric, int v, std::span<const Vec3> x, const Start& start) const;
    Point edgePoint(const Fabric& fabric, int edge, std::span<const Vec3> x, const Start& start) const;
    Point nearestPoint(const Fabric& fabric, const NearestPoint& p, std::span<const Vec3> x, const Start& start) const;
    static double stiffnessOf(const Point& point, const Start& start);
    std::optional<Touch> touch(const Point& point, int obstacle, const Start& start) const;
    Point pointOf(const Fabric& fabric, const ObstacleContact& contact, std::span<const Vec3> x, const Start& start) const;
    double bridgeForceOf(const Point& point, int obstacle) const;
    Vec3 collect(const Point& point, int obstacle, const ObstacleContact& corners, const Start& start, std::vector<ObstacleContact>& out) const;
    Vec3 collect(const Point& point, const ObstacleContact& corners, const Start& start, std::vector<ObstacleContact>& out) const;
    bool touches(const Vec3& x, double reach) const;

    const Cohesion* cohesion_ = nullptr;
    std::vector<Body> bodies_;
    std::vector<Vec2i> edges_;     ///< edges of yarns and of cloth
    std::vector<double> share_;    ///< part of each vertex' mass that each of its edges stands for [-]
    std::vector<double> nearest_;  ///< distance of each vertex from the nearest obstacle [cm]
    std::vector<Vec3> pushedOut_;  ///< displacement by which each vertex is pushed out of obstacles [cm]
    std::vector<std::vector<ObstacleContact>> ofChunk_;
    std::vector<ObstacleContact> contacts_;
    std::vector<std::optional<Vec3>> keptForce_;  ///< force of friction at them at the end of the step [dyn]
    std::vector<Vec3> lostForce_;                 ///< what friction acted with in the step beyond that [dyn]
};

}  // namespace sim
