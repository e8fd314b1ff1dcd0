#pragma once

#include "sim/solvers/poisson.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <random>
#include <vector>

// Poisson systems for tests and benchmarks: which cells are liquid, and how open the faces between them are.

namespace sim::test {

/// A system and its grid, filled cell by cell.
struct PoissonScene {
    BlockGrid grid;
    PoissonMatrix matrix;
    BlockArray<double> rhs;
    int cells = 0;

    CellRef at(const Vec3i& c) const
    {
        const int b = grid.find({c.x() >> 3, c.y() >> 3, c.z() >> 3});
        return {b, cellInBlock(c.x() & 7, c.y() & 7, c.z() & 7)};
    }
    template <class Array>
    double value(const Array& v, const Vec3i& c) const
    {
        const CellRef ref = at(c);
        return ref.block == BlockGrid::kNone ? 0.0 : v.block(ref.block)[ref.cell];
    }
    /// body(cell) for every cell of every block.
    template <class Body>
    void forEachCell(Body&& body) const
    {
        for (int b = 0; b < grid.count(); ++b)
            for (int c = 0; c < kBlockCells; ++c) body(Vec3i(8 * grid.coords(b) + Vec3i(c % 8, c / 8 % 8, c / 64)), b, c);
    }
    bool isUnknown(int b, int c) const { return matrix.diagonal(b)[c] > 0.0; }
};

/// What a scene is made of, for cells of an axis-parallel range.
struct PoissonShape {
    Vec3i lower, upper;                                  ///< cells in [lower, upper)
    std::function<double(const Vec3&)> phi;              ///< liquid where negative; at cell centres, in cells
    std::function<double(int axis, const Vec3i&)> open;  ///< share of the lower face of a cell that is not wall
    std::function<double(const Vec3i&)> rhs;
    double smallestTheta = 0.01;
};

/// The walls of a box: open inside, closed outside and on the faces of the walls.
inline std::function<double(int, const Vec3i&)> boxWalls(Vec3i lower, Vec3i upper)
{
    return [=](int axis, const Vec3i& c) {
        const Vec3i below = c - Vec3i::Unit(axis);
        return (c.array() >= lower.array()).all() && (c.array() < upper.array()).all() && (below.array() >= lower.array()).all() ? 1.0 : 0.0;
    };
}

inline double roughRhs(const Vec3i& c)
{
    return 0.3 * std::sin(c.x() * 0.5) * std::cos(c.y() * 0.4) + 0.1 * std::sin(c.x() * 7.1 + c.y() * 3.3 + c.z() * 5.7);
}

inline PoissonScene makeScene(const PoissonShape& shape)
{
    PoissonScene scene;
    const auto phiAt = [&](const Vec3i& c) { return shape.phi(c.cast<double>() + Vec3::Constant(0.5)); };
    const auto inRange = [&](const Vec3i& c) { return (c.array() >= shape.lower.array()).all() && (c.array() < shape.upper.array()).all(); };
    std::vector<Vec3i> blocks;
    const Vec3i first(shape.lower.x() >> 3, shape.lower.y() >> 3, shape.lower.z() >> 3);
    const Vec3i last((shape.upper.x() - 1) >> 3, (shape.upper.y() - 1) >> 3, (shape.upper.z() - 1) >> 3);
    for (int k = first.z(); k <= last.z(); ++k)
        for (int j = first.y(); j <= last.y(); ++j)
            for (int i = first.x(); i <= last.x(); ++i) {
                bool any = false;
                for (int c = 0; c < kBlockCells && !any; ++c) {
                    const Vec3i cell = 8 * Vec3i(i, j, k) + Vec3i(c % 8, c / 8 % 8, c / 64);
                    any = inRange(cell) && phiAt(cell) < 0.0;
                }
                if (any) blocks.push_back({i, j, k});
            }
    scene.grid.setBlocks(blocks);
    scene.matrix.resize(scene.grid.count());
    scene.rhs.resize(scene.grid.count());
    scene.forEachCell([&](const Vec3i& cell, int b, int c) {
        for (int kind = 0; kind < 4; ++kind) scene.matrix.values.block(b, kind)[c] = 0.0;
        scene.rhs.block(b)[c] = 0.0;
        if (!inRange(cell) || !(phiAt(cell) < 0.0)) return;
        double diagonal = 0.0;
        for (int axis = 0; axis < 3; ++axis)
            for (int side : {-1, 1}) {
                const Vec3i n = cell + side * Vec3i::Unit(axis);
                const double open = shape.open(axis, side < 0 ? cell : n);
                const double phiN = phiAt(n);
                const bool isLiquid = inRange(n) && phiN < 0.0;
                const double theta = isLiquid ? 1.0 : std::max(shape.smallestTheta, phiAt(cell) / (phiAt(cell) - std::max(phiN, 0.0)));
                diagonal += open / theta;
                if (isLiquid && side < 0) scene.matrix.coupling(axis, b)[c] = open;
            }
        scene.matrix.diagonal(b)[c] = diagonal;
        scene.rhs.block(b)[c] = diagonal > 0.0 ? shape.rhs(cell) : 0.0;
        scene.cells += diagonal > 0.0;
    });
    return scene;
}

/// A tank with a sloping pool and waves on it: about 87 000 cells, or a smaller part of it.
inline PoissonScene poolWithWaves(int length = 140)
{
    const Vec3i lower(1, 1, 1), upper(length - 1, 60, 35);
    const auto phi = [](const Vec3& x) {
        const double slope = x.x() < 50 ? 38 - 0.25 * x.x() : std::max(4.0, 25.5 - 0.35 * (x.x() - 50));
        return 0.8 * (x.y() - 1 - slope - 1.5 * std::sin(x.x() * 0.2 + x.z() * 0.25) - 0.8 * std::sin(x.z() * 0.7));
    };
    return makeScene(
        {lower, upper, phi, boxWalls(lower, {length - 1, 1000, 35}), [](const Vec3i& c) { return (c.y() == 1 ? 1.0 : 0.0) - roughRhs(c); }});
}

/// A closed box of n³ cells, air above a wavy surface.
inline PoissonScene boxWithSurface(Vec3i n, Vec3i corner = Vec3i(0, 0, 0))
{
    const auto phi = [=](const Vec3& x) {
        const Vec3 r = x - corner.cast<double>();
        return r.y() - 0.9 * n.y() - 0.05 * n.y() * std::sin(6.0 * r.x() / n.x()) * std::cos(5.0 * r.z() / n.z());
    };
    return makeScene({corner, corner + n, phi, boxWalls(corner, corner + Vec3i(n.x(), 2 * n.y(), n.z())),
                      [=](const Vec3i& c) { return (c.y() == corner.y() ? 1.0 : 0.0) - roughRhs(c - corner); }});
}

/// A box full of liquid, walls on all sides: singular.
inline PoissonScene fullBox(Vec3i n)
{
    return makeScene({Vec3i(0, 0, 0), n, [](const Vec3&) { return -1.0; }, boxWalls(Vec3i(0, 0, 0), n), [](const Vec3i& c) { return roughRhs(c); }});
}

}  // namespace sim::test
