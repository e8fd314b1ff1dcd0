#include "sim/fabric/groups.h"

#include <algorithm>
#include <numeric>

namespace sim {

FabricGroups::FabricGroups(const Fabric& fabric)
{
    root_.resize(fabric.vertexCount());
    isHeld_.assign(root_.size(), 0);
    std::iota(root_.begin(), root_.end(), 0);
    for (const Vec2i& e : fabric.edges.vertices) join(e[0], e[1]);
    for (const Vec3i& f : fabric.faces.vertices) join(f[0], f[1]), join(f[0], f[2]);
    std::vector<int> number(root_.size(), -1);
    int count = 0;
    pieceOf_.resize(root_.size());
    for (int v = 0; v < static_cast<int>(root_.size()); ++v) {
        int& piece = number[rootOf(v)];
        if (piece < 0) piece = count++;
        pieceOf_[v] = piece;
    }
    isPinned_.assign(count, 0);
    for (std::size_t v = 0; v < pieceOf_.size(); ++v)
        if (fabric.pinned[v]) isPinned_[pieceOf_[v]] = 1;
    root_.resize(count);
    begin();
}

void FabricGroups::begin()
{
    std::iota(root_.begin(), root_.end(), 0);
    isHeld_ = isPinned_;
}

int FabricGroups::rootOf(int piece) const
{
    while (root_[piece] != piece) piece = root_[piece] = root_[root_[piece]];
    return piece;
}

/// The lower number stands for both, so that the order of joins does not matter.
void FabricGroups::join(int first, int second)
{
    first = rootOf(first), second = rootOf(second);
    if (first == second) return;
    if (second < first) std::swap(first, second);
    root_[second] = first;
    isHeld_[first] = isHeld_[first] != 0 || isHeld_[second] != 0;
}

void FabricGroups::joinVertices(std::span<const int> vertices)
{
    for (int v : vertices) join(pieceOf_[vertices[0]], pieceOf_[v]);
}

void FabricGroups::holdAll() { std::ranges::fill(isHeld_, 1); }

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
        const int group = freeGroupOf(pieceOf_[v]);
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
