// The matrix of viscosity and its preconditioner.
#include "tests/sim/liquid/viscous_scene.h"

#include <gtest/gtest.h>

namespace sim::test {
namespace {

TEST(ViscousSystem, IsSymmetricAndPositive)
{
    for (double friction : {0.0, 1.0}) {
        ViscousScene viscous = puddle(friction);
        viscous.solve(1.0e-2);
        const ViscousSystem& system = viscous.work.system;
        const BlockGrid& grid = viscous.scene.grid;
        std::mt19937 random(1);
        std::uniform_real_distribution<double> unit(-1.0, 1.0);
        const auto some = [&] {
            BlockArray<double, 3> v;
            v.resize(grid.count());
            for (int b = 0; b < grid.count(); ++b)
                for (int a = 0; a < kAxes; ++a)
                    for (int c = 0; c < kBlockCells; ++c) v.block(b, a)[c] = system.unknown.test(b, c, a) ? unit(random) : 0.0;
            return v;
        };
        const auto times = [&](const BlockArray<double, 3>& v) {
            BlockArray<double, 3> out;
            out.resize(grid.count());
            for (int b = 0; b < grid.count(); ++b) system.multiply(grid, v, b, out);
            return out;
        };
        const auto dot = [&](const BlockArray<double, 3>& v, const BlockArray<double, 3>& w) {
            return std::inner_product(v.block(0), v.block(grid.count()), w.block(0), 0.0);
        };
        for (int n = 0; n < 5; ++n) {
            const BlockArray<double, 3> v = some(), w = some(), av = times(v), aw = times(w);
            EXPECT_NEAR(dot(w, av), dot(v, aw), 1.0e-12 * dot(v, av));  // rounding of sums of 10^4 products
            double inertia = 0.0;
            viscous.scene.forEachFace([&](int a, const Vec3i& c) {
                const CellRef ref = viscous.scene.at(c);
                inertia += viscous.mass(a, c) * std::pow(v.block(ref.block, a)[ref.cell], 2);
            });
            EXPECT_GT(dot(v, av), inertia) << friction;
        }
    }
}

/// What conjugate gradients need of a preconditioner.
TEST(ViscousMultigrid, IsSymmetricAndPositive)
{
    ViscousScene viscous = puddle(1.0);
    viscous.scene.settings.viscosity = 1.0e3;
    viscous.solve(1.0e-2, 1.0e-3);
    const GridScene& scene = viscous.scene;
    const int blocks = scene.grid.count();
    std::mt19937 random(2);
    std::uniform_real_distribution<double> unit(-1.0, 1.0);
    std::array<BlockArray<double, 3>, 2> v, cycled;
    for (int n = 0; n < 2; ++n) {
        v[n].resize(blocks);
        viscous.scene.forEachFace(
            [&](int a, const Vec3i& c) { v[n].block(scene.at(c).block, a)[scene.at(c).cell] = viscous.isUnknown(a, c) ? unit(random) : 0.0; });
        viscous.work.multigrid.cycle(v[n]);
        cycled[n] = viscous.work.multigrid.solution();
    }
    const auto dot = [&](int n, int m) { return std::inner_product(v[n].block(0), v[n].block(blocks), cycled[m].block(0), 0.0); };
    EXPECT_GT(dot(0, 0), 0.0);
    EXPECT_GT(dot(1, 1), 0.0);
    EXPECT_NEAR(dot(0, 1), dot(1, 0), 1.0e-12 * dot(0, 0));
}

}  // namespace
}  // namespace sim::test
