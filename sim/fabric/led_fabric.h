#pragma once

#include "sim/fabric/energies.h"
#include "sim/fabric/fabric.h"
#include "sim/fabric/liquid_loads.h"
#include "sim/fabric/rods/rods.h"
#include "sim/step_report.h"

namespace sim {

/// `fabric.solver: off`: pins follow their motions, all else stays where it is, and holds whatever liquid does to it.
class LedFabric {
 public:
    LedFabric(const Fabric& fabric, const FabricSettings& settings);

    /// From t to t + h [s].
    /// @param loads  of the liquid over the step; null without liquid
    FabricReport step(double t, double h, const Vec3& gravity, FabricState& state, const LiquidLoads* loads = nullptr);
    /// From now on reports tell where energy goes.
    void bookEnergy() { booksEnergy_ = true; }
    /// Of motion and weight: what its form holds is not known.
    FabricEnergies energies(const FabricState& state, const Vec3& gravity) const { return fabricEnergies(fabric_, state, {}, gravity); }

 private:
    EnergyChanges changes(double h, const Vec3& gravity, const FabricState& state, const LiquidLoads* loads) const;

    const Fabric& fabric_;
    Rods rods_;                          ///< for the frames of yarns that are moved
    std::vector<Vec3> restReference_;    ///< of each yarn edge
    std::vector<Vec3> before_;           ///< of each vertex: velocity when the step began [cm/s]
    bool booksEnergy_ = false;
};

}  // namespace sim
