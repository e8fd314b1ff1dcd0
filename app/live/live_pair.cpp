#include "app/live/live_pair.h"

#include <algorithm>
#include <optional>

namespace app {

namespace {

void take(LivePair::Side& side) { side.shown = side.live.takeSnapshot(std::move(side.shown)); }

}  // namespace

LivePair::LivePair(const SceneRequest& request, const Backends& backends) { sides_.push_back(std::make_unique<Side>(request, backends)); }

void LivePair::addSecondSide(const SceneRequest& request, const Backends& backends)
{
    auto second = std::make_unique<Side>(request, backends);
    sides_.resize(1);
    sides_.push_back(std::move(second));
    first().pause();
    first().restart();
    pace();
}

void LivePair::removeSecondSide()
{
    sides_.resize(1);
    pace();
}

void LivePair::all(const std::function<void(LiveSimulation&)>& what)
{
    for (const auto& side : sides_) what(side->live);
}

void LivePair::playOrPause()
{
    const bool isPlaying = std::ranges::any_of(sides_, [](const auto& side) { return side->live.status().mode == LiveMode::Playing; });
    all([&](LiveSimulation& live) { isPlaying ? live.pause() : live.play(); });
}

void LivePair::showEveryFrame(bool isOn)
{
    everyFrame_ = isOn;
    pace();
}

void LivePair::pace()
{
    all([&](LiveSimulation& live) { live.frameByFrame(everyFrame_ || sides_.size() > 1); });
}

/// Pictures of one time go together. One that is alone there waits for the other, unless that stays where it is; of two
/// times the earlier one is passed over.
bool LivePair::takeNewest()
{
    Side& a = *sides_.front();
    if (sides_.size() == 1) {
        const bool isNew = a.live.waiting().has_value();
        take(a);
        return isNew;
    }
    Side& b = *sides_.back();
    const auto stays = [](const Side& side) { return side.live.status().mode >= LiveMode::Ended; };
    const bool staysA = stays(a), staysB = stays(b);  // asked first: what stays hands out nothing after its last picture
    const std::optional<double> timeOfA = a.live.waiting(), timeOfB = b.live.waiting();
    const auto isAgain = [](const std::optional<double>& time, const Side& other) { return time && other.shown && *time == other.shown->time; };
    const bool takesA = timeOfA && (timeOfB ? *timeOfA <= *timeOfB : staysB || isAgain(timeOfA, b));
    const bool takesB = timeOfB && (timeOfA ? *timeOfB <= *timeOfA : staysA || isAgain(timeOfB, a));
    if (takesA) take(a);
    if (takesB) take(b);
    synchronize();
    return takesA || takesB;
}

/// Asked to pause, one may have begun the next frame and the other not.
void LivePair::synchronize()
{
    const LiveStatus a = sides_.front()->live.status(), b = sides_.back()->live.status();
    const auto rests = [](const LiveStatus& status) { return status.mode == LiveMode::Paused && !status.isBusy; };
    if (!rests(a) || !rests(b) || a.time == b.time) return;
    sides_[a.time < b.time ? 0 : 1]->live.stepOnce();
}

}  // namespace app
