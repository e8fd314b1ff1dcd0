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

StateBackup::Kept StateBackup::keep(const State& state)
{
    rest_ = state;
    copyWithoutModes(state.liquid, liquid_);
    if (modes_) room_ = std::move(*modes_);
    modes_.reset();
    return Kept();
}

void StateBackup::putModesAside(LiquidParticles& particles, bool areRead)
{
    modes_ = std::move(room_);
    modes_->stride = particles.modeStride;
    for (int a = 0; a < kAxes; ++a) {
        modes_->values[a].resize(particles.modes[a].size());
        if (areRead) copyFirst(particles.modes[a], particles.modes[a].size(), modes_->values[a]);
        else modes_->values[a].swap(particles.modes[a]);
    }
}

void StateBackup::restore(const Kept&, State& state)
{
    static_cast<NonParticleState&>(state) = rest_;
    if (modes_) {
        std::swap(state.liquid.modes, modes_->values);
        std::swap(state.liquid.modeStride, modes_->stride);
        room_ = std::move(*modes_);
        modes_.reset();
    }
    copyWithoutModes(liquid_, state.liquid);
}

}  // namespace sim
