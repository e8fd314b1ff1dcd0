#include "sim/core/parallel.h"
#include "sim/fabric/vertex/vertex_system.h"

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

/// B of a vertex but for its weight.
Mat3Columns VertexSystem::PairBlock::turnJacobian(int k) const
{
    Mat3Columns sum;
    const auto ends = directionsOfPair(firstSide);
    for (int d = 0; d < 2; ++d) {
        if (ends[d][0] == k) sum += Mat3Columns(lever[d]);
        if (ends[d][1] == k) sum -= Mat3Columns(lever[d]);
    }
    return sum;
}

VertexSystem::PairBlock::Blocks VertexSystem::PairBlock::blocks(int k, int other) const
{
    const double weight = weights[k], otherWeight = weights[other];
    const HalfPack n{normal[0], normal[1], normal[2], 0.0};
    Blocks blocks;
    for (int a = 0; a < 3; ++a) {
        HalfPack pressed = (stiffness * n[a]) * n;
        pressed[a] += across;
        blocks.own.column[a] = (weight * weight) * pressed;
        blocks.withOther.column[a] = (weight * otherWeight) * pressed;
    }
    if (!hasLever) return blocks;
    const Mat3Columns turn = turnJacobian(k), transpose = turn.transposed();
    for (int a = 0; a < 3; ++a) {
        const HalfPack both = transpose * turn.column[a];
        blocks.own.column[a] += across * (weight * (turn.column[a] + transpose.column[a]) + both);
        blocks.withOther.column[a] += across * (otherWeight * transpose.column[a] - weight * turn.column[a] - both);
    }
    return blocks;
}

/// Each vertex's pairs, in the pairs' order.
void VertexSystem::sortIncidence()
{
    incidenceBegin_.assign(fabric_.vertexCount() + 1, 0);
    for (const PairBlock& pair : pairs_)
        for (int v : pair.vertices) ++incidenceBegin_[v + 1];
    for (std::size_t v = 0; v < fabric_.vertexCount(); ++v) incidenceBegin_[v + 1] += incidenceBegin_[v];
    incidence_.resize(4 * pairs_.size());
    cursor_.assign(incidenceBegin_.begin(), incidenceBegin_.end() - 1);
    uncoupled_.clear();
    for (int n = 0; n < static_cast<int>(pairs_.size()); ++n) {
        const PairBlock& pair = pairs_[n];
        for (int k = 0; k < 4; ++k) {
            const int v = pair.vertices[k], side = k < pair.firstSide ? 0 : 1;
            incidence_[cursor_[v]++] = {n, k};
            if (!pair.inStrands[side] && unknowns_.isOnStrand(v) && !fabric_.pinned[v]) uncoupled_.push_back({v, n, k});
        }
    }
}

void VertexSystem::copyLever(const ActiveContacts::Lever& lever, PairBlock& pair)
{
    for (int d = 0; d < 2; ++d)
        for (int a = 0; a < 3; ++a)
            for (int b = 0; b < 3; ++b) pair.lever[d][a][b] = static_cast<float>(lever[d](b, a));
}

/// What the solver reads of the pairs, and in pairForce_ their gradients.
void VertexSystem::copyPairs(const ActiveContacts* contacts)
{
    pairs_.resize(contacts ? contacts->size() : 0);
    pairForce_.resize(16 * pairs_.size());
    parallelFor(pairs_.size(), 1024, [&](std::size_t n) {
        const ActiveContacts& c = *contacts;
        const Vec3& normal = c.normal[n];
        PairBlock& pair = pairs_[n];
        pair = {{normal.x(), normal.y(), normal.z(), 0.0},
                c.weights[n],
                c.vertices[n],
                c.stiffness[n] - c.frictionStiffness[n],
                c.frictionStiffness[n],
                c.firstSide[n],
                {},
                c.frictionStiffness[n] > 0.0,
                {}};
        if (pair.hasLever) copyLever(c.lever[n], pair);
        const std::array<Vec3, 4> gradient = c.forcesOnVertices(n, c.force[n]);
        for (int k = 0; k < 4; ++k) Eigen::Map<Vec3>(pairForce_.data() + 4 * (4 * n + k)) = gradient[k];
        for (int which = 0; which < 2; ++which) {
            const Side side = sideOf(pair.firstSide, which);
            const int first = pair.vertices[side.begin], last = pair.vertices[side.end - 1];
            const int apart = std::abs(unknowns_.slot[first] - unknowns_.slot[last]), size = side.end - side.begin;
            pair.inStrands[which] = unknowns_.isOnStrand(first) && unknowns_.isOnStrand(last) && (size == 1 || (size == 2 && apart == kNextVertex));
        }
    });
}

/// Gradient, and what S or the preconditioner of the cloth takes of the matrix.
void VertexSystem::addContacts()
{
    sortIncidence();
    parallelFor(fabric_.vertexCount(), 256, [&](std::size_t v) {
        if (incidenceBegin_[v] == incidenceBegin_[v + 1]) return;
        const int slot = unknowns_.slot[v];
        Vec3 gradient = Vec3::Zero();
        Mat3Columns own, before;
        bool hasBefore = false;
        for (int i = incidenceBegin_[v]; i < incidenceBegin_[v + 1]; ++i) {
            const auto [number, place] = incidence_[i];
            const PairBlock& pair = pairs_[number];
            gradient += Eigen::Map<const Vec3>(pairForce_.data() + 4 * (4 * static_cast<std::size_t>(number) + place));
            const Side side = sideOf(pair.firstSide, place < pair.firstSide ? 0 : 1);
            const int other = side.begin + side.end - 1 - place;
            const PairBlock::Blocks blocks = pair.blocks(place, side.end - side.begin == 2 ? other : place);
            own += blocks.own;
            if (side.end - side.begin != 2 || !pair.inStrands[side.begin == 0 ? 0 : 1]) continue;
            if (unknowns_.slot[pair.vertices[other]] != slot - kNextVertex) continue;
            before += blocks.withOther;
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
