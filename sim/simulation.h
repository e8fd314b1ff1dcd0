#pragma once

#include "sim/core/check.h"
#include "sim/fabric/cohesion.h"
#include "sim/fabric/fabric.h"
#include "sim/scene/scene.h"
#include "sim/state.h"
#include "sim/state_hash.h"
#include "sim/step_check.h"
#include "sim/workspace.h"

#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

namespace sim {

/// A scene under way: its state and all that is needed to advance it.
class Simulation {
 public:
    /// Builds the initial state. Throws InputError when a source has no room for a single particle.
    explicit Simulation(Scene scene);
    /// Goes on from a state of the same scene, with what the scene's changes have set until then.
    Simulation(Scene scene, State state);
    Simulation(const Simulation&) = delete;  // its parts refer to each other
    Simulation& operator=(const Simulation&) = delete;

    const State& state() const { return state_; }
    const Scene& scene() const { return scene_; }
    const Workspace& workspace() const { return work_; }
    const Fabric& fabric() const { return fabric_; }
    /// What acted on solids, fabrics and pins in the last step; nothing before the first.
    const Forces& forces() const { return work_.momentum.forces(); }
    /// Energies of the initial state; afterwards the step's report tells them.
    Energies energies() const;
    /// Makes reports tell from now on where energy goes (sim/README.md, Energy).
    void bookEnergy();

    /// One time step towards `until` [s]: what is left is cut into equal parts no longer than the largest stable step, so that the time
    /// is hit exactly and no step is tiny. Throws RunError naming scene, step, stage, why and what would do. In mode adaptive a bad step is
    /// taken back and made again half as long, up to ten times; from there steps grow again. If that does not help the state is that
    /// of the last good step; in other modes it is, except for what the failed step moved.
    StepReport step(double until);

    /// Gives the scene other changes from now on. Those for steps that were taken already do nothing.
    void setChanges(std::vector<SettingsChange> changes);

 private:
    const SettingsChange* lastChange(std::int64_t after, std::int64_t upTo) const;
    void applySettings(const SettingsChange& change);
    void applyChanges();
    void prepareWorkspace();
    std::unique_ptr<FabricIntegrator> makeIntegrator() const;
    std::optional<Cohesion> cohesion() const;
    void begin();
    double chooseLength(double until) const;
    double lengthOfStep(double left, double largest) const;
    std::optional<StepFailure> tryStep(double dt, StepReport& report);
    void accept(const StepReport& report);
    RunError failure(std::string_view stage, const std::string& why) const;
    RunError failure(const StepFailure& fault, int halvings, double dt) const;

    Scene scene_;
    Fabric fabric_;
    State state_;
    Workspace work_;
    std::optional<StepCheck> check_;
    std::int64_t changedUpTo_ = 0;  ///< changes for steps up to this were applied
};

}  // namespace sim
