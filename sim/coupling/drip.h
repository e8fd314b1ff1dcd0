#pragma once

#include "sim/coupling/wet_elements.h"
#include "sim/settings.h"
#include "sim/state.h"

#include <vector>

namespace sim {

/// Fabric lets go of liquid that its pores cannot hold, a whole particle of an element at a time (model-fluid 9.3). Mass, momentum and
/// centre of mass are kept to round-off.
class Drip {
 public:
    /// @param nominalMass  of a particle [g]
    Drip(const Fabric& fabric, const WetElements& elements, const Settings& settings, double nominalMass);

    /// @return mass that came off [g]
    double drip(State& state);

 private:
    Vec3 jitter(int element, std::uint64_t number, const State& state) const;
    void release(int element, const std::array<double, 3>& part, const Vec3& offset, State& state) const;

    const WetElements& elements_;
    std::vector<double> capacity_;   ///< of each vertex [g]
    std::vector<double> excess_;     ///< of each vertex, as the step began to drip [g]
    double nominalMass_;             ///< [g]
};

}  // namespace sim
