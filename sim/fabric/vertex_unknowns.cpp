#include "sim/fabric/vertex_unknowns.h"

namespace sim {

VertexUnknowns::VertexUnknowns(const Fabric& fabric, const StrandLayout& layout, const Shells& shells)
{
    slot.assign(fabric.vertexCount(), -1);
    twistSlot.assign(fabric.edges.size(), -1);
    std::vector<int> owner(fabric.vertexCount(), -1);
    for (std::size_t g = 0; g < layout.groups.size(); ++g) {
        const StrandLayout::Group& group = layout.groups[g];
        for (int j = 0; j < group.vertices; ++j)
            for (int l = 0; l < kLanes; ++l) {
                const int v = layout.vertex[group.firstVertex + j][l], at = (group.firstRow + 4 * j) * kLanes + l;
                if (v >= 0 && layout.strand[g][l] > owner[v]) {
                    owner[v] = layout.strand[g][l];
                    slot[v] = at;
                }
                const int e = j < group.edges() ? layout.edge[group.firstEdge + j][l] : -1;
                if (e >= 0) twistSlot[e] = at + 3 * kLanes;
            }
    }
    strandSize = layout.rows * kLanes;
    int count = 0;
    for (int v : shells.vertices())
        if (slot[v] < 0) {
            slot[v] = strandSize + (count / kLanes) * 3 * kLanes + count % kLanes;
            ++count;
        }
    size = strandSize + (count + kLanes - 1) / kLanes * 3 * kLanes;
}

}  // namespace sim
