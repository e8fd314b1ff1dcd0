#pragma once

#include "sim/fabric/fabric.h"
#include "sim/fabric/fabric_energies.h"
#include "sim/fabric/fabric_report.h"
#include "sim/fabric/liquid_loads.h"
#include "sim/stage.h"

#include <limits>
#include <optional>

namespace sim {

struct ActiveContacts;
struct Forces;

/// What liquid does to fabric over a step, on the unknowns that its integrator solves for; both are null without liquid.
struct FabricLoads {
    const LiquidLoads* onVertices = nullptr;
    const FaceLoads* onFaces = nullptr;
};

/// Advances the fabric in time: `fabric.solver` says which of its implementations does.
class FabricIntegrator {
 public:
    FabricIntegrator() = default;
    FabricIntegrator(const FabricIntegrator&) = delete;  // its parts refer to each other
    FabricIntegrator& operator=(const FabricIntegrator&) = delete;
    virtual ~FabricIntegrator() = default;

    /// Before the liquid's mixture with the fabric is found: what the integrator solves for, as the vertices have it now.
    virtual void prepare(FabricState&, StageClock&) {}
    /// Advances the fabric from t to t + h [s].
    virtual FabricReport advance(double t, double h, const Vec3& gravity, FabricState& state, StageClock& clock, const FabricLoads& loads) = 0;
    /// A step of the fabric alone, from t to t + h [s], without liquid.
    FabricReport step(double t, double h, const Vec3& gravity, FabricState& state, StageClock& clock)
    {
        prepare(state, clock);
        return advance(t, h, gravity, state, clock, {});
    }
    /// Velocities on the faces of a grid, of an integrator that has its unknowns there: after prepare() those that the vertices brought,
    /// after advance() those at the end of the step.
    virtual std::optional<FabricFaces> faces() const { return std::nullopt; }

    /// Energies of a state, for one thread at a time: implementations may remember the state that they were asked for last.
    virtual FabricEnergies energies(const FabricState& state, const Vec3& gravity) const = 0;
    /// Deepest reach of the fabric into an obstacle at the end of the last step [cm].
    virtual double deepestInObstacles(const FabricState&) const { return -std::numeric_limits<double>::infinity(); }
    /// Pairs of fabric that acted in the last step; null before the first, where none were near, and where contact is not by pairs.
    virtual const ActiveContacts* contacts() const { return nullptr; }

    /// Makes reports tell from now on where energy goes, which takes about as long as an iteration of a solve.
    void bookEnergy() { booksEnergy_ = true; }
    /// Makes steps from now on add to `forces` what acts between the fabric and solids, pins and liquid.
    void reportForces(Forces& forces) { forces_ = &forces; }

 protected:
    bool booksEnergy_ = false;
    Forces* forces_ = nullptr;  ///< forces that steps add to; null where nobody wants them
};

}  // namespace sim
