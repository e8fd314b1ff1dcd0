#pragma once

#include "sim/scene/scene.h"
#include "sim/state.h"
#include "sim/step_report.h"

#include <optional>
#include <string>

namespace sim {

/// What is wrong with a step.
struct StepFailure {
    Stage stage = Stage::GridToParticles;
    std::string what;    ///< the law that is broken, by how much, and by which particle or vertex
    std::string remedy;  ///< what would do
};

/// Watches over what must hold after every step, whatever the scene: all numbers are finite, nothing crosses more cells than it may, liquid
/// is neither made nor lost, fabric is not inside of obstacles, and energy comes from somewhere.
class StepCheck {
 public:
    /// @param fabric  must stay where it is
    StepCheck(const Scene& scene, const Fabric& fabric);

    /// Initialises the memory before the first step from the energies of the initial state.
    static void start(const Energies& energies, StepHistory& memory);
    /// Updates the memory after a step that was accepted.
    static void accept(const StepReport& report, StepHistory& memory);

    /// What makes the step useless whatever follows: numbers that are not finite, liquid that is not accounted for.
    std::optional<StepFailure> violatedInvariant(const State& state, const StepReport& report) const;

    /// What a shorter step would have done better. `state` is that after the step.
    std::optional<StepFailure> rejectionReason(const State& state, const StepReport& report) const;

 private:
    std::optional<StepFailure> cflExceeded(const State& state, const StepReport& report) const;
    std::optional<StepFailure> penetrationTooDeep(const State& state, const StepReport& report) const;
    std::optional<StepFailure> energyGrowth(const State& state, const StepReport& report) const;
    double drivingSpeed(const State& state, const StepReport& report) const;
    double energyAllowed(const State& state, const StepReport& report) const;
    std::string fastestParticle(const State& state) const;
    std::string fastestVertex(const State& state) const;
    std::string nameOf(std::size_t vertex) const;
    std::string remedyFor(bool isFabrics) const;

    const Scene& scene_;
    const Fabric& fabric_;
    double fabricMass_ = 0.0;  ///< dry [g]
    double radius_ = 0.0;      ///< radius of the thickest vertex [cm]
};

}  // namespace sim
