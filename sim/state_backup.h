#pragma once

#include "sim/state.h"

#include <optional>

namespace sim {

/// The state before a step, to go back to if the step turns out bad. Keeping it costs next to nothing: of the liquid it copies positions
/// and masses, and the modes, which are most of it, change places with rows that G2P then fills.
class StateBackup {
 public:
    /// Token that a state is kept, until the next is.
    class Kept {
        friend StateBackup;
        Kept() = default;
    };
    /// Keep the state as it is now.
    [[nodiscard]] Kept keep(const State& state);
    /// Make `state` what it was when it was kept, however far the step has come.
    void restore(const Kept&, State& state);

    /// Call write(), which writes all modes anew (G2P), with the old ones put aside.
    /// @param areRead  it goes on from the old ones (FLIP), so they are copied
    /// @return what it returns
    template <class Write>
    auto rewriteModes(LiquidParticles& particles, bool areRead, Write&& write)
    {
        putModesAside(particles, areRead);
        return write();
    }

 private:
    void putModesAside(LiquidParticles& particles, bool areRead);

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
