#include "app/frames/sample_pressure.h"

#include "app/frames/snapshot_from_state.h"

#include <gtest/gtest.h>

namespace app::test {
namespace {

using sim::Vec3;
using sim::Vec3i;

/// Two blocks side by side along x, cells of 0.5 cm, with a pressure that is linear in space from cell `first` along x
/// on, and none below.
struct LinearPressure {
    explicit LinearPressure(int first)
    {
        sim::BlockGrid& grid = state.grid;
        grid.dx = 0.5;
        grid.origin = {1.0, 2.0, 3.0};
        const std::array blocks = {Vec3i(-1, 0, 0), Vec3i(0, 0, 0)};
        grid.setBlocks(blocks);
        state.pressure.resize(grid.count());
        state.step = 1;
        for (int b = 0; b < grid.count(); ++b)
            for (int c = 0; c < sim::kBlockCells; ++c) {
                const Vec3i cell = 8 * grid.coords(b) + Vec3i(c & 7, c >> 3 & 7, c >> 6);
                const Vec3 middle = grid.origin + grid.dx * (cell.cast<double>() + Vec3::Constant(0.5));
                state.pressure.block(b)[c] = cell.x() < first ? 0.0 : exact(middle);
            }
    }
    static double exact(const Vec3& x) { return 1000.0 + 30.0 * x.x() - 50.0 * x.y() + 20.0 * x.z(); }
    sim::State state;
};

TEST(SmoothPressure, IsExactWhereThePressureIsLinear)
{
    const LinearPressure p(-8);
    for (const Vec3& x : {Vec3(1.1, 3.0, 4.0), Vec3(0.9, 3.3, 4.2), Vec3(-2.7, 2.3, 6.7), Vec3(4.7, 5.7, 3.3)})
        EXPECT_NEAR(smoothPressure(p.state, x), LinearPressure::exact(x), 1.0e-9) << x.transpose();
}

/// Up to a wall or the surface, the pressure of the nearest cells goes on instead of falling to zero.
TEST(SmoothPressure, GoesOnWhereCellsHaveNone)
{
    const LinearPressure p(0);
    const Vec3 lastMiddle(1.25, 3.0, 4.0);
    EXPECT_NEAR(smoothPressure(p.state, {1.05, 3.0, 4.0}), LinearPressure::exact(lastMiddle), 1.0e-9);
    EXPECT_EQ(smoothPressure(p.state, {0.2, 3.0, 4.0}), 0.0) << "no cell around has one";
    EXPECT_EQ(smoothPressure(p.state, {100.0, 3.0, 4.0}), 0.0) << "no block";
}

TEST(SmoothPressure, IsNothingBeforeTheFirstStep)
{
    LinearPressure p(-8);
    p.state.step = 0;
    EXPECT_EQ(smoothPressure(p.state, {1.1, 3.0, 4.0}), 0.0);
}

TEST(Snapshot, ValuesAreSpeedsOrPressures)
{
    LinearPressure p(-8);
    const Vec3 place(1.1, 3.0, 4.0);
    p.state.liquid.add(place, 1.0, 0, {3.0, 4.0, 0.0});
    FrameSnapshot snapshot;
    fillSnapshot(p.state, {}, nullptr, 1.0, {}, snapshot);
    EXPECT_EQ(snapshot.values.at(0), 5.0f);
    fillSnapshot(p.state, {}, nullptr, 1.0, {.pressure = true}, snapshot);
    EXPECT_NEAR(snapshot.values.at(0), LinearPressure::exact(place), 1.0e-3);
    EXPECT_TRUE(snapshot.extras.pressure);
    EXPECT_EQ(snapshot.view().liquid.values[0], snapshot.values[0]);
}

}  // namespace
}  // namespace app::test
