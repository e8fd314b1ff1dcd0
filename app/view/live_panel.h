#pragma once

#include "app/live/live_pair.h"
#include "app/view/step_plots.h"

#include <array>

namespace app {

/// What the simulations do, buttons that tell them what to do, and plots of their steps.
class LivePanel {
 public:
    /// Steps for the plots.
    void take(LivePair& pair);
    /// Into the window that is begun.
    void draw(LivePair& pair);

 private:
    void drawStatus(const LivePair& pair) const;
    void drawButtons(LivePair& pair) const;
    void drawRewindPoints(LivePair& pair) const;

    std::array<StepPlots, 2> plots_;  ///< one for each side
};

}  // namespace app
