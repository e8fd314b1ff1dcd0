#pragma once

#include "app/live/live_simulation.h"

#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace app {

/// One live simulation, or two that are looked at side by side: pictures of both are of the same time.
class LivePair {
 public:
    struct Side {
        Side(const SceneRequest& request, const Backends& backends) : live(request, backends) {}
        LiveSimulation live;
        std::unique_ptr<FrameSnapshot> shown;  ///< what is to be drawn; none before the first picture
    };

    /// Throws InputError.
    LivePair(const SceneRequest& request, const Backends& backends);

    /// Another scene beside the first one, both from their start, paused; it takes the place of one that is there.
    /// Throws InputError, and leaves all as it was.
    void addSecondSide(const SceneRequest& request, const Backends& backends);
    void removeSecondSide();

    std::vector<std::unique_ptr<Side>>& sides() { return sides_; }
    const std::vector<std::unique_ptr<Side>>& sides() const { return sides_; }
    LiveSimulation& first() { return sides_.front()->live; }
    const LiveSimulation& first() const { return sides_.front()->live; }
    /// Do something to all.
    void all(const std::function<void(LiveSimulation&)>& what);
    void playOrPause();

    /// Frame by frame even where there is one: every frame is shown, none is passed over.
    void showEveryFrame(bool isOn);
    /// Take the newest pictures that go together. True if there were any.
    bool takeNewest();

 private:
    void pace();
    void synchronize();

    std::vector<std::unique_ptr<Side>> sides_;  ///< one or two
    bool everyFrame_ = false;
};

}  // namespace app
