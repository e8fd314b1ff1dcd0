#pragma once

#include "tests/sim/solvers/poisson_scenes.h"

#include <cstring>
#include <utility>

namespace sim::test {

/// A p of one cell, by a plain loop.
inline double matrixTimes(const PoissonScene& scene, const BlockArray<double>& p, const Vec3i& cell)
{
    const CellRef at = scene.at(cell);
    double sum = scene.matrix.diagonal(at.block)[at.cell] * p.block(at.block)[at.cell];
    for (int axis = 0; axis < 3; ++axis) {
        const Vec3i lower = cell - Vec3i::Unit(axis), upper = cell + Vec3i::Unit(axis);
        sum -= scene.matrix.coupling(axis, at.block)[at.cell] * scene.value(p, lower);
        const CellRef up = scene.at(upper);
        if (up.block != BlockGrid::kNone) sum -= scene.matrix.coupling(axis, up.block)[up.cell] * scene.value(p, upper);
    }
    return sum;
}

inline BlockArray<double> solvableRhs(const PoissonScene& scene);

/// max|rhs − A p| / max|rhs| over the unknowns, where a solution exists.
inline double relativeResidual(const PoissonScene& scene, const BlockArray<double>& p)
{
    const BlockArray<double> solvable = solvableRhs(scene);
    double largest = 0.0, largestRhs = 0.0;
    scene.forEachCell([&](const Vec3i& cell, int b, int c) {
        if (!scene.isUnknown(b, c)) return;
        largest = std::max(largest, std::abs(solvable.block(b)[c] - matrixTimes(scene, p, cell)));
        largestRhs = std::max(largestRhs, std::abs(scene.rhs.block(b)[c]));
    });
    return largest / largestRhs;
}

/// The right-hand side without its means over components that have no Dirichlet part, found by walking from cell to cell.
inline BlockArray<double> solvableRhs(const PoissonScene& scene)
{
    BlockArray<double> rhs = scene.rhs;
    BlockArray<char> seen;
    seen.resize(scene.grid.count());
    const auto coupling = [&](int axis, const Vec3i& cell) {
        const CellRef at = scene.at(cell);
        return at.block == BlockGrid::kNone ? 0.0 : scene.matrix.coupling(axis, at.block)[at.cell];
    };
    scene.forEachCell([&](const Vec3i& start, int b, int c) {
        if (!scene.isUnknown(b, c) || seen.block(b)[c]) return;
        std::vector<Vec3i> cells = {start};
        seen.block(b)[c] = 1;
        double sum = 0.0;
        bool isClosed = true;
        for (std::size_t n = 0; n < cells.size(); ++n) {
            const Vec3i cell = cells[n];
            double rest = scene.matrix.diagonal(scene.at(cell).block)[scene.at(cell).cell];
            sum += scene.value(scene.rhs, cell);
            for (int axis = 0; axis < 3; ++axis)
                for (int side : {-1, 1}) {
                    const Vec3i other = cell + side * Vec3i::Unit(axis);
                    const double k = coupling(axis, side < 0 ? cell : other);
                    rest -= k;
                    if (k == 0.0) continue;
                    const CellRef at = scene.at(other);
                    if (!std::exchange(seen.block(at.block)[at.cell], 1)) cells.push_back(other);
                }
            isClosed = isClosed && std::abs(rest) < 1.0e-14;
        }
        if (!isClosed) return;
        for (const Vec3i& cell : cells) {
            const CellRef at = scene.at(cell);
            rhs.block(at.block)[at.cell] -= sum / static_cast<double>(cells.size());
        }
    });
    return rhs;
}

/// Random cells, open faces and distances to the surface. Faces: a quarter closed, the rest 1e-3 … 1.
inline PoissonScene randomScene(std::mt19937& random, const Vec3i& n, const Vec3i& corner, double liquidShare)
{
    const auto hash = [seed = static_cast<unsigned>(random())](const Vec3i& c, unsigned salt) {
        unsigned h = seed ^ salt * 0x9e3779b9u;
        for (int a = 0; a < 3; ++a) h = (h ^ static_cast<unsigned>(c[a])) * 0x85ebca6bu, h ^= h >> 15;
        return (h * 0xc2b2ae35u >> 8) / 16777216.0;
    };
    const auto phi = [=](const Vec3& x) {
        const Vec3i c = x.array().floor().cast<int>();
        const double distance = 0.01 + 0.99 * hash(c, 1);
        return hash(c, 2) < liquidShare ? -distance : distance;
    };
    const auto open = [=](int axis, const Vec3i& c) {
        const double u = hash(c, 3 + axis);
        return u < 0.25 ? 0.0 : std::pow(10.0, -3.0 * (u - 0.25) / 0.75);
    };
    return makeScene({corner, corner + n, phi, open, [=](const Vec3i& c) { return 2.0 * hash(c, 7) - 1.0; }});
}

inline BlockArray<double> zeroPressure(const PoissonScene& scene)
{
    BlockArray<double> p;
    p.resize(scene.grid.count());
    return p;
}

inline bool sameBits(const BlockArray<double>& a, const BlockArray<double>& b)
{
    return a.size() == b.size() && std::memcmp(a.block(0), b.block(0), a.size() * sizeof(double)) == 0;
}

}  // namespace sim::test
