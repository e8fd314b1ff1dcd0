#include "app/view/live_simulation.h"

#include "app/frame_view_from_state.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <future>
#include <utility>

namespace app {

namespace {

constexpr std::size_t kMostSteps = 100'000;  ///< that wait to be taken: of a window that is not drawn

/// Memory of a copy of the state, about.
std::size_t bytesOf(const sim::State& state)
{
    const sim::LiquidParticles& liquid = state.liquid;
    constexpr std::size_t kPerVertex = 7 * sizeof(sim::Vec3) + 8 * sizeof(double);
    const auto rows = static_cast<std::size_t>(sim::kAxes * (1 + liquid.modeCount) + 2);
    return liquid.count * rows * sizeof(double) +
           static_cast<std::size_t>(state.grid.count()) * sim::kBlockCells * sizeof(double) +
           state.fabric.x.size() * kPerVertex;
}

}  // namespace

LiveSimulation::LiveSimulation(SceneSetup setup, const Parts& parts, std::size_t memory)
    : setup_(std::move(setup)),
      parts_(parts),
      memory_(memory),
      placeObstacles_(parts.meshObstacles(setup_)),
      simulation_(parts.startSimulation(setup_)),
      extras_(extrasOf(setup_.pictures.render))
{
    keepMoment();
    publish(true);
    thread_ = std::jthread([this](const std::stop_token& stop) { work(stop); });
}

LiveSimulation::~LiveSimulation() = default;

void LiveSimulation::ask(Command command)
{
    {
        const std::lock_guard lock(mutex_);
        commands_.push_back(std::move(command));
    }
    wake_.notify_one();
}

void LiveSimulation::play()
{
    ask([this] {
        if (status().mode == LiveMode::Paused) setMode(LiveMode::Playing);
    });
}

void LiveSimulation::pause()
{
    ask([this] {
        if (status().mode == LiveMode::Playing) setMode(LiveMode::Paused);
    });
}

void LiveSimulation::stepOnce()
{
    ask([this] {
        const LiveMode mode = status().mode;
        if (mode == LiveMode::Ended || mode == LiveMode::Failed) return;
        setMode(LiveMode::Paused);
        advance();
    });
}

void LiveSimulation::restart()
{
    ask([this] { goTo(moments_.front()); });
}

void LiveSimulation::goBackTo(double time)
{
    ask([this, time] {
        const auto after = std::ranges::find_if(moments_, [&](const Moment& m) { return m.state.time > time; });
        goTo(after == moments_.begin() ? moments_.front() : *std::prev(after));
    });
}

void LiveSimulation::show(const SnapshotExtras& extras)
{
    ask([this, extras] { extras_ = extras; });  // as after every command, a snapshot is published
}

LiveStatus LiveSimulation::status() const
{
    const std::lock_guard lock(mutex_);
    return status_;
}

std::uint64_t LiveSimulation::stateHash()
{
    std::promise<std::uint64_t> hash;
    ask([&] { hash.set_value(simulation_->stateHash()); });
    return hash.get_future().get();
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
    spare_ = std::move(old);
    return std::exchange(ready_, nullptr);
}

void LiveSimulation::setMode(LiveMode mode)
{
    const std::lock_guard lock(mutex_);
    status_.mode = mode;
}

void LiveSimulation::fail(const std::string& why)
{
    const std::lock_guard lock(mutex_);
    status_.mode = LiveMode::Failed;
    status_.failure = why;
}

void LiveSimulation::work(const std::stop_token& stop)
{
    std::unique_lock lock(mutex_);
    while (!stop.stop_requested()) {
        wake_.wait(lock, stop, [&] { return !commands_.empty() || status_.mode == LiveMode::Playing; });
        runCommands(lock);
        if (stop.stop_requested() || status_.mode != LiveMode::Playing) continue;
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
    }
}

/// One step towards the next frame, as a run without a window takes it.
void LiveSimulation::advance()
{
    const sim::TimeSettings& time = setup_.scene.settings.time;
    const double end = time.start + time.duration, until = std::min(frameTime(setup_, frame_ + 1), end);
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
    step.step = state.step;
    step.time = state.time;
    step.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    {
        const std::lock_guard lock(mutex_);
        if (steps_.size() < kMostSteps) steps_.push_back(std::move(step));
    }
    if (state.time == until && until < end) {
        ++frame_;
        if (frame_ % momentEvery_ == 0) keepMoment();
    }
    if (state.time >= end) setMode(LiveMode::Ended);
    publish(state.time >= end);
}

void LiveSimulation::goTo(const Moment& moment)
{
    const double time = moment.state.time;
    frame_ = moment.frame;
    simulation_ = parts_.resumeSimulation(setup_, moment.state);
    std::erase_if(moments_, [&](const Moment& m) { return m.state.time > time; });
    const std::lock_guard lock(mutex_);
    status_.mode = LiveMode::Paused;
    status_.failure.clear();
}

/// Where memory is used up every second moment is forgotten, and from here on half as many are kept.
void LiveSimulation::keepMoment()
{
    const sim::State& state = simulation_->state();
    const std::size_t fits = std::max<std::size_t>(1, memory_ / std::max<std::size_t>(1, bytesOf(state)));
    while (moments_.size() > 1 && moments_.size() >= fits) {
        momentEvery_ *= 2;
        std::erase_if(moments_, [&](const Moment& m) { return m.frame % momentEvery_ != 0; });
    }
    if (frame_ % momentEvery_ == 0 && (moments_.empty() || moments_.size() < fits)) moments_.push_back({state, frame_});
}

/// Hand out how it stands. Without `always` only if the last snapshot was taken: who looks seldom costs little.
void LiveSimulation::publish(bool always)
{
    const sim::State& state = simulation_->state();
    std::unique_ptr<FrameSnapshot> snapshot;
    {
        const std::lock_guard lock(mutex_);
        status_.step = state.step;
        status_.time = state.time;
        status_.moments.clear();
        for (const Moment& moment : moments_) status_.moments.push_back(moment.state.time);
        if (ready_ && !always) return;
        snapshot = ready_ ? std::move(ready_) : std::move(spare_);
    }
    if (!snapshot) snapshot = std::make_unique<FrameSnapshot>();
    snapshot->number = frame_;
    app::takeSnapshot(state, simulation_->fabric(), simulation_->contacts(), setup_.scene.settings.liquid.density,
                      extras_, *snapshot);
    placeObstacles_(state.time, snapshot->obstacles);
    const std::lock_guard lock(mutex_);
    ready_ = std::move(snapshot);
}

}  // namespace app
