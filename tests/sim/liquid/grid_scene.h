#pragma once

#include "sim/liquid/cells.h"
#include "sim/liquid/pressure.h"

#include <random>

namespace sim::test {

/// Liquid, obstacles and air given on the grid, without particles: whatever a test of the liquid's stages starts from.
struct GridScene {
    BlockGrid grid;
    Obstacles obstacles;
    ObstacleField field;
    LiquidGrid liquid;
    PressureWorkspace work;
    LiquidSettings settings;
    SolverSettings solver{1.0e-14, 200};
    BlockArray<double> pressure;
    BlockArray<double> levelSet;  ///< distance to the surface at the cell middles [cm], negative in the liquid
    Vec3i lower, upper;           ///< the cells that exist: lower … upper − 1, whole blocks

    /// Blocks that hold the cells lower … upper − 1.
    GridScene(const Vec3i& first, const Vec3i& end, double dx = 0.288, const Vec3& origin = Vec3(0.1, -0.2, 0.3))
    {
        grid.dx = dx;
        grid.origin = origin;
        std::vector<Vec3i> blocks;
        const Vec3i from = first.unaryExpr([](int v) { return v >> 3; }), to = end.unaryExpr([](int v) { return (v - 1) >> 3; });
        for (int z = from.z(); z <= to.z(); ++z)
            for (int y = from.y(); y <= to.y(); ++y)
                for (int x = from.x(); x <= to.x(); ++x) blocks.emplace_back(x, y, z);
        grid.setBlocks(blocks);
        lower = 8 * from;
        upper = 8 * (to + Vec3i::Ones());
        liquid.faces.sums.resize(grid.count());
        liquid.resize(grid.count(), false);
        liquid.fullMass = settings.density * std::pow(dx, 3);
        pressure.resize(grid.count());
        levelSet.resize(grid.count());
        for (int b = 0; b < grid.count(); ++b) {
            std::fill_n(levelSet.block(b), kBlockCells, dx);
            for (BlockBits<>* bits : {&liquid.inside, &liquid.surface, &liquid.deep}) std::fill_n(bits->block(b), BlockBits<>::kWords, 0);
            std::fill_n(liquid.faces.sums.block(b), 6 * kBlockCells, 0.0);
            std::fill_n(pressure.block(b), kBlockCells, 0.0);
            std::fill_n(liquid.faces.velocity.block(b), 3 * kBlockCells, 0.0);
            std::fill_n(liquid.wet.block(b), 3 * BlockBits<3>::kWords, 0);
            std::fill_n(liquid.faces.valid.block(b), 3 * BlockBits<3>::kWords, 0);
        }
        updateObstacles();
    }

    CutGrid cut() const { return {grid, field, obstacles}; }

    void updateObstacles()
    {
        const std::vector<int> unknown(grid.count(), BlockGrid::kNone);
        field.update(grid, unknown, obstacles, false);
    }
    void add(const Shape& shape, const Motion& motion = {})
    {
        obstacles.add(shape, motion);
        obstacles.moveTo(0.0, 0.0);
        updateObstacles();
    }

    CellRef at(const Vec3i& c) const { return {grid.find({c.x() >> 3, c.y() >> 3, c.z() >> 3}), cellInBlock(c.x() & 7, c.y() & 7, c.z() & 7)}; }
    double& velocity(int axis, const Vec3i& c) { return liquid.faces.velocity.block(at(c).block, axis)[at(c).cell]; }
    double& phi(const Vec3i& c) { return levelSet.block(at(c).block)[at(c).cell]; }
    bool isInside(const Vec3i& c) const { return liquid.inside.test(at(c).block, at(c).cell); }
    double open(int axis, const Vec3i& c) const { return field.open(at(c).block, axis)[at(c).cell]; }
    bool isValid(int axis, const Vec3i& c) const { return liquid.faces.valid.test(at(c).block, at(c).cell, axis); }
    void setValid(int axis, const Vec3i& c) { liquid.faces.valid.set(at(c).block, at(c).cell, axis); }
    double pressureAt(const Vec3i& c) const { return pressure.block(at(c).block)[at(c).cell]; }

    Vec3 corner(const Vec3i& c) const { return grid.origin + grid.dx * c.cast<double>(); }
    Vec3 middle(const Vec3i& c) const { return corner(c) + Vec3::Constant(0.5 * grid.dx); }
    Vec3 faceMiddle(int axis, const Vec3i& c) const { return middle(c) - 0.5 * grid.dx * Vec3::Unit(axis); }

    template <class F>
    void forEachCell(F&& f) const
    {
        for (int z = lower.z(); z < upper.z(); ++z)
            for (int y = lower.y(); y < upper.y(); ++y)
                for (int x = lower.x(); x < upper.x(); ++x) f(Vec3i(x, y, z));
    }
    template <class F>
    void forEachFace(F&& f) const
    {
        for (int a = 0; a < kAxes; ++a) forEachCell([&](const Vec3i& c) { f(a, c); });
    }

    /// Liquid where distance(x) < 0 [cm].
    template <class Distance>
    void fill(Distance&& distance)
    {
        forEachCell([&](const Vec3i& c) { phi(c) = distance(middle(c)); });
        findInside();
        setMasses();
    }
    /// Liquid cells are those with a negative level set that are not blocked; all of these where there is no air.
    void findInside()
    {
        forEachCell([&](const Vec3i& c) {
            const CellRef ref = at(c);
            const bool blocked = field.blocked(ref.block)[ref.cell >> 6] >> (ref.cell & 63) & 1;
            if ((settings.full || phi(c) < 0.0) && !blocked) liquid.inside.set(ref.block, ref.cell);
        });
        findSurface(cut(), givenCells(), liquid);
    }
    /// The cells as they are given, in place of those that the masses on faces would make.
    LiquidCells givenCells()
    {
        const LiquidGrid given = liquid;
        const LiquidCells cells = findLiquidCells(cut(), settings.full, liquid);
        liquid = given;
        return cells;
    }
    SurfaceCells givenSurface()
    {
        const LiquidGrid given = liquid;
        const SurfaceCells cells = findSurface(cut(), givenCells(), liquid);
        liquid = given;
        return cells;
    }
    /// Faces of liquid cells are wet. Between two such cells they are full, else they carry the ghost fluid's fraction:
    /// that of the way from the liquid cell's middle to the other one's on which there is liquid.
    void setMasses()
    {
        forEachFace([&](int a, const Vec3i& c) {
            const Vec3i below = c - Vec3i::Unit(a);
            const bool above = isInside(c), under = below[a] >= lower[a] && isInside(below);
            if (!above && !under) return;
            const CellRef ref = at(c);
            liquid.wet.set(ref.block, ref.cell, a);
            const double full = liquid.fullMass * field.room(ref.block, a)[ref.cell];
            liquid.faces.sums.block(ref.block, FaceFields::kMass + a)[ref.cell] = full * (above && under ? 1.0 : ghostFraction(c, below));
        });
    }
    double ghostFraction(const Vec3i& one, const Vec3i& other)
    {
        const double a = phi(one), b = phi(other);
        return a * b < 0.0 ? std::min(a, b) / (std::min(a, b) - std::max(a, b)) : 1.0;
    }

    /// velocity(face) = u(x)[axis] everywhere.
    template <class U>
    void setVelocities(U&& u)
    {
        forEachFace([&](int a, const Vec3i& c) { velocity(a, c) = u(faceMiddle(a, c))[a]; });
    }
    void setRandomVelocities(double scale, unsigned seed = 3)
    {
        std::mt19937 random(seed);
        std::uniform_real_distribution<double> unit(-scale, scale);
        forEachFace([&](int a, const Vec3i& c) { velocity(a, c) = unit(random); });
    }

    PressureFaces pressureFaces(double dt) { return findPressureFaces(cut(), settings, dt, givenSurface(), work); }
    /// The system of a step of dt [s]. It is of this scene, not of copies.
    PressureSystem system(double dt) { return preparePressure(pressureFaces(dt), grid); }
    SolveReport project(double dt) { return project(system(dt)); }
    SolveReport project(const PressureSystem& prepared) { return solvePressure(cut(), solver, {}, prepared, liquid, pressure); }
    double divergence() const { return largestDivergence(cut(), liquid); }

    /// max |u − expected| over the valid faces with open fraction > 0.
    template <class U>
    double largestError(U&& expected)
    {
        double largest = 0.0;
        forEachFace([&](int a, const Vec3i& c) {
            if (isValid(a, c) && open(a, c) > 0.0) largest = std::max(largest, std::abs(velocity(a, c) - expected(faceMiddle(a, c))[a]));
        });
        return largest;
    }
    std::size_t countLiquid() const
    {
        std::size_t count = 0;
        forEachCell([&](const Vec3i& c) { count += isInside(c); });
        return count;
    }
};

/// A tank whose walls lie in planes of faces: cells first … end − 1 of the scene are inside.
inline Shape tankOfCells(const GridScene& scene, const Vec3i& first, const Vec3i& end)
{
    const Vec3 low = scene.corner(first), high = scene.corner(end);
    return Shape::box(0.5 * (low + high), 0.5 * (high - low)).inverted();
}

/// A tank turned about a skew axis, so that no wall is aligned with the grid.
inline Shape skewTank(const GridScene& scene)
{
    Eigen::Isometry3d place = Eigen::Isometry3d::Identity();
    place.translate(scene.corner({8, 8, 8}));
    place.rotate(Eigen::AngleAxisd(0.7, Vec3(1.0, 2.0, -0.5).normalized()));
    return Shape::box(Vec3::Zero(), Vec3(6.0, 5.0, 5.5) * scene.grid.dx).inverted().moved(place);
}

}  // namespace sim::test
