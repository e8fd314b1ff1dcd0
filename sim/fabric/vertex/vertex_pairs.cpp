#include "sim/core/parallel.h"
#include "sim/fabric/vertex/vertex_system.h"

#include <algorithm>
#include <cmath>

// What contact between parts of the fabric adds to the Newton system.

namespace sim {

namespace {

/// Places of a side of a pair among its four vertices.
struct Side {
    int begin, end;
};
Side sideOf(int firstSide, int which) { return which == 0 ? Side{0, firstSide} : Side{firstSide, 4}; }

}  // namespace

/// Places that pairs have in packs.
void VertexSystem::layOutPairs(const ActiveContacts* contacts)
{
    const std::size_t count = contacts ? contacts->size() : 0;
    edgePairs_ = 0;
    while (edgePairs_ < count && contacts->firstSide[edgePairs_] == 2) ++edgePairs_;
    pairs_.resize(count > 0 ? slotOfPair(count - 1) / kLanes + 1 : 0);
    pairForce_.resize(16 * count);
}

/// Packs of pairs of edges.
std::size_t VertexSystem::edgePacks() const { return (edgePairs_ + kLanes - 1) / kLanes; }

std::size_t VertexSystem::slotOfPair(std::size_t i) const { return i < edgePairs_ ? i : i - edgePairs_ + edgePacks() * kLanes; }

/// Whether S holds all of a side's own part, else only the diagonals of its vertices on strands.
bool VertexSystem::isInStrands(const ActiveContacts& contacts, std::size_t i, int which) const
{
    const Side side = sideOf(contacts.firstSide[i], which);
    const int first = contacts.vertices[i][side.begin], last = contacts.vertices[i][side.end - 1], size = side.end - side.begin;
    const int apart = std::abs(unknowns_.slot[first] - unknowns_.slot[last]);
    return unknowns_.isOnStrand(first) && unknowns_.isOnStrand(last) && (size == 1 || (size == 2 && apart == kNextVertex));
}

/// Each vertex's pairs, in the pairs' order, and what of them the packs have to know.
void VertexSystem::sortIncidence(const ActiveContacts* contacts)
{
    incidenceBegin_.assign(fabric_.vertexCount() + 1, 0);
    uncoupled_.clear();
    if (!contacts) return;
    for (const std::array<int, 4>& vertices : contacts->vertices)
        for (int v : vertices) ++incidenceBegin_[v + 1];
    for (std::size_t v = 0; v < fabric_.vertexCount(); ++v) incidenceBegin_[v + 1] += incidenceBegin_[v];
    incidence_.resize(4 * contacts->size());
    cursor_.assign(incidenceBegin_.begin(), incidenceBegin_.end() - 1);
    for (std::size_t i = 0; i < contacts->size(); ++i) {
        const std::size_t slot = slotOfPair(i);
        PairPack& pack = pairs_[slot / kLanes];
        if (slot % kLanes == 0) {
            pack = {};
            for (auto& lanes : pack.incidence) lanes.fill(PairPack::kNone);
        }
        const std::array<bool, 2> inStrands = {isInStrands(*contacts, i, 0), isInStrands(*contacts, i, 1)};
        for (int which = 0; which < 2; ++which) pack.isCoupled[which][slot % kLanes] = inStrands[which] ? 0.0f : 1.0f;
        for (int k = 0; k < 4; ++k) {
            const int v = contacts->vertices[i][k], place = cursor_[v]++;
            incidence_[place] = {static_cast<int>(i), k};
            pack.incidence[k][slot % kLanes] = place;
            if (!inStrands[k < contacts->firstSide[i] ? 0 : 1] && unknowns_.isOnStrand(v) && !fabric_.pinned[v])
                uncoupled_.push_back({v, RoundedPair(*contacts, i).block(k, k).matrix()});
        }
    }
}

/// What the solver reads of a pair, and its gradient in pairForce_.
void VertexSystem::copyPair(const ActiveContacts& c, std::size_t i)
{
    const std::size_t slot = slotOfPair(i), l = slot % kLanes;
    PairPack& pack = pairs_[slot / kLanes];
    pack.set(l, c, i);
    const std::array<Vec3, 4> gradient = c.forcesOnVertices(i, c.force[i]);
    for (int k = 0; k < 4; ++k) Eigen::Map<Vec3>(pairForce_.data() + 4 * static_cast<std::size_t>(pack.incidence[k][l])) = gradient[k];
}

/// What the solver reads of the pairs, and in pairForce_ their gradients.
void VertexSystem::copyPairs(const ActiveContacts* contacts)
{
    layOutPairs(contacts);
    sortIncidence(contacts);
    parallelFor(pairs_.size(), 128, [&](std::size_t n) {
        const bool isEdges = n < edgePacks();
        const std::size_t first = isEdges ? n * kLanes : edgePairs_ + (n - edgePacks()) * kLanes;
        const std::size_t end = std::min(first + kLanes, isEdges ? edgePairs_ : contacts->size());
        for (std::size_t i = first; i < end; ++i) copyPair(*contacts, i);
    });
}

/// Gradient, and what S or the preconditioner of the cloth takes of the matrix.
void VertexSystem::addContacts(const ActiveContacts& contacts)
{
    parallelFor(fabric_.vertexCount(), 256, [&](std::size_t v) {
        if (incidenceBegin_[v] == incidenceBegin_[v + 1]) return;
        const int slot = unknowns_.slot[v];
        HalfPack gradient{};
        Mat3Columns own, before;
        bool hasBefore = false;
        for (int n = incidenceBegin_[v]; n < incidenceBegin_[v + 1]; ++n) {
            const auto [i, place] = incidence_[n];
            gradient += *reinterpret_cast<const HalfPack*>(pairForce_.data() + 4 * static_cast<std::size_t>(n));
            const RoundedPair pair(contacts, i);
            own += pair.block(place, place);
            const int which = place < contacts.firstSide[i] ? 0 : 1;
            const Side side = sideOf(contacts.firstSide[i], which);
            const int other = side.begin + side.end - 1 - place;
            if (side.end - side.begin != 2 || unknowns_.slot[contacts.vertices[i][other]] != slot - kNextVertex) continue;
            if (!isInStrands(contacts, i, which)) continue;
            before += pair.block(place, other);
            hasBefore = true;
        }
        for (int a = 0; a < 3; ++a) gradient_[slot + a * kLanes] += gradient[a];
        addToDiagonal(static_cast<int>(v), own.matrix());
        if (!hasBefore) return;
        const int row = unknowns_.row(static_cast<int>(v)), lane = unknowns_.lane(static_cast<int>(v));
        for (int a = 0; a < 3; ++a)
            for (int b = 0; b < 3; ++b) strands_.at(row + a, 4 + a - b, lane) += before.column[b][a];
    });
}

}  // namespace sim
