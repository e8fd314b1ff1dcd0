#include "app/live/rewind_buffer.h"

#include <algorithm>
#include <iterator>

namespace app {

namespace {

/// Memory of a copy of the state, about.
std::size_t bytesOf(const sim::State& state)
{
    const sim::LiquidParticles& liquid = state.liquid;
    constexpr std::size_t kPerVertex = 7 * sizeof(sim::Vec3) + 8 * sizeof(double);
    const auto rows = sim::kAxes * (1 + static_cast<std::size_t>(liquid.modeCount)) + 2;
    return liquid.count * rows * sizeof(double) + static_cast<std::size_t>(state.grid.count()) * sim::kBlockCells * sizeof(double) +
           state.fabric.x.size() * kPerVertex;
}

}  // namespace

void RewindBuffer::begin(const sim::State& state)
{
    all_.clear();
    every_ = 1;
    all_.push_back({state, 0});
}

void RewindBuffer::keep(const sim::State& state, std::int64_t frame)
{
    if (frame % every_ != 0) return;
    const std::size_t fits = std::max<std::size_t>(1, memory_ / std::max<std::size_t>(1, bytesOf(state)));
    while (all_.size() > 1 && all_.size() >= fits) {
        every_ *= 2;
        std::erase_if(all_, [&](const RewindPoint& m) { return m.frame % every_ != 0; });
    }
    if (frame % every_ == 0 && all_.size() < fits) all_.push_back({state, frame});
}

const RewindBuffer::RewindPoint& RewindBuffer::latest(double time) const
{
    const auto after = std::ranges::find_if(all_, [&](const RewindPoint& m) { return m.state.time > time; });
    return after == all_.begin() ? all_.front() : *std::prev(after);
}

void RewindBuffer::dropAfter(double time)
{
    std::erase_if(all_, [&](const RewindPoint& m) { return m.state.time > time; });
}

std::vector<double> RewindBuffer::times() const
{
    std::vector<double> times;
    for (const RewindPoint& moment : all_) times.push_back(moment.state.time);
    return times;
}

}  // namespace app
