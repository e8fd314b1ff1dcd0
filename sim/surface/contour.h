#pragma once

#include "sim/grid/block_grid.h"
#include "sim/surface/surface_mesh.h"

#include <array>
#include <cstdint>
#include <vector>

namespace sim {

/// Where a surface cuts an edge of a grid: the place of one vertex.
struct Crossing {
    int block;
    std::uint16_t node;  ///< lower end of the edge, in the block
    std::uint16_t axis;  ///< axis that the edge runs along
    float along;         ///< distance from the lower end, 0 < along < 1 [cells]

    Vec3i cell() const { return {node & 7, node >> 3 & 7, node >> 6}; }
    /// Relative to the lower corner of the block [cells].
    Eigen::Vector3f place() const { return cell().cast<float>() + along * Eigen::Vector3f::Unit(axis); }
};

/// Marching cubes on the blocks of a sparse grid: the closed surface where a field on the nodes equals a level, with
/// one vertex on each edge of the grid that it cuts. Beside comparing every node with the level, work goes with the
/// surface. The same bits for any number of threads.
class Contour {
 public:
    /// The surface about the nodes whose value is above `level` > 0: positions and triangles of the mesh; it has no
    /// normals or velocities. Values are 0 outside of the blocks, and every node above the level must have all of its
    /// 26 neighbours in blocks.
    void extract(const BlockGrid& grid, const BlockArray<float>& values, float level, SurfaceMesh& mesh);

    /// One per vertex of the mesh extracted last.
    const std::vector<Crossing>& crossings() const { return crossings_; }

 private:
    static constexpr int kRows = kBlockEdge * kBlockEdge;

    /// Rows k * 8 + j along x, with one bit per node.
    using Rows = std::array<std::uint8_t, kRows>;
    struct Block {
        Rows inside;
        std::array<Rows, kAxes> cut;                ///< edges that begin at these nodes hold a vertex
        std::array<std::uint16_t, kRows> rowStart;  ///< vertices of the block before those of a row
        int vertices, triangles;                    ///< numbers of vertices and triangles in the block
        int firstVertex, firstTriangle;             ///< first vertex and triangle among those of all blocks
    };

    void compare(const float* values, float level, Block& block) const;
    unsigned insideRow(const BlockGrid& grid, int block, int j, int k) const;
    void count(const BlockGrid& grid, int block);
    std::array<int, 2> findOffsets();
    int vertexOn(const BlockGrid& grid, int block, int axis, const Vec3i& node) const;
    void placeVertices(const BlockGrid& grid, const BlockArray<float>& values, float level, int block, SurfaceMesh& mesh);
    void makeTriangles(const BlockGrid& grid, int block, SurfaceMesh& mesh) const;
    template <class Visit>
    void forEachCutCell(const BlockGrid& grid, int block, Visit&& visit) const;

    std::vector<Block> blocks_;  ///< blocks, and one of air behind them for all that do not exist
    std::vector<Crossing> crossings_;
};

/// Unit vectors down the gradient of the values at the crossings, by central differences at both ends of their edges.
void findNormals(const BlockGrid& grid, const BlockArray<float>& values, const std::vector<Crossing>& crossings, std::vector<Vec3>& normals);

}  // namespace sim
