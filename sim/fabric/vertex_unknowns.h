#pragma once

#include "sim/fabric/rods/strand_matrix.h"
#include "sim/fabric/shells/shells.h"

#include <vector>

namespace sim {

/// Where the unknowns of the fabric stand in a vector: first the rows of all strands (StrandLayout), positions and twist angles, then
/// the vertices that are on cloth only, kLanes at a time. A vertex on several strands belongs to the last of them; in the others its
/// rows are empty.
struct VertexUnknowns {
    VertexUnknowns() = default;
    VertexUnknowns(const Fabric& fabric, const StrandLayout& layout, const Shells& shells);

    bool isOnStrand(int vertex) const { return slot[vertex] < strandSize; }
    int row(int vertex) const { return slot[vertex] / kLanes; }  ///< row of a vertex on a strand, in its StrandMatrix
    int lane(int vertex) const { return slot[vertex] % kLanes; }

    std::vector<int> slot;       ///< slot of each vertex' x; y and z stand kLanes and 2 kLanes further
    std::vector<int> twistSlot;  ///< slot of each yarn edge's twist
    int strandSize = 0;          ///< numbers that belong to strands
    int size = 0;                ///< size of a vector of unknowns
};

}  // namespace sim
