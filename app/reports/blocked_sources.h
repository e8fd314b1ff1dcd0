#pragma once

#include "sim/scene/scene.h"
#include "sim/state.h"

#include <string>
#include <vector>

namespace app {

/// Tells of each source of a run that has to stop because what it flows into is closed and full, the first time that it does.
class BlockedSources {
 public:
    explicit BlockedSources(const sim::Scene& scene);
    /// After a step: what is new, a line for each source.
    std::vector<std::string> newlyBlocked(const sim::State& state);
    /// Tells it to the user.
    void look(const sim::State& state);

 private:
    struct Source {
        std::string where, name;
        bool isTold = false;
    };
    std::vector<Source> sources_;
};

}  // namespace app
