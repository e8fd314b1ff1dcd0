#pragma once

#include "sim/fabric/energies.h"
#include "sim/fabric/integrator.h"
#include "sim/fabric/rods/rods.h"

namespace sim {

/// `fabric.solver: off`: fabric whose motion is prescribed. Pins follow their motions, all else stays where it is, whatever liquid does to it.
class PrescribedFabric final : public FabricIntegrator {
 public:
    PrescribedFabric(const Fabric& fabric, const FabricSettings& settings);

    /// @param loads  on vertices
    FabricReport advance(double t, double h, const Vec3& gravity, FabricState& state, StageClock& clock, const FabricLoads& loads) override;
    /// Energies of motion and weight: what its form holds is not known.
    FabricEnergies energies(const FabricState& state, const Vec3& gravity) const override { return fabricEnergies(fabric_, state, {}, gravity); }

 private:
    EnergyChanges changes(double h, const Vec3& gravity, const FabricState& state, const LiquidLoads* loads) const;
    void reportForces(double h, const Vec3& gravity, const FabricState& state, const LiquidLoads* loads) const;
    /// Impulse that a vertex gets [g cm/s].
    static Vec3 byLiquid(const LiquidLoads* loads, const FabricState& state, std::size_t v);
    /// Impulse that what holds the vertex has to give it for its motion [g cm/s].
    Vec3 reaction(double h, const Vec3& gravity, const FabricState& state, const LiquidLoads* loads, std::size_t v) const;

    const Fabric& fabric_;
    Rods rods_;                        ///< rods, for the frames of yarns that are moved
    std::vector<Vec3> restReference_;  ///< reference direction of each yarn edge at rest
    std::vector<Vec3> before_;         ///< velocity of each vertex when the step began [cm/s]
};

}  // namespace sim
