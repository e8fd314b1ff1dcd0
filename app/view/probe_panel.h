#pragma once

#include "app/live/live_pair.h"

#include <array>
#include <memory>
#include <optional>
#include <span>
#include <vector>

namespace app {

/// What output.probes of a scene read: courses over time, or along a line as it is now, with their latest values.
class ProbePanel {
 public:
    /// Readings that are new.
    void take(LivePair& pair);
    /// Draws a window of its own, where a scene has probes.
    void draw(const LivePair& pair) const;

 private:
    /// Readings of one probe over time.
    struct Course {
        std::vector<double> times;     ///< times with a value [s]
        std::vector<float> values;     ///< values at these times; or along the line, where there is one
        std::optional<double> latest;  ///< value, if there is one; for points along a line that at the first
        double latestTime = 0.0;       ///< time of the last reading [s]
        void add(const ProbeTitle& title, double time, std::span<const std::optional<double>> read);
        void dropAfter(double time);
        void plot(bool isLine, float width) const;  ///< draws the plot, with the latest value in it, or the range along the line; so wide [pixels]
    };
    /// Readings of one simulation.
    struct Side {
        std::shared_ptr<const std::vector<ProbeTitle>> titles;  ///< null where it has no probes
        std::vector<Course> courses;                            ///< one course for each probe
        void add(const LiveReadings& taken);
        bool hasSameProbes(const Side& other) const;
    };
    /// Draws the probes of sides that have the same ones: each probe once, with what it reads in all of them.
    void drawProbes(std::span<const Side> sides) const;
    void drawProbe(std::size_t probe, std::span<const Side> sides) const;
    std::array<Side, 2> sides_;
};

}  // namespace app
