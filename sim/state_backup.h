#pragma once

#include "sim/state.h"

namespace sim {

/// The state before a step, to go back to if the step turns out bad. Keeping it costs next to nothing: of the liquid it copies positions
/// and masses, and the modes, which are most of it, change places with rows that G2P then fills.
class StateBackup {
 public:
    /// As it is now. Only for a moment is the liquid taken out of `state`.
    void keep(State& state);

    /// Put the modes aside, to be called right before G2P writes all of them anew.
    /// @param areRead  G2P goes on from the old ones (FLIP), so they are copied
    void keepModes(LiquidParticles& particles, bool areRead);

    /// Make `state` what it was at keep(), however far the step has come.
    void restore(State& state);

 private:
    State rest_;              ///< everything but the liquid
    LiquidParticles liquid_;  ///< modes: once keepModes() has been called, else room for them
    bool hasModes_ = false;
};

}  // namespace sim
