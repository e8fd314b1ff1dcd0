#pragma once

#include "app/live/live_simulation.h"

#include <vector>

namespace app {

/// Courses of what steps report, and the stages of the last one.
class StepPlots {
 public:
    void add(std::vector<LiveStep> steps);
    void draw() const;

 private:
    void drawStages() const;

    std::vector<float> energy_, massError_, milliseconds_, cfl_, iterations_, wall_;  ///< curves of the steps so far
    LiveStep last_;
};

}  // namespace app
