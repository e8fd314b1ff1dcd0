#pragma once

#include "sim/transfer/gather.h"
#include "sim/transfer/reference.h"
#include "sim/transfer/scatter.h"
#include "sim/transfer/scatter_affine.h"
#include "tests/sim/fixtures.h"

namespace sim::test {

inline Vec3 unitVector(int axis) { return Vec3::Unit(axis); }

/// Middle of the face at the lower side of cell c of block b [cm].
inline Vec3 faceMiddle(const BlockGrid& grid, int axis, int block, int c)
{
    Vec3 inCells(c % kBlockEdge + 0.5, c / kBlockEdge % kBlockEdge + 0.5, c / (kBlockEdge * kBlockEdge) + 0.5);
    inCells[axis] -= 0.5;
    return grid.lowerCorner(block) + grid.dx * inCells;
}

/// Call f(axis, block, cell) for all faces of all blocks.
template <class F>
void forEachFaceOf(const BlockGrid& grid, F&& f)
{
    for (int b = 0; b < grid.count(); ++b)
        for (int a = 0; a < kAxes; ++a)
            for (int c = 0; c < kBlockCells; ++c) f(a, b, c);
}

/// Liquid that goes back and forth between particles and faces by the fast kernels, without forces.
struct Transfers {
    explicit Transfers(SortedLiquid start) : liquid(std::move(start)) {}

    SortedLiquid liquid;
    FaceFields faces;
    ScatterScratch scatterScratch;
    GatherScratch gatherScratch;

    const BlockGrid& grid() const { return liquid.grid; }

    /// P2G; faces with mass get a velocity, the others rest.
    void toFaces(XiMap map = XiMap::Translation, double dt = 0.0)
    {
        if (map == XiMap::Translation) particlesToFaces({liquid.particles, liquid.order, liquid.grid}, scatterScratch, faces);
        else particlesToFacesAffine({liquid.particles, liquid.order, liquid.grid}, map, dt, faces);
        setVelocities([&](int axis, int b, int c) { return mass(axis, b, c) > 0.0 ? momentum(axis, b, c) / mass(axis, b, c) : 0.0; });
    }

    /// u(axis, block, cell) on all faces; all of them are valid.
    template <class F>
    void setVelocities(F&& u)
    {
        faces.velocity.resize(grid().count());
        faces.valid.resize(grid().count());
        forEachFaceOf(grid(), [&](int axis, int b, int c) {
            faces.velocity.block(b, axis)[c] = u(axis, b, c);
            faces.valid.set(b, c, axis);
        });
    }

    GatherSums toParticles(int modes, double dt = 0.0)
    {
        GatherSettings settings;
        settings.modes = modes;
        settings.dt = dt;
        return toParticles(settings);
    }
    GatherSums toParticles(const GatherSettings& settings)
    {
        return facesToParticles(faces, liquid.order, liquid.grid, settings, gatherScratch, liquid.particles);
    }

    double mass(int axis, int b, int c) const { return faces.sums.block(b, FaceFields::kMass + axis)[c]; }
    double momentum(int axis, int b, int c) const { return faces.sums.block(b, FaceFields::kMomentum + axis)[c]; }
    double velocity(int axis, int b, int c) const { return faces.velocity.block(b, axis)[c]; }

    Vec3 faceMomentum() const
    {
        Vec3 sum = Vec3::Zero();
        forEachFaceOf(grid(), [&](int axis, int b, int c) { sum[axis] += momentum(axis, b, c); });
        return sum;
    }
    Vec3 faceAngularMomentum() const
    {
        Vec3 sum = Vec3::Zero();
        forEachFaceOf(grid(), [&](int axis, int b, int c) { sum += faceMiddle(grid(), axis, b, c).cross(unitVector(axis)) * momentum(axis, b, c); });
        return sum;
    }
    /// Of the faces' velocities, with the masses of the last P2G.
    double faceEnergy() const
    {
        double sum = 0.0;
        forEachFaceOf(grid(), [&](int axis, int b, int c) { sum += 0.5 * mass(axis, b, c) * velocity(axis, b, c) * velocity(axis, b, c); });
        return sum;
    }

    Vec3 particleMomentum() const
    {
        Vec3 sum = Vec3::Zero();
        const LiquidParticles& p = liquid.particles;
        for (std::size_t s = 0; s < p.count; ++s) sum += p.mass[s] * p.velocity(liquid.order.source[s]);
        return sum;
    }
    /// Σ m |v| and Σ m |x| |v|: what round-off in the sums of momenta is relative to.
    double momentumScale() const
    {
        double sum = 0.0;
        forEachFaceOf(grid(), [&](int axis, int b, int c) { sum += std::abs(momentum(axis, b, c)); });
        return sum;
    }
    double angularMomentumScale() const
    {
        double sum = 0.0;
        forEachFaceOf(grid(), [&](int axis, int b, int c) { sum += faceMiddle(grid(), axis, b, c).norm() * std::abs(momentum(axis, b, c)); });
        return sum;
    }

    /// Largest |u − expected(axis, place)| over the faces with mass.
    template <class F>
    double largestError(F&& expected) const
    {
        double worst = 0.0;
        forEachFaceOf(grid(), [&](int axis, int b, int c) {
            if (mass(axis, b, c) > 0.0) worst = std::max(worst, std::abs(velocity(axis, b, c) - expected(axis, faceMiddle(grid(), axis, b, c))));
        });
        return worst;
    }
};

}  // namespace sim::test
