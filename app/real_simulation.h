#pragma once

#include "app/backends.h"
#include "sim/simulation.h"

namespace app {

/// What steps a scene, as the program sees it.
class RealSimulation : public SimulationHandle {
 public:
    explicit RealSimulation(const sim::Scene& scene) : simulation_(scene) {}
    RealSimulation(const sim::Scene& scene, const sim::State& state) : simulation_(scene, state) {}
    const sim::State& state() const override { return simulation_.state(); }
    const sim::Fabric& fabric() const override { return simulation_.fabric(); }
    const sim::ActiveContacts* contacts() const override
    {
        const auto& fabric = simulation_.workspace().fabric;
        return fabric ? fabric->contacts() : nullptr;
    }
    const sim::LiquidGrid& liquidGrid() const override { return simulation_.workspace().grid; }
    const sim::Forces& forces() const override { return simulation_.forces(); }
    sim::StepReport step(double until) override { return simulation_.step(until); }
    sim::Energies energies() const override { return simulation_.energies(); }
    void bookEnergy() override { simulation_.bookEnergy(); }
    std::uint64_t stateHash() const override { return sim::stateHash(simulation_.state()); }
    void setChanges(std::vector<sim::SettingsChange> changes) override { simulation_.setChanges(std::move(changes)); }
    const sim::Scene& scene() const { return simulation_.scene(); }

 private:
    sim::Simulation simulation_;
};

}  // namespace app
