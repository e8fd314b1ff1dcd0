#include "sim/state_backup.h"

#include "sim/core/parallel.h"

#include <cstring>
#include <utility>

namespace sim {

namespace {

constexpr std::size_t kChunk = 16384;  ///< numbers that are copied at a time

template <class T>
void copyFirst(const AlignedArray<T>& from, std::size_t count, AlignedArray<T>& to)
{
    to.resize(from.size());
    parallelFor((count + kChunk - 1) / kChunk, [&](std::size_t c) {
        const std::size_t begin = c * kChunk;
        std::memcpy(to.data() + begin, from.data() + begin, std::min(kChunk, count - begin) * sizeof(T));
    });
}

/// All but the modes.
void copyWithoutModes(const LiquidParticles& from, LiquidParticles& to)
{
    to.count = from.count;
    to.modeCount = from.modeCount;
    for (int a = 0; a < kAxes; ++a) copyFirst(from.x[a], from.count, to.x[a]);
    copyFirst(from.mass, from.count, to.mass);
    copyFirst(from.id, from.count, to.id);
}

}  // namespace

void StateBackup::keep(State& state)
{
    LiquidParticles liquid = std::exchange(state.liquid, {});
    rest_ = state;
    state.liquid = std::move(liquid);
    copyWithoutModes(state.liquid, liquid_);
    hasModes_ = false;
}

void StateBackup::keepModes(LiquidParticles& particles, bool areRead)
{
    liquid_.modeStride = particles.modeStride;
    for (int a = 0; a < kAxes; ++a) {
        liquid_.modes[a].resize(particles.modes[a].size());
        if (areRead) copyFirst(particles.modes[a], particles.modes[a].size(), liquid_.modes[a]);
        else liquid_.modes[a].swap(particles.modes[a]);
    }
    hasModes_ = true;
}

void StateBackup::restore(State& state)
{
    LiquidParticles liquid = std::move(state.liquid);
    state = rest_;
    if (hasModes_) {
        std::swap(liquid.modes, liquid_.modes);
        std::swap(liquid.modeStride, liquid_.modeStride);
    }
    copyWithoutModes(liquid_, liquid);
    state.liquid = std::move(liquid);
    hasModes_ = false;
}

}  // namespace sim
