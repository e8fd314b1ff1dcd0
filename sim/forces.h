#pragma once

#include "sim/core/types.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <vector>

namespace sim {

/// Momentum that something gets in a step, and its moment about the origin of the scene.
struct Impulse {
    Vec3 linear = Vec3::Zero();   ///< [g cm/s]
    Vec3 angular = Vec3::Zero();  ///< [g cm^2/s]

    /// Impulse of a momentum that something gets at a place.
    static Impulse at(const Vec3& place, const Vec3& momentum) { return {momentum, place.cross(momentum)}; }
    Impulse& operator+=(const Impulse& other)
    {
        linear += other.linear;
        angular += other.angular;
        return *this;
    }
    Impulse operator-() const { return {-linear, -angular}; }
    Impulse& operator-=(const Impulse& other) { return *this += -other; }
    friend Impulse operator+(Impulse a, const Impulse& b) { return a += b; }
    friend Impulse operator-(Impulse a, const Impulse& b) { return a -= b; }
    friend Impulse operator*(double factor, const Impulse& impulse) { return {factor * impulse.linear, factor * impulse.angular}; }
};

/// What acts on a solid or a fabric in a step.
struct Load {
    Impulse liquid;   ///< impulse by liquid: pressure, drag, friction at walls, and the momentum of what fabric takes up and lets go
    Impulse contact;  ///< impulse by contact: fabric on solids, solids and other fabric on fabric
    Impulse sum() const { return liquid + contact; }
};

/// Where the momentum of liquid and fabric together went in a step [g cm/s]:
/// change = weight + entered − left − what solids and pins got + unresolved.
struct MomentumBalance {
    Vec3 change = Vec3::Zero();
    Vec3 weight = Vec3::Zero();
    Vec3 entered = Vec3::Zero();     ///< momentum that came with liquid from sources and through openings, and what these gave to the liquid
    Vec3 left = Vec3::Zero();        ///< momentum that went with liquid that left the domain
    Vec3 borne = Vec3::Zero();       ///< part of what solids and pins got that no force explains (MomentumBudget), taken from liquid and fabric
    Vec3 unresolved = Vec3::Zero();  ///< momentum that no force explains and nothing bears, given to liquid and fabric
};

/// What acted on everything in a step of dt [s], whose mean forces are these impulses over dt. Empty before the first step, and where there is
/// neither a solid nor fabric.
struct Forces {
    double dt = 0.0;              ///< [s]
    std::vector<Load> obstacles;  ///< loads of each of the scene's obstacles
    std::vector<Load> fabrics;    ///< loads of each fabric, without weight and pins
    std::vector<Impulse> pins;    ///< impulse by their fabric on each group of Fabric::Pins
    MomentumBalance balance;

    /// The hardest push of each fabric on a solid in the step.
    struct Touch {
        int obstacle = kNone;
        double size = 0.0;  ///< [g cm/s]
        static constexpr int kNone = -1;
    };
    std::vector<Touch> hardest;

    void begin(double length)
    {
        dt = length;
        for (std::vector<Load>* loads : {&obstacles, &fabrics}) std::ranges::fill(*loads, Load());
        std::ranges::fill(pins, Impulse());
        std::ranges::fill(hardest, Touch());
        balance = {};
    }
    /// Fabric pushes a solid, and the solid the fabric.
    void touch(int fabric, int obstacle, const Impulse& onObstacle)
    {
        obstacles[obstacle].contact += onObstacle;
        fabrics[fabric].contact -= onObstacle;
        const double size = onObstacle.linear.norm();
        if (hardest[fabric].obstacle == Touch::kNone || size > hardest[fabric].size) hardest[fabric] = {obstacle, size};
    }
    /// One fabric pushes another, and that one it.
    void meet(int fabric, int other, const Impulse& onFabric)
    {
        fabrics[fabric].contact += onFabric;
        fabrics[other].contact -= onFabric;
    }
};

}  // namespace sim
