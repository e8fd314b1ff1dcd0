#pragma once

#include "app/backends.h"

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>

namespace app {

/// Draws frames of a scene into a folder, without holding up who hands them in.
class FrameSink {
 public:
    /// @param asPanel    pictures are to stand beside others
    /// @param fromStart  the first frame will be the initial state; if not, that is looked at to place a camera that
    ///                   frames everything
    FrameSink(const LoadedScene& setup, const Backends& backends, const std::filesystem::path& folder, bool asPanel, bool fromStart);

    /// @param stateHash  hash of the whole state, of which `state` may hold what pictures need only
    void take(const sim::State& state, const sim::Fabric& fabric, const sim::ActiveContacts* contacts, std::int64_t frame, std::uint64_t stateHash);
    /// Wait until all pictures are files, or throw why not.
    void drain() { pipeline_->drain(); }
    /// Wait until all pictures are files, or throw why not; no more will come.
    void finish() { pipeline_->finish(); }

 private:
    void fillIn(const sim::State& state, const sim::Fabric& fabric, const sim::ActiveContacts* contacts, FrameSnapshot& snapshot) const;

    const LoadedScene& setup_;
    PlaceObstacles placeObstacles_;
    std::optional<FramePipeline> pipeline_;
};

}  // namespace app
