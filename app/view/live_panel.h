#pragma once

#include "app/view/live_simulation.h"
#include "app/view/look_panel.h"

#include <vector>

namespace app {

/// The panel beside the picture: what the simulation does, buttons that tell it what to do, plots of its steps, and how
/// it is drawn.
class LivePanel {
 public:
    explicit LivePanel(const PictureSettings& pictures) : look_(pictures) {}

    /// More steps for the plots.
    void add(std::vector<LiveStep> steps);
    /// One frame of the panel. What it changes of the look is drawn at once.
    void draw(LiveSimulation& live);
    render::Look lookFor(const FrameSnapshot& snapshot) const { return look_.lookFor(snapshot); }
    void playOrPause(LiveSimulation& live) const;

 private:
    void drawButtons(LiveSimulation& live, const LiveStatus& status);
    void drawPlots() const;

    LookPanel look_;
    std::vector<float> energy_, cfl_, iterations_, milliseconds_;  ///< of the steps so far
    LiveStep last_;
};

}  // namespace app
