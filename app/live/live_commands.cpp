// Commands to a live simulation: each waits for its thread, which runs it between two steps.

#include "app/live/live_simulation.h"

#include <future>
#include <utility>

namespace app {

void LiveSimulation::ask(Command command)
{
    {
        const std::lock_guard lock(mutex_);
        commands_.push_back(std::move(command));
        status_.isBusy = true;
    }
    wake_.notify_one();
}

void LiveSimulation::play()
{
    ask([this] {
        if (mode_ == LiveMode::Paused) mode_ = LiveMode::Playing;
    });
}

void LiveSimulation::pause()
{
    ask([this] {
        if (mode_ != LiveMode::Playing) return;
        pausesAtFrame_ = !isAtFrame();
        if (!pausesAtFrame_) mode_ = LiveMode::Paused;
    });
}

void LiveSimulation::stepOnce()
{
    ask([this] {
        if (mode_ == LiveMode::Ended || mode_ == LiveMode::Failed) return;
        mode_ = LiveMode::Paused;
        do advance();
        while (!isAtFrame() && mode_ == LiveMode::Paused);
    });
}

void LiveSimulation::restart()
{
    ask([this] {
        if (settings_.restart()) resetSimulation();
        else goTo(rewind_.first());
    });
}

void LiveSimulation::goBackTo(double time)
{
    ask([this, time] { goTo(rewind_.latest(time)); });
}

void LiveSimulation::change(std::vector<std::string> sets)
{
    ask([this, sets = std::move(sets)] {
        std::string refused;
        try {
            applyOverrides(sets);
        } catch (const sim::InputError& error) {
            refused = error.what();
        }
        const std::lock_guard lock(mutex_);
        status_.refused = refused;
    });
}

void LiveSimulation::applyOverrides(const std::vector<std::string>& sets)
{
    const LiveMode mode = mode_;
    if (settings_.change(sets, simulation_->state().step)) {
        resetSimulation();
        mode_ = mode == LiveMode::Playing ? mode : LiveMode::Paused;
        return;
    }
    simulation_->setChanges(settings_.setup().scene.changes);
    publishScene();
}

void LiveSimulation::frameByFrame(bool isOn)
{
    {
        const std::lock_guard lock(mutex_);
        frameByFrame_ = isOn;
    }
    wake_.notify_one();
}

void LiveSimulation::show(const SnapshotExtras& extras)
{
    ask([this, extras] { extras_ = extras; });  // as after every command, a snapshot is published
}

std::uint64_t LiveSimulation::stateHash()
{
    std::promise<std::uint64_t> hash;
    ask([&] { hash.set_value(simulation_->stateHash()); });
    return hash.get_future().get();
}

}  // namespace app
