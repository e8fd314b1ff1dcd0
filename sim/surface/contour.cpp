#include "sim/surface/contour.h"

#include "sim/core/check.h"
#include "sim/core/parallel.h"
#include "sim/surface/cube_cases.h"

#include <algorithm>
#include <bit>

namespace sim {

namespace {

float valueNear(const BlockGrid& grid, const BlockArray<float>& values, int block, const Vec3i& node)
{
    const CellRef at = cellNear(grid, block, node.x(), node.y(), node.z());
    return values.block(at.block)[at.cell];
}

int countBits(unsigned bits) { return std::popcount(bits); }

template <class Visit>
void forEachBit(unsigned bits, Visit&& visit)
{
    for (; bits != 0; bits &= bits - 1) visit(std::countr_zero(bits));
}

}  // namespace

void Contour::compare(const float* values, float level, Block& block) const
{
    for (int row = 0; row < kRows; ++row) {
        unsigned bits = 0;
        for (int i = 0; i < kBlockEdge; ++i) bits |= (values[kBlockEdge * row + i] > level ? 1u : 0u) << i;
        block.inside[row] = static_cast<std::uint8_t>(bits);
    }
}

/// Nine nodes along x from one of (0, j, k) on, each of j, k in 0 … 8, as bits.
unsigned Contour::insideRow(const BlockGrid& grid, int block, int j, int k) const
{
    const auto& around = grid.neighbours(block);
    const int row = kBlockEdge * (k & 7) + (j & 7), here = neighbourIndex(0, j >> 3, k >> 3);
    return blocks_[around[here]].inside[row] | (blocks_[around[here + 1]].inside[row] & 1u) << kBlockEdge;
}

/// visit(cell, case) for the cells of a block that the surface passes through. Their corners are the eight nodes from
/// the cell's own on upwards.
template <class Visit>
void Contour::forEachCutCell(const BlockGrid& grid, int block, Visit&& visit) const
{
    for (int k = 0; k < kBlockEdge; ++k)
        for (int j = 0; j < kBlockEdge; ++j) {
            const std::array rows = {insideRow(grid, block, j, k), insideRow(grid, block, j + 1, k), insideRow(grid, block, j, k + 1),
                                     insideRow(grid, block, j + 1, k + 1)};
            const unsigned any = rows[0] | rows[1] | rows[2] | rows[3], all = rows[0] & rows[1] & rows[2] & rows[3];
            forEachBit((any | any >> 1) & ~(all & all >> 1) & 0xffu, [&](int i) {
                unsigned inside = 0;
                for (int r = 0; r < 4; ++r) inside |= (rows[r] >> i & 3u) << 2 * r;
                visit(Vec3i(i, j, k), inside);
            });
        }
}

/// How many vertices and triangles a block has, and which of its edges are cut.
void Contour::count(const BlockGrid& grid, int block)
{
    Block& b = blocks_[block];
    b.vertices = 0;
    for (int row = 0; row < kRows; ++row) {
        const int j = row & 7, k = row >> 3;
        const unsigned here = insideRow(grid, block, j, k);
        const std::array above = {here >> 1, insideRow(grid, block, j + 1, k), insideRow(grid, block, j, k + 1)};
        b.rowStart[row] = static_cast<std::uint16_t>(b.vertices);
        for (int axis = 0; axis < kAxes; ++axis) {
            b.cut[axis][row] = static_cast<std::uint8_t>((here ^ above[axis]) & 0xffu);
            b.vertices += countBits(b.cut[axis][row]);
        }
    }
    b.triangles = 0;
    forEachCutCell(grid, block, [&](const Vec3i&, unsigned inside) { b.triangles += cubeCases()[inside].count; });
}

/// Numbers of all vertices and triangles.
std::array<int, 2> Contour::findOffsets()
{
    std::array<int, 2> sums = {0, 0};
    for (Block& b : blocks_) {
        b.firstVertex = sums[0], b.firstTriangle = sums[1];
        sums[0] += b.vertices, sums[1] += b.triangles;
    }
    return sums;
}

/// Number of the vertex on the edge along `axis` from a node on that lies 0 … 8 nodes from the corner of the block.
int Contour::vertexOn(const BlockGrid& grid, int block, int axis, const Vec3i& node) const
{
    const Block& b = blocks_[grid.neighbours(block)[neighbourIndex(node.x() >> 3, node.y() >> 3, node.z() >> 3)]];
    const int row = kBlockEdge * (node.z() & 7) + (node.y() & 7), i = node.x() & 7;
    SIM_CHECK((b.cut[axis][row] >> i & 1) == 1);
    int vertex = b.firstVertex + b.rowStart[row] + countBits(b.cut[axis][row] & ((1u << i) - 1));
    for (int before = 0; before < axis; ++before) vertex += countBits(b.cut[before][row]);
    return vertex;
}

void Contour::placeVertices(const BlockGrid& grid, const BlockArray<float>& values, float level, int block, SurfaceMesh& mesh)
{
    // Not at the very ends, so that no triangle is without an area.
    constexpr float kNearestToNode = 0.01f;
    const Block& b = blocks_[block];
    const Vec3 corner = grid.lowerCorner(block);
    int vertex = b.firstVertex;
    for (int row = 0; row < kRows; ++row)
        for (int axis = 0; axis < kAxes; ++axis)
            forEachBit(b.cut[axis][row], [&](int i) {
                const Vec3i node(i, row & 7, row >> 3);
                const float from = valueNear(grid, values, block, node), to = valueNear(grid, values, block, node + Vec3i::Unit(axis));
                const Crossing crossing{block, static_cast<std::uint16_t>(kBlockEdge * row + i), static_cast<std::uint16_t>(axis),
                                        std::clamp((level - from) / (to - from), kNearestToNode, 1.0f - kNearestToNode)};
                crossings_[vertex] = crossing;
                mesh.positions[vertex++] = corner + grid.dx * crossing.place().cast<double>();
            });
}

void Contour::makeTriangles(const BlockGrid& grid, int block, SurfaceMesh& mesh) const
{
    int next = blocks_[block].firstTriangle;
    forEachCutCell(grid, block, [&](const Vec3i& cell, unsigned inside) {
        const CubeCase& cube = cubeCases()[inside];
        const auto vertexAt = [&](int edge) {
            const auto [axis, corner] = kCubeEdges[edge];
            return vertexOn(grid, block, axis, cell + Vec3i(corner & 1, corner >> 1 & 1, corner >> 2));
        };
        for (int t = 0; t < cube.count; ++t)
            for (int c = 0; c < 3; ++c) mesh.triangles[next + t][c] = vertexAt(cube.triangles[t][c]);
        next += cube.count;
    });
}

void Contour::extract(const BlockGrid& grid, const BlockArray<float>& values, float level, SurfaceMesh& mesh)
{
    SIM_CHECK(level > 0.0f);
    blocks_.resize(grid.count() + 1);
    blocks_.back() = {};
    parallelFor(grid.count(), [&](std::size_t b) { compare(values.block(static_cast<int>(b)), level, blocks_[b]); });
    parallelFor(grid.count(), [&](std::size_t b) { count(grid, static_cast<int>(b)); });
    const auto [vertices, triangles] = findOffsets();
    mesh.positions.resize(vertices);
    mesh.triangles.resize(triangles);
    mesh.normals.clear();
    mesh.velocities.clear();
    crossings_.resize(vertices);
    parallelFor(grid.count(), [&](std::size_t b) { placeVertices(grid, values, level, static_cast<int>(b), mesh); });
    parallelFor(grid.count(), [&](std::size_t b) { makeTriangles(grid, static_cast<int>(b), mesh); });
}

void findNormals(const BlockGrid& grid, const BlockArray<float>& values, const std::vector<Crossing>& crossings, std::vector<Vec3>& normals)
{
    normals.resize(crossings.size());
    parallelFor(crossings.size(), kGrain, [&](std::size_t v) {
        const Crossing& crossing = crossings[v];
        const auto slopeAt = [&](const Vec3i& node) {
            Vec3 slope;
            for (int a = 0; a < kAxes; ++a)
                slope[a] =
                    valueNear(grid, values, crossing.block, node + Vec3i::Unit(a)) - valueNear(grid, values, crossing.block, node - Vec3i::Unit(a));
            return slope;
        };
        const Vec3i node = crossing.cell();
        const Vec3 slope = (1.0 - crossing.along) * slopeAt(node) + crossing.along * slopeAt(node + Vec3i::Unit(crossing.axis));
        const double length = slope.norm();
        // Between two equal drops there is none; the edge tells at least which side is which.
        const bool fallsAlong =
            valueNear(grid, values, crossing.block, node) > valueNear(grid, values, crossing.block, node + Vec3i::Unit(crossing.axis));
        normals[v] = length > 0.0 ? Vec3(-slope / length) : Vec3((fallsAlong ? 1.0 : -1.0) * Vec3::Unit(crossing.axis));
    });
}

}  // namespace sim
