#include "app/frames/sample_pressure.h"

namespace app {

double smoothPressure(const sim::State& state, const sim::Vec3& place)
{
    return state.step == 0 ? 0.0 : smoothInLiquid(state.grid, state.pressure, place);
}

double smoothInLiquid(const sim::BlockGrid& grid, const sim::BlockArray<double>& field, const sim::Vec3& place)
{
    const sim::Vec3 inCells = (place - grid.origin) / grid.dx;
    const sim::Vec3i blockCoords = (inCells / sim::kBlockEdge).array().floor().cast<int>();
    const int block = grid.find(blockCoords);
    if (block == sim::BlockGrid::kNone) return 0.0;

    // From the middle of the lowest of the eight cells on, in cells.
    const sim::Vec3 middles = inCells - (sim::kBlockEdge * blockCoords).cast<double>() - sim::Vec3::Constant(0.5);
    const sim::Vec3i lowest = middles.array().floor().cast<int>();
    const sim::Vec3 above = middles - lowest.cast<double>();
    double sum = 0.0, weights = 0.0;
    for (int corner = 0; corner < 8; ++corner) {
        const sim::Vec3i step(corner & 1, corner >> 1 & 1, corner >> 2);
        const sim::Vec3i cell = lowest + step;
        const sim::CellRef at = sim::cellNear(grid, block, cell.x(), cell.y(), cell.z());
        const double value = field.block(at.block)[at.cell];
        if (value == 0.0) continue;  // cells without a pressure hold nothing else
        double weight = 1.0;
        for (int axis = 0; axis < 3; ++axis) weight *= step[axis] == 1 ? above[axis] : 1.0 - above[axis];
        sum += weight * value;
        weights += weight;
    }
    return weights > 0.0 ? sum / weights : 0.0;
}

}  // namespace app
