#pragma once

#include "sim/core/simd.h"
#include "sim/core/types.h"

namespace sim {

/// A matrix of 3 x 3 numbers, by columns of 4 of which the last counts for nothing.
struct Mat3Columns {
    HalfPack column[3] = {};

    Mat3Columns& operator+=(const Mat3Columns& o)
    {
        for (int a = 0; a < 3; ++a) column[a] += o.column[a];
        return *this;
    }
    Mat3 matrix() const
    {
        Mat3 m;
        for (int a = 0; a < 3; ++a) m.col(a) << column[a][0], column[a][1], column[a][2];
        return m;
    }
};

}  // namespace sim
