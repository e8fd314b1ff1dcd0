#pragma once

#include "sim/coupling/porous_elements.h"
#include "sim/grid/obstacles.h"
#include "sim/settings.h"
#include "sim/state.h"

#include <span>
#include <vector>

namespace sim {

/// Fabric lets go of liquid that its pores cannot hold. What vertices within one cell of the grid have too much is pooled, and comes off as
/// soon as it makes a particle, or as one of them holds kMostOver more than its pores: in a drop as small as that is. Mass, momentum and
/// centre of mass are kept to round-off.
class Drip {
 public:
    static constexpr double kMostOver = 0.03;  ///< share of what pores hold that stays beyond it [-]

    /// @param nominalMass  of a particle [g]
    Drip(const Fabric& fabric, const PorousElements& elements, const Settings& settings, double nominalMass);

    /// Drops come off within the fabric, or beside it, where no solid is; fabric in a solid, where it gets without contact, keeps what it has.
    /// @return mass that came off [g]
    double drip(State& state, const Obstacles& obstacles);

 private:
    /// A vertex with too much, in its cell.
    struct Wet {
        Vec3i cell;
        int vertex;
    };
    void findPools(const FabricState& fabric);
    double drain(std::span<const Wet> pool, const Obstacles& obstacles, State& state) const;
    Vec3 jitter(std::span<const Wet> pool, const Vec3& middle, std::uint64_t number, const State& state) const;

    const PorousElements& elements_;
    std::vector<double> capacity_;  ///< mass that the pores of each vertex hold [g]
    std::vector<double> excess_;    ///< mass of each vertex beyond its pores as the step began to drip [g]
    std::vector<Wet> wet_;          ///< vertices with too much, by cells
    double nominalMass_;            ///< [g]
    double cell_;                   ///< edge of a cell [cm]
};

}  // namespace sim
