#include "sim/fabric/groups.h"

#include <algorithm>

namespace sim {

FabricGroups::FabricGroups(const Fabric& fabric) : components_(fabric)
{
    isPinned_.assign(pieces(), 0);
    for (std::size_t v = 0; v < fabric.vertexCount(); ++v)
        if (fabric.pinned[v]) isPinned_[pieceOf(static_cast<int>(v))] = 1;
    begin();
}

void FabricGroups::begin()
{
    components_.untie();
    isHeld_ = isPinned_;
}

void FabricGroups::join(int first, int second)
{
    const bool isHeld = freeGroupOf(first) < 0 || freeGroupOf(second) < 0;
    components_.tiePieces(first, second);
    isHeld_[components_.rootOf(first)] = isHeld;
}

void FabricGroups::joinVertices(std::span<const int> vertices)
{
    for (int v : vertices) join(pieceOf(vertices[0]), pieceOf(v));
}

bool FabricGroups::anyFree() const
{
    for (int piece = 0; piece < pieces(); ++piece)
        if (freeGroupOf(piece) >= 0) return true;
    return false;
}

std::vector<Vec3> FabricGroups::drifts(std::span<const double> mass, std::span<const Vec3> velocity) const
{
    std::vector<Vec3> drift(pieces(), Vec3::Zero());
    if (!anyFree()) return drift;
    std::vector<double> massOf(drift.size(), 0.0);
    for (std::size_t v = 0; v < velocity.size(); ++v) {
        const int group = freeGroupOf(pieceOf(static_cast<int>(v)));
        if (group < 0) continue;
        drift[group] += mass[v] * velocity[v];
        massOf[group] += mass[v];
    }
    for (int piece = 0; piece < pieces(); ++piece) {
        const int group = freeGroupOf(piece);
        if (group == piece) drift[piece] /= massOf[piece];
        else if (group >= 0) drift[piece] = drift[group];  // lower, and so known
    }
    return drift;
}

}  // namespace sim
