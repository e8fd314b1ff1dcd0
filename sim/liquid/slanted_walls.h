#pragma once

#include "sim/liquid/colored_blocks.h"
#include "sim/liquid/liquid_grid.h"

#include <array>
#include <cstdint>
#include <vector>

namespace sim {

/// Faces at walls that go slanted through the grid carry the mass of what is open of them (liquid/README.md, Walls).
///
/// P2G brings to a face what its B-spline has outside of the wall, its room, which fades over three cells; what is open of it fades over one. Along a
/// line of faces across the wall both have the same sum. So each face with more than its open part passes the rest on to the next one away from the
/// wall, and particles read it with the velocity of that: u ← (1 − s) u + s u_next. Masses and momenta go by the transpose, so that no energy comes
/// of it, as in WallFaces.
class SlantedWalls {
 public:
    /// Nothing is passed until the next pass().
    void begin(const ColoredBlocks& near);
    /// After begin(): pass on mass, momentum, room and weightless mass [g] of the faces `known`, which are open and have mass. Rooms are those that
    /// are folded.
    void pass(const CutGrid& cut, const ColoredBlocks& near, const BlockBits<3>& known, ObstacleField& field, FaceFields& faces,
              BlockArray<double, 3>& weightless);
    /// Give the faces the velocities that particles read [cm/s].
    void read(const BlockGrid& grid, const ColoredBlocks& near, BlockArray<double, 3>& velocity) const;

 private:
    /// Faces of one colour of a chequerboard take turns; so often, what comes from three cells behind gets to the last open part.
    static constexpr int kSweeps = 4;
    /// A face, and for the two sweeps that it takes part in the direction of the neighbour that it passes to, and its share s.
    struct Passing {
        std::uint16_t face;
        std::uint8_t axis, way;  ///< axis of the way
        std::int8_t outward;     ///< direction along it away from the wall, 1 or -1
        std::array<std::int8_t, kSweeps / 2> toward;
        std::array<double, kSweeps / 2> share;

        int parity() const { return (face ^ face >> 3 ^ face >> 6) & 1; }
        CellRef beside(const BlockGrid& grid, int block, int step) const;
    };
    static bool isMoved(const ObstacleField& field, int block, int cell);
    static bool findWay(const CutGrid& cut, int block, Passing& passing);
    double choose(const CutGrid& cut, int block, const BlockBits<3>& known, Passing& passing, int turn) const;
    void find(const CutGrid& cut, const ColoredBlocks& near, const BlockBits<3>& known);

    std::vector<std::vector<Passing>> passing_;  ///< of each block near a solid
};

}  // namespace sim
