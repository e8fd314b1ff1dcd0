#include "app/checkpoint/state_files.h"

#include "app/system/atomic_files.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace app {

namespace fs = std::filesystem;

namespace {

constexpr std::string_view kHead = "state_", kTail = ".h5";

}  // namespace

fs::path stateFolder(const fs::path& runFolder, StateKind kind) { return runFolder / (kind == StateKind::ForResuming ? "checkpoints" : "states"); }

fs::path stateFile(const fs::path& runFolder, StateKind kind, std::int64_t frame)
{
    return stateFolder(runFolder, kind) / fmt::format("{}{:05d}{}", kHead, frame, kTail);
}

std::vector<std::int64_t> storedFrames(const fs::path& runFolder, StateKind kind) { return numbersIn(stateFolder(runFolder, kind), kHead, kTail); }

StateWriter::StateWriter(fs::path runFolder, const LoadedScene& setup, CheckpointOrigin origin)
    : folder_(std::move(runFolder)), origin_(std::move(origin))
{
    const OutputSettings& output = setup.pictures.output;
    pictures_ = output.states;
    keep_ = output.checkpointKeep;
    last_ = frameCount(setup);
    if (output.checkpoint) every_ = std::max<std::int64_t>(1, std::llround(output.checkpointEvery / output.every));
}

bool StateWriter::isDue(std::int64_t frame) const { return every_ > 0 && (frame % every_ == 0 || frame == last_); }

void StateWriter::checkpoint(const sim::State& state, std::int64_t frame, std::uint64_t stateHash, const LogsSoFar& logs)
{
    fs::create_directories(stateFolder(folder_, StateKind::ForResuming));
    origin_.frame = frame;
    origin_.stateHash = stateHash;
    origin_.logs = logs;
    saveCheckpoint(origin_, state, stateFile(folder_, StateKind::ForResuming, frame));
    if (keep_ == 0) return;
    const std::vector<std::int64_t> there = storedFrames(folder_, StateKind::ForResuming);
    for (std::size_t i = 0; i + static_cast<std::size_t>(keep_) < there.size(); ++i) fs::remove(stateFile(folder_, StateKind::ForResuming, there[i]));
}

void StateWriter::picture(const sim::State& state, std::int64_t frame, std::uint64_t stateHash)
{
    if (!pictures_) return;
    fs::create_directories(stateFolder(folder_, StateKind::ForPictures));
    copyForPictures(state, lean_);
    origin_.frame = frame;
    origin_.stateHash = stateHash;
    origin_.logs = {};
    saveCheckpoint(origin_, lean_, stateFile(folder_, StateKind::ForPictures, frame));
}

}  // namespace app
