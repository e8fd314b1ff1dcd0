#pragma once

#include "sim/liquid/liquid_on_solids.h"
#include "sim/liquid/viscosity.h"
#include "tests/sim/fixtures.h"
#include "tests/sim/grid/random_solids.h"
#include "tests/sim/liquid/grid_scene.h"

#include <gtest/gtest.h>
#include <Eigen/Geometry>
#include <numeric>

// Viscous liquid on a small grid.

namespace sim::test {

/// One step of viscosity on liquid that is given on the grid.
struct ViscousScene {
    GridScene scene;
    ViscosityWorkspace work;

    ViscousScene(const Vec3i& first, const Vec3i& end) : scene(first, end) { scene.settings.viscosity = 100.0; }

    SolveReport solve(double dt, double tolerance = 1.0e-13)
    {
        scene.solver.viscosityTolerance = tolerance;
        scene.solver.maxIterations = 5000;
        return solveViscosity(scene.cut(), scene.settings, scene.solver, dt, work, scene.liquid);
    }
    double mass(int axis, const Vec3i& c) const
    {
        const CellRef ref = scene.at(c);
        return scene.liquid.faces.sums.block(ref.block, FaceFields::kMass + axis)[ref.cell];
    }
    bool isUnknown(int axis, const Vec3i& c) const { return work.system.unknown.test(scene.at(c).block, scene.at(c).cell, axis); }
    /// Σ of(axis, cell) over the unknown faces.
    template <class Of>
    auto sum(Of&& of)
    {
        decltype(of(0, Vec3i())) total = of(0, scene.lower) * 0.0;
        scene.forEachFace([&](int a, const Vec3i& c) {
            if (isUnknown(a, c)) total += of(a, c);
        });
        return total;
    }
    double energy()
    {
        return sum([&](int a, const Vec3i& c) { return 0.5 * mass(a, c) * std::pow(scene.velocity(a, c), 2); });
    }
    Vec3 momentum()
    {
        return sum([&](int a, const Vec3i& c) { return Vec3(mass(a, c) * scene.velocity(a, c) * Vec3::Unit(a)); });
    }
    Vec3 angularMomentum()
    {
        return sum([&](int a, const Vec3i& c) { return Vec3(mass(a, c) * scene.velocity(a, c) * scene.faceMiddle(a, c).cross(Vec3::Unit(a))); });
    }
};

inline const Vec3 kMiddle(1.3, 1.1, 1.5);

/// A ball of liquid in the air, with masses that differ from face to face.
inline ViscousScene ball()
{
    ViscousScene viscous({-3, -3, -3}, {13, 13, 13});
    viscous.scene.fill([](const Vec3& x) { return (x - kMiddle).norm() - 1.2; });
    std::mt19937 random(5);
    std::uniform_real_distribution<double> unit(0.5, 1.1);
    viscous.scene.forEachFace([&](int a, const Vec3i& c) {
        const CellRef ref = viscous.scene.at(c);
        viscous.scene.liquid.faces.sums.block(ref.block, FaceFields::kMass + a)[ref.cell] *= unit(random);
    });
    viscous.scene.setRandomVelocities(100.0);
    return viscous;
}

/// A tank turned against the grid, about half full.
inline ViscousScene puddle(double friction)
{
    ViscousScene viscous({-3, -3, -3}, {13, 13, 13});
    Eigen::Isometry3d place = Eigen::Isometry3d::Identity();
    place.translate(kMiddle);
    place.rotate(Eigen::AngleAxisd(0.4, Vec3(1.0, 2.0, 3.0).normalized()));
    viscous.scene.add(Shape::box(Vec3::Zero(), Vec3(1.1, 1.0, 1.3)).inverted().moved(place));
    viscous.scene.settings.wallFriction = friction;
    viscous.scene.fill([](const Vec3& x) { return x.y() - 1.0; });
    viscous.scene.setRandomVelocities(100.0);
    return viscous;
}

}  // namespace sim::test
