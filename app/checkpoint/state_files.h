#pragma once

#include "app/checkpoint/checkpoint.h"

#include <cstdint>
#include <filesystem>
#include <vector>

namespace app {

/// Where a run keeps states below its folder.
enum class StateKind {
    ForResuming,  ///< checkpoints/state_00012.h5: all of it
    ForPictures,  ///< states/state_00012.h5: what pictures need of it
};

std::filesystem::path stateFolder(const std::filesystem::path& runFolder, StateKind kind);
std::filesystem::path stateFile(const std::filesystem::path& runFolder, StateKind kind, std::int64_t frame);

/// Frames of which there is a state, ascending; none where there is no folder.
std::vector<std::int64_t> storedFrames(const std::filesystem::path& runFolder, StateKind kind);

/// Writes the states that a run is to keep.
class StateWriter {
 public:
    /// @param origin  of the run; frame, hash and logs are filled in for each state
    StateWriter(std::filesystem::path runFolder, const LoadedScene& setup, CheckpointOrigin origin);

    /// Is there to be a checkpoint of this frame?
    bool isDue(std::int64_t frame) const;
    /// A checkpoint; older ones beyond those that are kept are removed once it is there.
    void checkpoint(const sim::State& state, std::int64_t frame, std::uint64_t stateHash, const LogsSoFar& logs);
    /// The state of a frame for pictures, if the scene asks for it.
    void picture(const sim::State& state, std::int64_t frame, std::uint64_t stateHash);

 private:
    const std::filesystem::path folder_;
    CheckpointOrigin origin_;
    bool pictures_ = false;
    std::int64_t every_ = 0;  ///< frames; 0: no checkpoints
    int keep_ = 0;            ///< 0: all
    std::int64_t last_ = 0;   ///< frame of the run's end
    sim::State lean_;         ///< storage
};

}  // namespace app
