#pragma once

#include "sim/core/simd.h"
#include "sim/core/types.h"

#include <array>
#include <cstring>

namespace sim {

/// A matrix of 3 x 3 numbers, by columns of 4 of which the last counts for nothing.
struct Mat3Columns {
    /// Numbers of a matrix as they are stored.
    using Floats = std::array<std::array<float, 4>, 3>;

    HalfPack column[3] = {};

    Mat3Columns() = default;
    explicit Mat3Columns(const Floats& columns)
    {
        using FloatQuad = float __attribute__((vector_size(16)));
        for (int a = 0; a < 3; ++a) {
            FloatQuad four;
            std::memcpy(&four, columns[a].data(), sizeof four);
            column[a] = __builtin_convertvector(four, HalfPack);
        }
    }
    Mat3Columns& operator+=(const Mat3Columns& o)
    {
        for (int a = 0; a < 3; ++a) column[a] += o.column[a];
        return *this;
    }
    Mat3Columns& operator-=(const Mat3Columns& o)
    {
        for (int a = 0; a < 3; ++a) column[a] -= o.column[a];
        return *this;
    }
    HalfPack operator*(const HalfPack& u) const { return u[0] * column[0] + u[1] * column[1] + u[2] * column[2]; }
    Mat3Columns transposed() const
    {
        const HalfPack none{},
            even = __builtin_shufflevector(column[0], column[1], 0, 4, 2, 6), odd = __builtin_shufflevector(column[0], column[1], 1, 5, 3, 7),
            lastEven = __builtin_shufflevector(column[2], none, 0, 4, 2, 6), lastOdd = __builtin_shufflevector(column[2], none, 1, 5, 3, 7);
        Mat3Columns t;
        t.column[0] = __builtin_shufflevector(even, lastEven, 0, 1, 4, 5);
        t.column[1] = __builtin_shufflevector(odd, lastOdd, 0, 1, 4, 5);
        t.column[2] = __builtin_shufflevector(even, lastEven, 2, 3, 6, 7);
        return t;
    }
    Mat3 matrix() const
    {
        Mat3 m;
        for (int a = 0; a < 3; ++a) m.col(a) << column[a][0], column[a][1], column[a][2];
        return m;
    }
};

}  // namespace sim
