#pragma once

#include "app/view/live_simulation.h"
#include "render/look.h"

#include <vector>

namespace app {

/// The panel beside the picture: what the simulation does, buttons that tell it what to do, plots of its steps, and how
/// it is drawn.
class LivePanel {
 public:
    /// More steps for the plots.
    void add(std::vector<LiveStep> steps);
    /// One frame of the panel. What it changes of the look is drawn at once.
    void draw(LiveSimulation& live, render::Look& look);
    void playOrPause(LiveSimulation& live) const;

 private:
    void drawButtons(LiveSimulation& live, const LiveStatus& status);
    void drawPlots() const;
    void drawLook(render::Look& look) const;

    std::vector<float> energy_, cfl_, iterations_, milliseconds_;  ///< of the steps so far
    LiveStep last_;
};

}  // namespace app
