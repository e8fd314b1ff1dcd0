#pragma once

#include "sim/coupling/porous_elements.h"
#include "sim/coupling/porous_law.h"
#include "sim/coupling/unsaturated_law.h"
#include "sim/grid/block_grid.h"
#include "sim/settings.h"

#include <algorithm>
#include <span>
#include <vector>

namespace sim {

/// Liquid that fabric holds moves along yarns and through cloth: to where it is drier, down, and against the fabric's acceleration
/// (Darcy's law with the pores' suction: coupling/README.md, Wicking). What leaves a vertex arrives at others, with its momentum.
class Wicking {
 public:
    Wicking(const Fabric& fabric, const PorousElements& elements, const Settings& settings);

    /// Moves the liquid over dt [s], in substeps as short as stability and solver.wicking_substeps ask for.
    /// @param before  velocity of each vertex when the step began [cm/s]
    /// @return momentum of liquid that pins, whose velocities stay, held back of each vertex, until the next call [g cm/s]
    std::span<const Vec3> move(double dt, const Vec3& gravity, const BlockGrid& grid, const BlockArray<double>& pressure,
                               std::span<const Vec3> before, FabricState& state);
    /// Is there liquid in the fabric?
    bool isWet(const FabricState& state) const;
    int substeps(double dt) const;

 private:
    void findActive(const FabricState& state);
    double pressureAt(const Vec3& x, const BlockGrid& grid, const BlockArray<double>& pressure) const;
    void findHeads(const BlockGrid& grid, const BlockArray<double>& pressure, const FabricState& state);
    double fillingAmong(const std::array<int, 3>& v, int corners) const;
    void findFlow(const Vec3& gravity, const FabricState& state);
    /// What flows out of a corner takes the element's, so that speeds depend on no direction of the mesh, but no more than there is [g/cm^3].
    double fillingOf(std::size_t e, int v) const { return std::min(filling_[e], moving_[v]); }
    void limitDonors(double h, const FabricState& state);
    void transport(double h, FabricState& state);

    const Fabric& fabric_;
    const PorousElements& elements_;
    WickingSettings settings_;
    UnsaturatedLaw unsaturated_;
    double density_;                       ///< [g/cm^3]
    double longest_ = 0.0;                 ///< stable substep [s]
    std::vector<PorousLaw> laws_;          ///< porous law of each material
    std::vector<double> suction_, along_;  ///< each material's suction when dry [dyn/cm^2], permeability along fibres [cm^2]
    std::vector<double> capacity_;         ///< mass that the pores of each vertex hold [g]
    int leastSubsteps_;                    ///< least number of substeps of a step [-]

    // Of the step.
    std::vector<Vec3> acceleration_;                     ///< acceleration of each vertex [cm/s^2]
    std::vector<std::uint8_t> isWetElement_, isActive_;  ///< whether each element holds liquid; whether each vertex ends one that does
    std::vector<double> saturation_;                     ///< part of its pores that each vertex has filled [0..1]
    std::vector<double> head_;                           ///< suction of each vertex less the pressure of the liquid around it [dyn/cm^2]
    std::vector<std::array<double, 3>> rate_;  ///< at each corner of an element: outflow per filling of its envelope, < 0 is inflow [cm^3/s]
    std::vector<double> moving_;               ///< filling of each vertex that moves with rate_ [g/cm^3]
    std::vector<double> filling_;              ///< the same of each element: mean of its corners [g/cm^3]
    std::vector<double> outflowLimiter_;       ///< limiter of the outflow of each vertex [0..1]
    std::vector<double> flow_;                 ///< through an element, over its inflow's rate [g s/cm^3]
    std::vector<Vec3> carried_;                ///< momentum of flow_ [g/cm^2]
    std::vector<double> absorbed_;             ///< mass of liquid at each vertex after the substep [g]
    std::vector<Vec3> velocity_;               ///< velocity of each vertex after the substep [cm/s]
    std::vector<Vec3> pinImpulse_;             ///< momentum that pins held back of each vertex [g cm/s]
};

}  // namespace sim
