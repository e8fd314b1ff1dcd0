#pragma once

#include "sim/state.h"

#include <optional>

namespace sim {

/// The state before a step, to go back to if the step turns out bad. Keeping it costs next to nothing: of the liquid it copies positions
/// and masses, and the modes, which are most of it, change places with rows that G2P then fills.
class StateBackup {
 public:
    /// As it is now.
    void keep(const State& state);

    /// Put the modes aside, to be called right before G2P writes all of them anew.
    /// @param areRead  G2P goes on from the old ones (FLIP), so they are copied
    void keepModes(LiquidParticles& particles, bool areRead);

    /// Make `state` what it was at keep(), however far the step has come.
    void restore(State& state);

 private:
    /// Modes of all particles, as Particles has them.
    struct Modes {
        std::array<AlignedArray<double>, kAxes> values;  ///< [cm/s]
        std::size_t stride = 0;
    };

    NonParticleState rest_;
    LiquidParticles liquid_;      ///< all of it but the modes
    std::optional<Modes> modes_;  ///< modes that were put aside in this step
    Modes room_;                  ///< where there are none: memory for them
};

}  // namespace sim
