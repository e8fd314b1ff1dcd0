#include "app/live/live_simulation.h"

#include "app/frames/snapshot_from_state.h"
#include "app/system/stopwatch.h"
#include "sim/core/check.h"

#include <algorithm>
#include <chrono>
#include <utility>

namespace app {

namespace {

constexpr std::size_t kMostSteps = 100'000;  ///< steps that wait to be taken, of a window that is not drawn

}  // namespace

LiveSimulation::LiveSimulation(SceneRequest request, const Backends& backends, std::size_t memory)
    : backends_(backends), settings_(std::move(request), backends.loadScene), rewind_(memory), extras_(extrasOf(settings_.setup().pictures.render))
{
    resetSimulation();
    publish(true);
    thread_ = std::jthread([this](const std::stop_token& stop) { work(stop); });
}

LiveSimulation::~LiveSimulation() = default;

LiveStatus LiveSimulation::status() const
{
    const std::lock_guard lock(mutex_);
    return status_;
}

std::shared_ptr<const LiveScene> LiveSimulation::scene() const
{
    const std::lock_guard lock(mutex_);
    return scene_;
}

std::vector<LiveStep> LiveSimulation::takeSteps()
{
    const std::lock_guard lock(mutex_);
    return std::exchange(steps_, {});
}

std::unique_ptr<FrameSnapshot> LiveSimulation::takeSnapshot(std::unique_ptr<FrameSnapshot> old)
{
    const std::lock_guard lock(mutex_);
    if (!ready_) return old;
    if (old) spare_ = std::move(old);
    if (frameByFrame_) wake_.notify_one();
    return std::exchange(ready_, nullptr);
}

std::optional<double> LiveSimulation::waiting() const
{
    const std::lock_guard lock(mutex_);
    return ready_ ? std::optional(ready_->time) : std::nullopt;
}

void LiveSimulation::fail(const std::string& why)
{
    mode_ = LiveMode::Failed;
    failure_ = why;
}

void LiveSimulation::work(const std::stop_token& stop)
{
    std::unique_lock lock(mutex_);
    while (!stop.stop_requested()) {
        const auto goesOn = [&] { return mode_ == LiveMode::Playing && !(frameByFrame_ && ready_); };
        wake_.wait(lock, stop, [&] { return !commands_.empty() || goesOn(); });
        runCommands(lock);
        if (stop.stop_requested() || !goesOn()) continue;
        lock.unlock();
        advance();
        lock.lock();
    }
}

void LiveSimulation::runCommands(std::unique_lock<std::mutex>& lock)
{
    while (!commands_.empty()) {
        const Command command = std::move(commands_.front());
        commands_.pop_front();
        lock.unlock();
        try {
            command();
        } catch (const std::exception& error) {
            fail(error.what());
        }
        publish(true);
        lock.lock();
        status_.isBusy = !commands_.empty();
    }
}

/// One step towards the next frame, as a run without a window takes it.
void LiveSimulation::advance()
{
    const sim::TimeSettings& time = settings_.setup().scene.settings.time;
    const double end = time.start + time.duration, until = std::min(frameTime(settings_.setup(), frame_ + 1), end);
    const auto begin = std::chrono::steady_clock::now();
    LiveStep step;
    try {
        step.report = simulation_->step(until);
    } catch (const std::exception& error) {
        fail(error.what());
        publish(true);
        return;
    }
    const sim::State& state = simulation_->state();
    blockedSources_->look(state);
    probes_.step(*simulation_, step.report.isReflected);
    step.step = state.step;
    step.time = state.time;
    step.ledger = state.ledger;
    step.seconds = secondsSince(begin);
    {
        const std::lock_guard lock(mutex_);
        if (steps_.size() < kMostSteps) steps_.push_back(std::move(step));
    }
    if (state.step + 1 >= nextChange_) publishScene();
    if (state.time == until) ++frame_;
    if (state.time == until && until < end) {
        rewind_.keep(state, frame_);
        if (std::exchange(pausesAtFrame_, false)) mode_ = LiveMode::Paused;
    }
    if (state.time >= end) mode_ = LiveMode::Ended;
    publish(state.time >= end);
}

/// May it pause here? Anywhere, but frame by frame.
bool LiveSimulation::isAtFrame() const
{
    {
        const std::lock_guard lock(mutex_);
        if (!frameByFrame_) return true;
    }
    return simulation_->state().time == frameTime(settings_.setup(), frame_);
}

void LiveSimulation::goTo(const RewindBuffer::RewindPoint& moment)
{
    const double time = moment.state.time;
    frame_ = moment.frame;
    pausesAtFrame_ = false;
    settings_.goBackTo(moment.state.step);
    simulation_ = backends_.resumeSimulation(settings_.setup(), moment.state);
    rewind_.dropAfter(time);
    if (moment.frame == 0) probes_.begin(settings_.setup(), *simulation_);
    else probes_.goBack(settings_.setup(), time);
    mode_ = LiveMode::Paused;
    failure_.clear();
    publishScene();
}

/// Starts again from the initial state of the scene as it is set.
void LiveSimulation::resetSimulation()
{
    const LoadedScene& setup = settings_.setup();
    simulation_ = backends_.startSimulation(setup);
    blockedSources_.emplace(setup.scene);
    placeObstacles_ = backends_.meshObstacles(setup);
    rewind_.begin(simulation_->state());
    probes_.begin(setup, *simulation_);
    frame_ = 0;
    pausesAtFrame_ = false;
    mode_ = LiveMode::Paused;
    failure_.clear();
    publishScene();
}

/// What holds now, and until when.
void LiveSimulation::publishScene()
{
    const std::int64_t step = simulation_->state().step;
    nextChange_ = settings_.nextChange(step);
    auto scene = std::make_shared<const LiveScene>(settings_.scene(step));
    const std::lock_guard lock(mutex_);
    scene_ = std::move(scene);
}

/// Hand out how it stands. A picture, without `always`, only if the last one was taken: who looks seldom costs little.
/// The status is told last, all at once, so that who knows that it has ended or pauses finds the picture of that.
void LiveSimulation::publish(bool always)
{
    const sim::State& state = simulation_->state();
    std::unique_lock lock(mutex_);
    const bool isBetween = frameByFrame_ && mode_ < LiveMode::Ended && state.time != frameTime(settings_.setup(), frame_);
    if (!isBetween && (always || !ready_)) {
        std::unique_ptr<FrameSnapshot> snapshot = std::move(spare_);
        lock.unlock();
        if (!snapshot) snapshot = std::make_unique<FrameSnapshot>();
        snapshot->number = frame_;
        app::fillSnapshot(state, simulation_->fabric(), simulation_->contacts(), settings_.setup().scene.settings.liquid.density, extras_, *snapshot);
        placeObstacles_(state.time, snapshot->obstacles);
        lock.lock();
        std::swap(ready_, snapshot);
        if (snapshot) spare_ = std::move(snapshot);
    }
    status_.mode = mode_;
    status_.failure = failure_;
    status_.step = state.step;
    status_.time = state.time;
    status_.moments = rewind_.times();
}

}  // namespace app
