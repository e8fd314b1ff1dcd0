#pragma once

#include "sim/core/aligned_array.h"
#include "sim/core/simd.h"
#include "sim/core/types.h"
#include "sim/fabric/vec3t.h"

#include <array>
#include <span>

namespace sim::contact {

/// Positions or displacements of all vertices [cm]: four doubles each, of which the last is 0, so that one load fetches a vertex.
class Points {
 public:
    void resize(std::size_t n) { data_.resize(4 * n); }
    std::size_t size() const { return data_.size() / 4; }
    const double* at(std::size_t i) const { return data_.data() + 4 * i; }
    Vec3 operator[](std::size_t i) const { return Vec3(at(i)[0], at(i)[1], at(i)[2]); }
    void set(std::size_t i, const Vec3& v, double fourth = 0.0)
    {
        double* p = data_.data() + 4 * i;
        p[0] = v.x(), p[1] = v.y(), p[2] = v.z(), p[3] = fourth;
    }

 private:
    AlignedArray<double> data_;
};

/// Four numbers of each of eight points, as four packs.
struct QuadPack {
    Pack x, y, z, w;
};

using EightIndices = std::array<int, kLanes>;

/// The eight points of these indices, lane by lane.
[[gnu::always_inline]] inline QuadPack gatherQuads(const Points& points, const EightIndices& index)
{
    const auto two = [&](int lane) __attribute__((always_inline))
    {
        const HalfPack a = *reinterpret_cast<const HalfPack*>(points.at(static_cast<std::size_t>(index[lane])));
        const HalfPack b = *reinterpret_cast<const HalfPack*>(points.at(static_cast<std::size_t>(index[lane + 1])));
        return Pack(__builtin_shufflevector(a, b, 0, 1, 2, 3, 4, 5, 6, 7));
    };
    const Pack p01 = two(0), p23 = two(2), p45 = two(4), p67 = two(6);
    const PackMask xy = {0, 4, 8, 12, 1, 5, 9, 13}, zw = {2, 6, 10, 14, 3, 7, 11, 15};
    const PackMask lower = {0, 1, 2, 3, 8, 9, 10, 11}, upper = {4, 5, 6, 7, 12, 13, 14, 15};
    const Pack xy0 = pickLanes(p01, p23, xy), xy4 = pickLanes(p45, p67, xy);
    const Pack zw0 = pickLanes(p01, p23, zw), zw4 = pickLanes(p45, p67, zw);
    return {pickLanes(xy0, xy4, lower), pickLanes(xy0, xy4, upper), pickLanes(zw0, zw4, lower), pickLanes(zw0, zw4, upper)};
}

[[gnu::always_inline]] inline Vec3T<Pack> gather(const Points& points, const EightIndices& index)
{
    const QuadPack q = gatherQuads(points, index);
    return {q.x, q.y, q.z};
}

}  // namespace sim::contact
