#pragma once

#include "sim/core/types.h"
#include "sim/fabric/fabric.h"
#include "sim/grid/obstacles.h"
#include "sim/scene/scene.h"

#include <span>
#include <vector>

namespace sim {

/// A vertex that touches an obstacle.
struct ObstacleContact {
    int vertex = 0;
    Vec3 gradient = Vec3::Zero();   ///< of the penalty and of friction [dyn]
    Mat3 stiffness = Mat3::Zero();  ///< [dyn/cm]
};

/// Fabric on obstacles: a penalty on the signed distance at the end-of-step pose, without continuous collision detection: the sign
/// survives penetration, so that a fast obstacle never blocks the step (contact-design 3.2); lagged Coulomb friction relative to the
/// obstacle's motion (model-fabric 13.4).
class FabricObstacles {
 public:
    FabricObstacles() = default;
    /// Those of the scene that fabric feels.
    FabricObstacles(const Fabric& fabric, std::span<const ObstacleSettings> obstacles);

    bool empty() const { return bodies_.empty(); }
    /// Poses and motion of a step from t0 to t1 [s].
    void moveTo(double t0, double t1);
    /// Contacts at x, by vertex and then by obstacle. `start`: positions at the start of the step [cm]; mass [g]; h [s].
    /// `velocity`: given where x is a prediction, a step of free fall ahead, which presses far too hard and slides too fast: force and
    /// speed of friction then are those at the start of the step [cm/s]. Without, they are those at x.
    const std::vector<ObstacleContact>& at(const Fabric& fabric, std::span<const Vec3> x, std::span<const Vec3> start,
                                           std::span<const Vec3> velocity, std::span<const double> mass, double h);
    /// Deepest that a vertex's ball of its radius reaches into an obstacle [cm]; negative: the least gap.
    double deepest(const Fabric& fabric, std::span<const Vec3> x) const;

 private:
    struct Body {
        Obstacles pose;                     ///< the obstacle alone
        std::vector<double> friction;       ///< Coulomb's coefficient against each material of the fabric [-]
    };
    std::vector<Body> bodies_;
    std::vector<std::vector<ObstacleContact>> ofChunk_;
    std::vector<ObstacleContact> contacts_;
};

}  // namespace sim
