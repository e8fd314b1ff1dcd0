#pragma once

#include "app/scene/loaded_scene.h"
#include "sim/scene/parameters.h"

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace app {

/// The scene of a live simulation as it stands.
struct LiveScene {
    SceneRequest request;                    ///< a run of it repeats what was done live
    LoadedScene setup;                       ///< what that run is
    std::vector<sim::Parameter> parameters;  ///< what holds now
    std::vector<std::string> waiting;        ///< changes that a restart would make, each as `--set` takes it
};

/// A scene that was asked for, and what was changed in it since: by hand as it runs, or where it is gone on with.
class ChangedScene {
 public:
    using Load = std::function<LoadedScene(const SceneRequest&)>;

    /// Throws InputError.
    ChangedScene(SceneRequest request, Load load);

    const LoadedScene& setup() const { return setup_; }
    LiveScene scene(std::int64_t step) const;
    /// Does a change with this or a later step come from the scene itself?
    std::int64_t nextChange(std::int64_t step) const;

    /// Let settings have other values from the step after `step` on; 0 is before the first. True if the initial state
    /// has to be built anew for it. Throws InputError, and has changed nothing then.
    bool change(const std::vector<std::string>& sets, std::int64_t step);
    /// What was changed after this step holds from the step after it on.
    void goBackTo(std::int64_t step);
    /// What was changed, and what waits, holds from the start, of the file as it is now. True if that is another scene.
    bool restart();

 private:
    struct Change {
        std::int64_t step = 0;  ///< the first with it
        std::vector<std::string> sets;
        bool isOfScene = false;  ///< whether it stands in the file
    };

    void begin(LoadedScene setup);
    void requireSameFile() const;
    static void tidy(std::vector<Change>& changes);
    SceneRequest requestOf(const std::vector<std::string>& sets, const std::vector<Change>& changes) const;

    Load load_;
    SceneRequest start_;                ///< request with all that was set for the start
    std::vector<Change> changes_;       ///< in order of their steps
    std::vector<std::string> waiting_;  ///< settings that wait for a restart
    LoadedScene setup_;                 ///< scene with all changes but those that wait
    std::string identity_;              ///< identity of the scene at the start
};

}  // namespace app
