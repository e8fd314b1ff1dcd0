#include "sim/fabric/components.h"

#include <algorithm>
#include <numeric>

namespace sim {

namespace {

int rootIn(std::vector<int>& parent, int n)
{
    while (parent[n] != n) n = parent[n] = parent[parent[n]];
    return n;
}

/// Makes the lower of two roots the other's parent.
void join(std::vector<int>& parent, int a, int b) { parent[std::max(a, b)] = std::min(a, b); }

/// Numbers from 0 for what has the same root; returns how many there are. A root is the lowest of its own.
int numberRoots(const std::vector<int>& parent, std::vector<int>& number)
{
    int count = 0;
    number.resize(parent.size());
    for (std::size_t n = 0; n < parent.size(); ++n) number[n] = parent[n] == static_cast<int>(n) ? count++ : number[parent[n]];
    return count;
}

}  // namespace

FabricComponents::FabricComponents(const Fabric& fabric)
{
    std::vector<int> parent(fabric.vertexCount());
    std::iota(parent.begin(), parent.end(), 0);
    const auto joinVertices = [&](int a, int b) { join(parent, rootIn(parent, a), rootIn(parent, b)); };
    for (const auto& edge : fabric.edges.vertices) joinVertices(edge[0], edge[1]);
    for (const Vec3i& face : fabric.faces.vertices)
        for (int k = 1; k < 3; ++k) joinVertices(face[0], face[k]);
    pieces_ = numberRoots(parent, piece_);
    untie();
    number();
}

int FabricComponents::rootOf(int piece) const { return rootIn(parent_, piece); }

void FabricComponents::untie()
{
    parent_.resize(pieces_);
    std::iota(parent_.begin(), parent_.end(), 0);
}

void FabricComponents::tiePieces(int first, int second) { join(parent_, rootOf(first), rootOf(second)); }

void FabricComponents::number() { count_ = numberRoots(parent_, component_); }

}  // namespace sim
