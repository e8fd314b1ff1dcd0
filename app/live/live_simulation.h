#pragma once

#include "app/backends.h"
#include "app/live/live_probes.h"
#include "app/live/rewind_buffer.h"
#include "app/reports/blocked_sources.h"
#include "app/scene/changed_scene.h"

#include <condition_variable>
#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

namespace app {

enum class LiveMode { Paused, Playing, Ended, Failed };

/// Where a live simulation is.
struct LiveStatus {
    LiveMode mode = LiveMode::Paused;
    bool isBusy = false;  ///< whether commands are under way: all else may change at once
    std::int64_t step = 0;
    double time = 0.0;            ///< [s]
    std::string failure;          ///< reason why it went no further, in one line
    std::string refused;          ///< reason why the last change of settings was not taken, the reader's line; empty if it was
    std::vector<double> moments;  ///< times of the rewind points, ascending [s]
};

/// What the plots of a window show of a step.
struct LiveStep {
    std::int64_t step = 0;  ///< number; going back makes numbers come again
    double time = 0.0;      ///< time at its end [s]
    double seconds = 0.0;   ///< wall time that it took [s]
    sim::StepReport report;
    sim::Ledger ledger;  ///< ledger at its end
};

/// A scene that is simulated on a thread of its own while somebody looks at it. It takes the steps that a run without a
/// window takes. Calls return at once: what they ask for is done when the step in hand is over.
class LiveSimulation {
 public:
    /// Begins paused, with the initial state. Throws InputError.
    /// @param memory  for the moments it can go back to [bytes]; where it is too little there are fewer
    LiveSimulation(SceneRequest request, const Backends& backends, std::size_t memory = std::size_t{1} << 30);
    /// Waits for the step in hand.
    ~LiveSimulation();
    LiveSimulation(const LiveSimulation&) = delete;
    LiveSimulation& operator=(const LiveSimulation&) = delete;

    void play();
    void pause();
    void stepOnce();  ///< takes one step and pauses
    void restart();   ///< go back to the initial state, and pause; all settings are as they were changed
    /// Go back to the latest moment that is not after it [s], and pause; settings stay as they are now.
    void goBackTo(double time);
    /// Give settings other values, each as `--set` takes it: from the next step on, or, those that hold for a whole
    /// run, when it is restarted. What is refused is told by the status.
    void change(std::vector<std::string> sets);
    /// Hand out every frame and nothing between, and wait until it is taken; pauses and steps end at frames.
    void frameByFrame(bool isOn);

    /// What snapshots show from now on, beginning with one of the state as it is. At first: what the scene's file says.
    void show(const SnapshotExtras& extras);

    LiveStatus status() const;
    std::shared_ptr<const LiveScene> scene() const;
    std::uint64_t stateHash();  ///< hash of the state when the step in hand is over: waits for it
    /// What has happened since the last call, oldest first.
    std::vector<LiveStep> takeSteps();
    LiveReadings takeReadings() { return probes_.take(); }  ///< readings of output.probes
    /// The latest picture to draw, whole as it was between two steps; `old`, the one that was taken before it, if there
    /// is no newer one.
    std::unique_ptr<FrameSnapshot> takeSnapshot(std::unique_ptr<FrameSnapshot> old = nullptr);
    /// Time of the picture that waits to be taken, if one does [s].
    std::optional<double> waiting() const;

 private:
    using Command = std::function<void()>;

    void ask(Command command);
    void work(const std::stop_token& stop);
    void runCommands(std::unique_lock<std::mutex>& lock);
    void advance();
    bool isAtFrame() const;
    void fail(const std::string& why);
    void goTo(const RewindBuffer::RewindPoint& moment);
    void resetSimulation();
    void publish(bool always);
    void publishScene();
    void applyOverrides(const std::vector<std::string>& sets);

    const Backends backends_;

    // The simulation's thread has these to itself once it runs.
    ChangedScene settings_;
    PlaceObstacles placeObstacles_;
    std::unique_ptr<SimulationHandle> simulation_;
    std::optional<BlockedSources> blockedSources_;  ///< sources that were blocked since it was started
    LiveProbes probes_;                             ///< has a lock of its own
    RewindBuffer rewind_;
    std::int64_t frame_ = 0;       ///< the last one that was reached
    std::int64_t nextChange_ = 0;  ///< the step with which settings change next by themselves
    LiveMode mode_ = LiveMode::Paused;
    std::string failure_;
    bool pausesAtFrame_ = false;
    SnapshotExtras extras_;

    mutable std::mutex mutex_;  ///< guards what follows
    std::condition_variable_any wake_;
    std::deque<Command> commands_;
    LiveStatus status_;
    std::shared_ptr<const LiveScene> scene_;
    bool frameByFrame_ = false;
    std::vector<LiveStep> steps_;
    std::unique_ptr<FrameSnapshot> ready_, spare_;
    std::jthread thread_;  ///< last: it ends before what it uses
};

}  // namespace app
