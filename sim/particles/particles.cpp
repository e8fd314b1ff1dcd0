#include "sim/particles/particles.h"

#include "sim/particles/velocity_modes.h"

#include <algorithm>
#include <cstring>

namespace sim {

namespace {

/// Kernels load whole vectors: rows are padded so that a load past the last particle stays inside. The odd part keeps
/// the rows of all modes from falling into the same cache sets.
constexpr std::size_t kPad = 64;
std::size_t strideFor(std::size_t count) { return (count + count / 8 + kPad + 511) / 512 * 512 + 72; }

}  // namespace

Vec3 Particles::velocity(std::size_t p) const
{
    Vec3 v;
    for (int axis = 0; axis < kAxes; ++axis) {
        v[axis] = 0.0;
        for (int r = 0; r < modeCount; ++r) v[axis] += kMeanOfMode[r] * mode(axis, r)[p];
    }
    return v;
}

void Particles::resize(std::size_t n)
{
    for (auto& a : x) a.resize(n + kPad);
    mass.resize(n + kPad);
    id.resize(n + kPad);
    if (n + kPad > modeStride || modes[0].size() < modeStride * modeCount) {
        const std::size_t stride = std::max(strideFor(n), modeStride);
        for (auto& m : modes) {
            AlignedArray<double> grown(stride * modeCount);
            const std::size_t rows = modeStride == 0 ? 0 : std::min<std::size_t>(modeCount, m.size() / modeStride);
            for (std::size_t r = 0; r < rows; ++r) std::memcpy(grown.data() + r * stride, m.data() + r * modeStride, count * sizeof(double));
            m.swap(grown);
        }
        modeStride = stride;
    }
    for (std::size_t p = count; p < n; ++p) {
        for (auto& a : x) a[p] = 0.0;
        mass[p] = 0.0;
        id[p] = 0;
        for (int axis = 0; axis < kAxes; ++axis)
            for (int r = 0; r < modeCount; ++r) mode(axis, r)[p] = 0.0;
    }
    count = n;
}

void Particles::changeModes(int n)
{
    if (n == modeCount) return;
    for (auto& m : modes) {
        AlignedArray<double> changed(modeStride * n);  // all zero
        const std::size_t kept = modeStride * std::min(n, modeCount);
        std::copy(m.data(), m.data() + kept, changed.data());
        for (int r = n; r < modeCount; ++r)
            for (std::size_t p = 0; p < count; ++p) changed[p] += kMeanOfMode[r] * m[r * modeStride + p];
        m.swap(changed);
    }
    modeCount = n;
}

void Particles::copy(std::size_t from, std::size_t to)
{
    mass[to] = mass[from];
    id[to] = id[from];
    for (int axis = 0; axis < kAxes; ++axis) {
        x[axis][to] = x[axis][from];
        for (int r = 0; r < modeCount; ++r) mode(axis, r)[to] = mode(axis, r)[from];
    }
}

void Particles::add(const Vec3& position, double particleMass, std::uint32_t particleId, const Vec3& v)
{
    const std::size_t p = count;
    resize(count + 1);
    mass[p] = particleMass;
    id[p] = particleId;
    for (int axis = 0; axis < kAxes; ++axis) {
        x[axis][p] = position[axis];
        mode(axis, 0)[p] = v[axis];
    }
}

}  // namespace sim
