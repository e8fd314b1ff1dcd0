#include "sim/liquid/inflow.h"

#include "sim/core/parallel.h"

#include <algorithm>
#include <cmath>

namespace sim {

namespace {

/// Share of a cell that a shape fills, from distances at the middles of 4³ parts of it. Parts that a thin shape touches count, too.
double shareOf(const Shape& shape, const Vec3& middle, double dx)
{
    const double reach = 0.5 * std::sqrt(3.0) * dx, d = shape.distance(middle);
    if (std::abs(d) >= reach) return d < 0.0 ? 1.0 : 0.0;
    constexpr int kParts = 4;
    const double part = dx / kParts;
    double sum = 0.0;
    for (int n = 0; n < kParts * kParts * kParts; ++n) {
        const Vec3 place(n % kParts, n / kParts % kParts, n / (kParts * kParts));
        const Vec3 x = middle + part * (place - Vec3::Constant(0.5 * (kParts - 1)));
        sum += std::clamp(0.5 - shape.distance(x) / part, 0.0, 1.0);
    }
    return sum / (kParts * kParts * kParts);
}

/// The cells of a box that have a pressure and a share of the mouth, with the shares in place of rates.
void appendShares(const BlockGrid& grid, const LiquidGrid& liquid, const Inflow& inflow, std::vector<InflowCell>& cells)
{
    const Eigen::AlignedBox3d box = inflow.mouth.bounds();
    if (box.isEmpty()) return;
    const Vec3i low = ((box.min() - grid.origin) / grid.dx).array().floor().cast<int>(),
                high = ((box.max() - grid.origin) / grid.dx).array().floor().cast<int>();
    const std::size_t begin = cells.size();
    for (int k = low[2]; k <= high[2]; ++k)
        for (int j = low[1]; j <= high[1]; ++j)
            for (int i = low[0]; i <= high[0]; ++i) {
                const int block = grid.find(Vec3i(i >> 3, j >> 3, k >> 3)), cell = cellInBlock(i & 7, j & 7, k & 7);
                if (block != BlockGrid::kNone && liquid.inside.test(block, cell)) cells.push_back({inflow.source, block, cell, 0.0});
            }
    parallelFor(cells.size() - begin, 64, [&](std::size_t n) {
        InflowCell& c = cells[begin + n];
        const Vec3 place(c.cell % kBlockEdge, c.cell / kBlockEdge % kBlockEdge, c.cell / (kBlockEdge * kBlockEdge));
        c.rate = shareOf(inflow.mouth, grid.lowerCorner(c.block) + grid.dx * (place + Vec3::Constant(0.5)), grid.dx);
    });
    cells.erase(std::remove_if(cells.begin() + static_cast<std::ptrdiff_t>(begin), cells.end(), [](const InflowCell& c) { return !(c.rate > 0.0); }),
                cells.end());
}

/// How full a closed piece of the pressure system is, on average [-].
double fillOf(int piece, const BlockGrid& grid, const LiquidGrid& liquid, const ConnectedComponents& pieces)
{
    const auto sumOver = [&](auto&& value) {
        return parallelSum(grid.count(), [&](std::size_t b) {
            double sum = 0.0;
            for (int c = 0; c < kBlockCells; ++c)
                if (pieces.closedOf(static_cast<int>(b), c) == piece) sum += value(liquid.fill.block(static_cast<int>(b))[c]);
            return sum;
        });
    };
    return sumOver([](double fill) { return fill; }) / sumOver([](double) { return 1.0; });
}

}  // namespace

void findInflowCells(const BlockGrid& grid, const LiquidCells& liquidCells, const std::vector<Inflow>& inflows, double packing, double dt,
                     std::vector<InflowCell>& cells)
{
    cells.clear();
    const double cellVolume = packing * grid.dx * grid.dx * grid.dx;
    for (const Inflow& inflow : inflows) {
        const std::size_t begin = cells.size();
        appendShares(grid, liquidCells.liquid(), inflow, cells);
        double sum = 0.0;
        for (std::size_t n = begin; n < cells.size(); ++n) sum += cells[n].rate;
        for (std::size_t n = begin; n < cells.size(); ++n) cells[n].rate *= inflow.volume / (cellVolume * dt * sum);
    }
}

double inflowWork(const BlockGrid& grid, const std::vector<InflowCell>& cells, const BlockArray<double>& pressure, double dt)
{
    double power = 0.0;
    for (const InflowCell& c : cells) power += c.rate * pressure.block(c.block)[c.cell];
    return power * dt * grid.dx * grid.dx * grid.dx;
}

bool isShutIn(std::size_t source, const std::vector<InflowCell>& cells, const BlockGrid& grid, const PressureComponents& system)
{
    const ConnectedComponents& pieces = system.components();
    constexpr double kFull = 0.99;  // on average: what is left is the noise of the particles' places
    if (pieces.closedCount() == 0) return false;
    int last = -1;
    bool isAny = false;
    for (const InflowCell& c : cells) {
        if (c.source != source) continue;
        isAny = true;
        const int piece = pieces.closedOf(c.block, c.cell);
        if (piece == last && piece >= 0) continue;
        if (piece < 0 || fillOf(piece, grid, system.liquid(), pieces) < kFull) return false;
        last = piece;
    }
    return isAny;
}

}  // namespace sim
