#include "sim/coupling/suction.h"

#include "sim/core/parallel.h"
#include "sim/coupling/cell_stencil.h"

#include <algorithm>
#include <cmath>

namespace sim {

namespace {

/// Index in its block, by axes.
std::array<int, kAxes> placeOf(int cell) { return {cell % kBlockEdge, cell / kBlockEdge % kBlockEdge, cell / (kBlockEdge * kBlockEdge)}; }

/// Mean mass on the six faces of a cell: what it holds, but for half a cell more of smearing [g].
double massIn(const BlockGrid& grid, const LiquidGrid& liquid, int block, int cell)
{
    double sum = 0.0;
    const std::array<int, kAxes> at = placeOf(cell);
    for (int a = 0; a < kAxes; ++a) {
        std::array<int, kAxes> above = at;
        ++above[a];
        const CellRef upper = cellNear(grid, block, above[0], above[1], above[2]);
        sum += liquid.faces.sums.block(block, FaceFields::kMass + a)[cell] + liquid.faces.sums.block(upper.block, FaceFields::kMass + a)[upper.cell];
    }
    return sum / (2 * kAxes);
}

}  // namespace

Suction::Suction(const Fabric& fabric, const Settings& settings) : fabric_(fabric), density_(settings.liquid.density)
{
    for (const FabricMaterial& m : fabric.materials)
        strength_.push_back(PorousLaw({settings.porous.fibreDiameter, m.volumeFraction}, settings.liquid, settings.coupling).suctionOfPores());
}

double Suction::pullOf(std::size_t vertex) const
{
    return (fabric_.volume[vertex] - poreVolume(fabric_, vertex)) * strength_[fabric_.vertexMaterial[vertex]];
}

void Suction::find(const SortedVertices& vertices, const FabricState& state, const BlockGrid& grid, std::span<const int> liquidBlock,
                   const LiquidGrid& liquid)
{
    const int blocks = vertices.grid.count();
    volumes_.resize(blocks);
    suction_.resize(blocks);
    parallelFor(blocks, [&](std::size_t b) { std::fill_n(volumes_.block(static_cast<int>(b)), kKinds * kBlockCells, 0.0); });
    for (const std::vector<int>& color : vertices.order.byColor)
        parallelFor(color.size(), [&](std::size_t n) {
            const int block = color[n];
            const Vec3 corner = vertices.grid.lowerCorner(block);
            for (int s = vertices.order.begin(block); s < vertices.order.end(block); ++s) {
                const std::size_t v = vertices.particles.id[s];
                const double pores = poreVolume(fabric_, v), fibres = fabric_.volume[v] - pores, held = state.absorbed[v] / density_;
                const double pull = pullOf(v);
                CellStencil(vertices.particles.position(s), corner, vertices.grid.dx)
                    .forEach(vertices.grid.neighbours(block), [&](int b, int c, double weight) {
                        volumes_.block(b, kFibres)[c] += weight * fibres;
                        volumes_.block(b, kPull)[c] += weight * pull;
                        volumes_.block(b, kPores)[c] += weight * pores;
                        volumes_.block(b, kHeld)[c] += weight * held;
                    });
            }
        });
    const double whole = std::pow(vertices.grid.dx, 3);
    parallelFor(blocks, [&](std::size_t n) {
        const int b = static_cast<int>(n);
        for (int c = 0; c < kBlockCells; ++c) {
            const double fibres = volumes_.block(b, kFibres)[c], fraction = std::clamp(fibres / whole, 0.0, 1.0);
            double& suction = suction_.block(b)[c];
            suction = 0.0;
            if (!(fraction > 0.0 && fraction < 1.0)) continue;
            const double free = liquidBlock[b] == BlockGrid::kNone ? 0.0 : massIn(grid, liquid, liquidBlock[b], c) / density_;
            const double held = volumes_.block(b, kHeld)[c], pores = volumes_.block(b, kPores)[c];
            const double saturation = std::clamp(std::max((free + held) / (whole - fibres), held / pores), 0.0, 1.0);
            suction = volumes_.block(b, kPull)[c] / (whole - fibres) * (1.0 - saturation);
        }
    });
}

double Suction::slope(const BlockGrid& grid, int block, int axis, int cell) const
{
    std::array<int, kAxes> below = placeOf(cell);
    --below[axis];
    const CellRef ref = cellNear(grid, block, below[0], below[1], below[2]);
    return (suction_.block(block)[cell] - suction_.block(ref.block)[ref.cell]) / grid.dx;
}

void Suction::applyReaction(const SortedVertices& vertices, const BlockArray<double, 3>& perSlope, std::span<Vec3> impulse)
{
    const BlockGrid& grid = vertices.grid;
    back_.resize(grid.count());
    parallelFor(grid.count(), [&](std::size_t n) {
        const int b = static_cast<int>(n);
        for (int c = 0; c < kBlockCells; ++c) {
            const double pull = volumes_.block(b, kPull)[c], perPull = pull > 0.0 ? suction_.block(b)[c] / (pull * grid.dx) : 0.0;
            for (int a = 0; a < kAxes; ++a) {
                double& back = back_.block(b, a)[c];
                back = 0.0;
                if (perPull == 0.0) continue;
                std::array<int, kAxes> above = placeOf(c);
                ++above[a];
                const CellRef upper = cellNear(grid, b, above[0], above[1], above[2]);
                back = perPull * (perSlope.block(upper.block, a)[upper.cell] - perSlope.block(b, a)[c]);
            }
        }
    });
    std::ranges::fill(impulse, Vec3::Zero());
    parallelFor(grid.count(), [&](std::size_t n) {
        const int block = static_cast<int>(n);
        for (int s = vertices.order.begin(block); s < vertices.order.end(block); ++s) {
            const std::size_t v = vertices.particles.id[s];
            Vec3 sum = Vec3::Zero();
            CellStencil(vertices.particles.position(s), grid.lowerCorner(block), grid.dx)
                .forEach(grid.neighbours(block), [&](int b, int c, double weight) {
                    for (int a = 0; a < kAxes; ++a) sum[a] += weight * back_.block(b, a)[c];
                });
            impulse[v] = pullOf(v) * sum;
        }
    });
}

}  // namespace sim
