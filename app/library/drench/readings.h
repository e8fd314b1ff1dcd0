#pragma once

#include <drench/vec3.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

// What can be read of a simulation. Spans are valid until its next step.

namespace drench {

/// Bulk liquid, an array per quantity. Steps change the order of particles and their number; `id` stays with each.
struct Particles {
    std::span<const double> x, y, z;    ///< [cm]
    std::span<const double> u, v, w;    ///< velocity along x, y, z [cm/s]
    std::span<const double> mass;       ///< [g]
    std::span<const std::uint32_t> id;  ///< unique over the run

    std::size_t size() const { return mass.size(); }
    Vec3 position(std::size_t p) const { return {x[p], y[p], z[p]}; }
    Vec3 velocity(std::size_t p) const { return {u[p], v[p], w[p]}; }
};

/// Vertices of all fabrics, one piece behind the other, with the yarn edges and triangles of cloth between them.
struct Fabric {
    std::span<const Vec3> position;                 ///< [cm]
    std::span<const Vec3> velocity;                 ///< [cm/s]
    std::span<const double> mass;                   ///< dry [g]
    std::span<const double> absorbed;               ///< liquid in its pores [g]
    std::span<const double> saturation;             ///< saturation of each vertex: how full its pores are [0..1]
    std::span<const int> piece;                     ///< number of its fabric, as in the scene
    std::span<const std::array<int, 2>> edges;      ///< edges of yarns
    std::span<const std::array<int, 3>> triangles;  ///< triangles of cloth

    std::size_t size() const { return mass.size(); }
};

/// [erg]
struct Energies {
    double kinetic = 0.0;    ///< kinetic energy of the particles of liquid
    double modal = 0.0;      ///< energy of how velocity varies around them
    double potential = 0.0;  ///< potential energy of liquid in gravity
    double fabricKinetic = 0.0, fabricPotential = 0.0;
    double elastic = 0.0;  ///< elastic energy of fabric: stretching, bending, twisting
    double contact = 0.0;  ///< energy of fabric that is pressed on itself and on solids

    double total() const { return kinetic + modal + potential + fabricKinetic + fabricPotential + elastic + contact; }
};

/// What one step did.
struct Step {
    double dt = 0.0;                ///< [s]
    double fastest = 0.0;           ///< particle of liquid at its end [cm/s]
    double cfl = 0.0;               ///< cells that the fastest particle was to cross in it [-]
    bool isFirstOfTwo = false;      ///< velocities are reflected: only after the next step they are those of the flow
    int pressureIterations = 0;     ///< iterations of the solve for the pressure
    double pressureResidual = 0.0;  ///< largest, relative to the largest divergence [-]
    int fabricIterations = 0;       ///< iterations of Newton's method
    int rejectedSteps = 0;          ///< longer attempts at it that turned out bad
    double seconds = 0.0;           ///< time that it took on the clock
    double liquidMass = 0.0;        ///< mass of all particles at its end [g]
    double absorbedMass = 0.0;      ///< mass of liquid in fabric at its end [g]
    Energies energies;              ///< energies at its end
};

/// What acts on a body.
struct Load {
    Vec3 force;   ///< [dyn]
    Vec3 torque;  ///< torque about the origin of the scene [dyn cm]
};

}  // namespace drench
