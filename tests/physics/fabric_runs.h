#pragma once

#include "sim/core/units.h"
#include "sim/fabric/vertex/vertex_solver.h"
#include "tests/sim/fabric/pieces.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <vector>

// Whole runs of the fabric for the tests of physics.

namespace sim::test {

/// Dense fibres, so that the material's moduli are those of the fabric (packing factor 1).
inline FabricMaterial solidFibre(double young, double poisson = 0.35)
{
    FabricMaterial m;
    m.young = young;
    m.poisson = poisson;
    m.density = 1.3;
    return m;
}

inline FabricSettings withoutContact()
{
    FabricSettings settings;
    settings.contact = false;
    settings.tolerance = 1.0e-4;  // leaves speeds of 5e-5 cm/s, of the 2 cm/s that gravity adds in a step of 2e-3 s
    return settings;
}

/// A fabric on its way. `change` may alter the assembled fabric, for instance hang a mass on it.
class FabricRun {
 public:
    using Change = std::function<void(Fabric&)>;

    explicit FabricRun(std::vector<FabricPiece> p, const FabricSettings& s = withoutContact(), std::vector<ObstacleSettings> o = {},
                       const Change& change = {})
        : fabric(changed(assembleFabric(p), change)), state(initialState(fabric, p)), solver(fabric, s, o), pieces(std::move(p)), settings(s)
    {
    }
    explicit FabricRun(const FabricPiece& piece, const FabricSettings& s = withoutContact(), std::vector<ObstacleSettings> o = {},
                       const Change& change = {})
        : FabricRun(std::vector<FabricPiece>{piece}, s, std::move(o), change)
    {
    }
    FabricRun(const FabricRun&) = delete;
    FabricRun& operator=(const FabricRun&) = delete;

    FabricReport step(double h)
    {
        StageTimes stages;
        StageClock clock(stages);
        const FabricReport report = solver.step(time, h, gravity, state, clock);
        time += h;
        return report;
    }
    void steps(int n, double h)
    {
        for (int i = 0; i < n; ++i) step(h);
    }
    /// Runs, slowed down at a rate of `drag` [1/s], until no vertex is faster than `speed` [cm/s]; false if that takes
    /// more than `most` steps. Where it comes to rest does not depend on the drag.
    [[nodiscard]] bool settle(double h, double drag, double speed = 1.0e-4, int most = 3000)
    {
        for (int i = 0; i < most; ++i) {
            step(h);
            for (Vec3& v : state.v) v *= std::exp(-drag * h);
            if (i > 10 && fastest() < speed) return true;
        }
        return false;
    }
    /// The largest value that something takes in the next n steps.
    template <class Value>
    double largestIn(int n, double h, Value&& value)
    {
        double most = 0.0;
        for (int i = 0; i < n; ++i) {
            step(h);
            most = std::max(most, value());
        }
        return most;
    }
    double fastest() const
    {
        double v = 0.0;
        for (const Vec3& u : state.v) v = std::max(v, u.norm());
        return v;
    }
    Vec3 momentum() const
    {
        Vec3 p = Vec3::Zero();
        for (std::size_t i = 0; i < state.x.size(); ++i) p += fabric.mass[i] * state.v[i];
        return p;
    }
    /// About the origin; without the spin of yarns about their own axes.
    Vec3 angularMomentum() const
    {
        Vec3 l = Vec3::Zero();
        for (std::size_t i = 0; i < state.x.size(); ++i) l += fabric.mass[i] * state.x[i].cross(state.v[i]);
        return l;
    }
    FabricEnergies energies() const { return solver.energies(state, gravity); }
    /// Tension of a yarn edge [dyn], positive when it is stretched.
    double tension(int edge) const
    {
        const int s = fabric.edges.strand[edge];
        const auto [a, b] = fabric.strands.radius[s];
        const FabricMaterial& m = fabric.materials[fabric.strands.material[s]];
        const Vec2i& v = fabric.edges.vertices[edge];
        const double strain = (state.x[v[1]] - state.x[v[0]]).norm() / fabric.edges.restLength[edge] - 1.0;
        return m.packing() * m.young * kPi * a * b * m.stretchFactor * strain;
    }

    const Fabric fabric;
    FabricState state;
    VertexSolver solver;
    Vec3 gravity = Vec3(0.0, -kEarthGravity, 0.0);  ///< [cm/s^2]
    double time = 0.0;                              ///< [s]
    const std::vector<FabricPiece> pieces;
    const FabricSettings settings;

 private:
    static Fabric changed(Fabric fabric, const Change& change)
    {
        if (change) change(fabric);
        return fabric;
    }
};

inline PinGroup pinned(std::vector<int> vertices, bool twist = false, const Motion& motion = {})
{
    PinGroup group;
    group.vertices = std::move(vertices);
    group.twist = twist;
    group.motion = motion;
    return group;
}

/// Resistance of a round yarn's section [dyn cm^2].
inline double bendingStiffness(const FabricPiece& p) { return p.material.packing() * p.material.young * 0.25 * kPi * std::pow(p.radius[0], 4); }
inline double torsionStiffness(const FabricPiece& p) { return bendingStiffness(p) / (1.0 + p.material.poisson); }
/// Mass of a yarn per length [g/cm].
inline double lineDensity(const FabricPiece& p) { return p.material.envelopeDensity() * kPi * p.radius[0] * p.radius[1]; }

/// A straight round yarn along x of n free edges of length l, and one more before them, clamped.
/// A clamped edge bends like a clamp half an edge inside it: the yarn is as long as n + ½ edges (fabric/rods/README.md, Energies).
struct Cantilever {
    Cantilever(int n, double l, double radius, double young, const Vec3& along = Vec3::UnitX())
        : effectiveLength((n + 0.5) * l),
          tip(n + 1),
          clamp(0.5 * l * along),
          piece(testing::pieceOf(strand(Vec3::Zero(), (n + 1) * l * along, n + 1), solidFibre(young), {radius, radius}))
    {
        piece.pins = {pinned({0}, true), pinned({1})};  // of vertex 1 the edge behind it would be held from turning, too
    }
    double effectiveLength;  ///< [cm]
    int tip;                 ///< vertex
    Vec3 clamp;              ///< where it is effectively clamped [cm]
    FabricPiece piece;
};

}  // namespace sim::test
