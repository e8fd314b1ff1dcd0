#pragma once

#include "sim/state.h"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace app {

/// States that a live simulation can go back to, the initial one first. Where their memory is used up every second one
/// is forgotten, and from there on half as many are kept.
class RewindBuffer {
 public:
    struct RewindPoint {
        sim::State state;
        std::int64_t frame = 0;  ///< number of the frame
    };

    /// @param memory  for all of them [bytes]; the initial state is kept whatever it takes
    explicit RewindBuffer(std::size_t memory) : memory_(memory) {}

    /// Forget all, and begin with an initial state.
    void begin(const sim::State& state);
    /// Keep the state at a frame, if it is one of those that are kept.
    void keep(const sim::State& state, std::int64_t frame);
    const RewindPoint& first() const { return all_.front(); }
    /// The latest that is not after a time [s], or else the first.
    const RewindPoint& latest(double time) const;
    void dropAfter(double time);  ///< [s]
    std::vector<double> times() const;

 private:
    const std::size_t memory_;
    std::int64_t every_ = 1;  ///< frames
    std::vector<RewindPoint> all_;
};

}  // namespace app
