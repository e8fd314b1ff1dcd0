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

/// k n nᵀ + across · 1 of a pair.
Mat3 blockOf(const std::array<double, 4>& normal, double stiffness, double across)
{
    const Vec3 n(normal[0], normal[1], normal[2]);
    return stiffness * n * n.transpose() + across * Mat3::Identity();
}

}  // namespace

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
            incidence_[cursor_[v]++] = {2 * n + side, k, pair.weights[k]};
            if (!pair.inStrands[side] && unknowns_.isOnStrand(v) && !fabric_.pinned[v]) uncoupled_.push_back({v, n, pair.weights[k]});
        }
    }
}

/// What the solver reads of the pairs.
void VertexSystem::copyPairs(const ActiveContacts* contacts)
{
    pairs_.resize(contacts ? contacts->size() : 0);
    pairForce_.resize(8 * pairs_.size());
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
                {}};
        for (int which = 0; which < 2; ++which) {
            const Side side = sideOf(pair.firstSide, which);
            const int first = pair.vertices[side.begin], last = pair.vertices[side.end - 1];
            const int apart = std::abs(unknowns_.slot[first] - unknowns_.slot[last]), size = side.end - side.begin;
            pair.inStrands[which] = unknowns_.isOnStrand(first) && unknowns_.isOnStrand(last) && (size == 1 || (size == 2 && apart == kNextVertex));
        }
    });
}

/// Gradient, and what S or the preconditioner of the cloth takes of the matrix.
void VertexSystem::addContacts(const ActiveContacts& c)
{
    sortIncidence();
    parallelFor(fabric_.vertexCount(), 256, [&](std::size_t v) {
        if (incidenceBegin_[v] == incidenceBegin_[v + 1]) return;
        const int slot = unknowns_.slot[v];
        Vec3 gradient = Vec3::Zero();
        Mat3 own = Mat3::Zero(), before = Mat3::Zero();
        bool hasBefore = false;
        for (int i = incidenceBegin_[v]; i < incidenceBegin_[v + 1]; ++i) {
            const auto [pairSide, place, weight] = incidence_[i];
            const PairBlock& pair = pairs_[pairSide / 2];
            gradient += weight * c.force[pairSide / 2];
            const Mat3 block = blockOf(pair.normal, pair.stiffness, pair.across);
            own += weight * weight * block;
            if (!pair.inStrands[pairSide % 2]) continue;
            const Side side = sideOf(pair.firstSide, pairSide % 2);
            for (int other = side.begin; other < side.end; ++other)
                if (unknowns_.slot[pair.vertices[other]] == slot - kNextVertex) {
                    before += weight * pair.weights[other] * block;
                    hasBefore = true;
                }
        }
        for (int a = 0; a < 3; ++a) gradient_[slot + a * kLanes] += gradient[a];
        addToDiagonal(static_cast<int>(v), own);
        if (!hasBefore) return;
        const int row = unknowns_.row(static_cast<int>(v)), lane = unknowns_.lane(static_cast<int>(v));
        for (int a = 0; a < 3; ++a)
            for (int b = 0; b < 3; ++b) strands_.at(row + a, 4 + a - b, lane) += before(a, b);
    });
}

}  // namespace sim
