#pragma once

#include <chrono>
#include <cstdint>
#include <cstdio>
#include <string>

namespace app {

/// "6 m 12 s", "45 s", "1 h 03 m"
std::string formatDuration(double seconds);

/// Wall seconds left, if simulated time goes on as fast as it went so far; negative while that is unknown.
/// @param begin, now, end  simulated time [s]
double secondsLeft(double begin, double now, double end, double wallSeconds);

/// Where a run stands.
struct ProgressState {
    std::int64_t frame = 0, frames = 0;
    double time = 0.0, dt = 0.0;   ///< simulated [s]
    double secondsPerStep = 0.0;   ///< wall
    double secondsLeft = -1.0;     ///< wall; negative: not known yet
    double allSecondsLeft = -1.0;  ///< time left of the whole command, wall; negative: there is nothing but this run, or it is not known yet
};

/// "frame 37/240 · t 0.62 s · dt 1.9e-4 · 0.031 s/step · ETA 6 m 12 s", and where more runs follow ", with those to follow 20 m 05 s"
std::string progressLine(const ProgressState& state);

/// Tells how a run gets on: one line that is redrawn on a terminal, a new line every few seconds elsewhere.
class Progress {
 public:
    /// @param label  stands before every line, may be empty
    /// @param frame  the last one that is done already
    Progress(std::FILE* out, std::string label, double begin, double end, std::int64_t frames, std::int64_t frame = 0);
    ~Progress();  ///< ends the line on a terminal
    Progress(const Progress&) = delete;
    Progress& operator=(const Progress&) = delete;

    /// One more step done. Writes only where it is time to.
    void stepDone(double time, double dt, double stepSeconds);
    void frameDone() { ++state_.frame; }

    /// What follows in the same command is expected to take so many times as long as this run.
    void setRunsToFollow(double count) { runsToFollow_ = count; }
    /// Write where it stands now.
    void show();

 private:
    std::FILE* const out_;
    const std::string label_;
    const double begin_, end_;
    const bool terminal_;
    bool lineOpen_ = false;
    double runsToFollow_ = 0.0;
    ProgressState state_;
    std::chrono::steady_clock::time_point start_, shown_;
};

}  // namespace app
