#pragma once

#include "app/reports/run_report.h"
#include "app/scene/loaded_scene.h"
#include "sim/state.h"

#include <cstdint>
#include <filesystem>
#include <string>

namespace app {

/// What a stored state belongs to.
struct CheckpointOrigin {
    std::string scene, variant, label;  ///< as in report.json
    std::string trajectory;             ///< trajectoryHash() of the scene
    std::uint64_t program = 0;          ///< hash of the program
    std::string provenance;             ///< provenance of the run, see provenanceOf()
    std::uint64_t stateHash = 0;        ///< hash of the whole state, of which the file may hold what pictures need only
    std::int64_t frame = 0;             ///< the last one before the state, mostly that of the state itself
    LogsSoFar logs = {};
};

/// A state to go on from, as it stands in a file.
struct Checkpoint {
    CheckpointOrigin origin;
    sim::State state;
};

/// Hash of what the states of a run depend on, and at which times it has frames: all of the scene but when it ends and
/// how its pictures look. 16 hexadecimal digits.
std::string trajectoryHash(const LoadedScene& setup);

/// Write an HDF5 file with a checksum, whole or not at all. Throws std::runtime_error.
void saveCheckpoint(const CheckpointOrigin& origin, const sim::State& state, const std::filesystem::path& file);

/// Throws InputError for a file that is none of ours, of another version, cut off or damaged.
Checkpoint loadCheckpoint(const std::filesystem::path& file);

/// What pictures need of a state, which is all but the liquid's modes beyond its velocity: copied into `lean`, reusing its storage.
void copyForPictures(const sim::State& state, sim::State& lean);

}  // namespace app
