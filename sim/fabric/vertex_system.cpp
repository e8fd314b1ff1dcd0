#include "sim/fabric/vertex_system.h"

#include "sim/core/parallel.h"

#include <algorithm>
#include <cmath>

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

VertexSystem::VertexSystem(const Fabric& fabric, const FabricSettings& settings)
    : fabric_(fabric), rods_(fabric, restState(fabric), settings), shells_(fabric, settings), unknowns_(fabric, rods_.layout(), shells_),
      cloth_(shells_.matrix())
{
    strands_.resize(rods_.layout());
    ownsDiagonal_.resize(shells_.vertices().size());
    for (std::size_t row = 0; row < ownsDiagonal_.size(); ++row) ownsDiagonal_[row] = unknowns_.isOnStrand(shells_.vertices()[row]);
    if (!shells_.empty()) clothFactor_ = ClothPreconditioner(cloth_, shells_.neighbors(), ownsDiagonal_);
    for (AlignedArray<double>* v : {&gradient_, &solution_, &residual_, &z_, &p_, &sp_, &q_}) v->resize(unknowns_.size);
    pOfVertex_.resize(4 * fabric.vertexCount());
    partialDot_.resize(rods_.layout().groups.size());
    findLinks();
    clothExtra_.resize(shells_.vertices().size());
    clothIn_.resize(3 * shells_.vertices().size());
    clothOut_.resize(3 * shells_.vertices().size());
    clothRow_.assign(fabric.vertexCount(), -1);
    for (std::size_t row = 0; row < shells_.vertices().size(); ++row) clothRow_[shells_.vertices()[row]] = static_cast<int>(row);
}

/// Vertices of strands that another strand owns.
void VertexSystem::findLinks()
{
    const StrandLayout& layout = rods_.layout();
    for (const StrandLayout::Group& group : layout.groups)
        for (int j = 0; j < group.vertices; ++j)
            for (int l = 0; l < kLanes; ++l) {
                const int v = layout.vertex[group.firstVertex + j][l], row = group.firstRow + 4 * j;
                if (v < 0 || unknowns_.slot[v] == row * kLanes + l) continue;
                Link link{v, row, l, {}, {}};
                // The 8 unknowns before and the 8 after: two vertices and two angles on either side.
                for (int n = 0; n < 16; ++n) {
                    const int local = 4 * j + (n < 8 ? n - 8 : n - 5), other = local / 4;
                    link.slot[n] = -1;
                    if (local < 0 || local >= group.rows()) continue;
                    const int w = layout.vertex[group.firstVertex + other][l];
                    const bool isAngle = local % 4 == 3;
                    const int e = isAngle && other < group.edges() ? layout.edge[group.firstEdge + other][l] : -1;
                    if (isAngle) link.slot[n] = e >= 0 ? unknowns_.twistSlot[e] : -1;
                    else if (w >= 0) link.slot[n] = unknowns_.slot[w] + (local % 4) * kLanes;
                }
                links_.push_back(link);
            }
}

void VertexSystem::assemble(const NewtonPoint& at, std::span<const ObstacleContact> obstacles, const ActiveContacts* contacts)
{
    copyPairs(contacts);
    gradient_.fill(0.0);
    if (!rods_.empty()) rods_.forces(at.state, at.h, reinterpret_cast<Pack*>(gradient_.data()), &strands_);
    if (!shells_.empty()) {
        cloth_.clear();
        for (Mat3& m : clothExtra_) m.setZero();
    }
    addInertia(at);
    if (!shells_.empty()) {
        shells_.forces(at.state.x, at.h, unknowns_.slot, gradient_.data(), &cloth_);
        for (std::size_t row = 0; row < ownsDiagonal_.size(); ++row)
            if (ownsDiagonal_[row]) {
                const double* block = cloth_.block(cloth_.diagonal(static_cast<int>(row)));
                addToDiagonal(shells_.vertices()[row], Eigen::Map<const Mat3>(block));
            }
    }
    addObstacles(obstacles);
    if (!pairs_.empty()) addContacts(*contacts);
    holdPins();
}

/// M/h² (x − free) and its diagonal; rows of shared vertices go to their owners first, unused rows become 1.
void VertexSystem::addInertia(const NewtonPoint& at)
{
    const double perStep2 = 1.0 / (at.h * at.h);
    emptySharedRows();
    const StrandLayout& layout = rods_.layout();
    parallelFor(layout.groups.size(), [&](std::size_t g) {
        const StrandLayout::Group& group = layout.groups[g];
        for (int j = 0; j < group.vertices; ++j)
            for (int l = 0; l < kLanes; ++l) {
                const int v = layout.vertex[group.firstVertex + j][l], row = group.firstRow + 4 * j, slot = row * kLanes + l;
                const bool isOwner = v >= 0 && unknowns_.slot[v] == slot;
                for (int a = 0; a < 3; ++a) {
                    strands_.at(row + a, 0, l) += isOwner ? at.mass[v] * perStep2 : 1.0;
                    if (isOwner) gradient_[slot + a * kLanes] += at.mass[v] * perStep2 * (at.state.x[v][a] - at.freePositions[v][a]);
                }
                if (j == group.edges()) continue;
                const int e = layout.edge[group.firstEdge + j][l];
                const double inertia = rods_.twistInertia()[group.firstEdge + j][l] * perStep2;
                strands_.at(row + 3, 0, l) += inertia;
                if (e >= 0) gradient_[slot + 3 * kLanes] += inertia * (at.state.theta[e] - at.freeAngles[e]);
            }
    });
    parallelFor(shells_.vertices().size(), 256, [&](std::size_t row) {
        if (ownsDiagonal_[row]) return;
        const int v = shells_.vertices()[row], slot = unknowns_.slot[v];
        double* block = cloth_.block(cloth_.diagonal(static_cast<int>(row)));
        for (int a = 0; a < 3; ++a) {
            block[4 * a] += at.mass[v] * perStep2;
            gradient_[slot + a * kLanes] += at.mass[v] * perStep2 * (at.state.x[v][a] - at.freePositions[v][a]);
        }
    });
    totalMass_ = parallelSum(at.mass.size(), [&](std::size_t v) { return fabric_.pinned[v] ? 0.0 : at.mass[v]; });
}

void VertexSystem::emptySharedRows()
{
    for (Link& link : links_) {
        const int owner = unknowns_.slot[link.vertex];
        for (int a = 0; a < 3; ++a) {
            double& from = gradient_[(link.strandRow + a) * kLanes + link.lane];
            gradient_[owner + a * kLanes] += from;
            from = 0.0;
            for (int b = 0; b <= a; ++b) {
                double& entry = strands_.at(link.strandRow + a, a - b, link.lane);
                strands_.at(owner / kLanes + a, a - b, owner % kLanes) += entry;
                entry = 0.0;
            }
            for (int n = 0; n < 16; ++n) {
                const int own = link.strandRow + a, other = link.strandRow + (n < 8 ? n - 8 : n - 5);
                link.coupling[a][n] = 0.0;
                if (link.slot[n] < 0) continue;
                const int distance = std::abs(own - other);
                if (distance >= StrandMatrix::kBand) continue;
                double& entry = strands_.at(std::max(own, other), distance, link.lane);
                std::swap(link.coupling[a][n], entry);
            }
        }
    }
}

void VertexSystem::addToDiagonal(int vertex, const Mat3& block)
{
    if (!unknowns_.isOnStrand(vertex)) {
        clothExtra_[clothRow_[vertex]] += block;
        return;
    }
    const int row = unknowns_.row(vertex), lane = unknowns_.lane(vertex);
    for (int a = 0; a < 3; ++a)
        for (int b = 0; b <= a; ++b) strands_.at(row + a, a - b, lane) += block(a, b);
}

void VertexSystem::addObstacles(std::span<const ObstacleContact> obstacles)
{
    for (const ObstacleContact& contact : obstacles) {
        const int slot = unknowns_.slot[contact.vertex];
        for (int a = 0; a < 3; ++a) gradient_[slot + a * kLanes] += contact.gradient[a];
        if (unknowns_.isOnStrand(contact.vertex)) {
            addToDiagonal(contact.vertex, contact.stiffness);
            continue;
        }
        double* block = cloth_.block(cloth_.diagonal(clothRow_[contact.vertex]));
        for (int e = 0; e < 9; ++e) block[e] += contact.stiffness(e / 3, e % 3);
    }
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
    loose_.clear();
    for (int n = 0; n < static_cast<int>(pairs_.size()); ++n) {
        const PairBlock& pair = pairs_[n];
        for (int k = 0; k < 4; ++k) {
            const int v = pair.vertices[k], side = k < pair.firstSide ? 0 : 1;
            incidence_[cursor_[v]++] = {2 * n + side, k, pair.weights[k]};
            if (!pair.inStrands[side] && unknowns_.isOnStrand(v) && !fabric_.pinned[v]) loose_.push_back({v, n, pair.weights[k]});
        }
    }
}

/// What the solver reads of the pairs.
void VertexSystem::copyPairs(const ActiveContacts* contacts)
{
    constexpr int kNextVertex = 4 * kLanes;  // how far the next vertex of a strand is in a vector
    pairs_.resize(contacts ? contacts->size() : 0);
    pairForce_.resize(8 * pairs_.size());
    parallelFor(pairs_.size(), 1024, [&](std::size_t n) {
        const ActiveContacts& c = *contacts;
        const Vec3& normal = c.normal[n];
        PairBlock& pair = pairs_[n];
        pair = {{normal.x(), normal.y(), normal.z(), 0.0}, c.weights[n], c.vertices[n], c.stiffness[n] - c.frictionStiffness[n],
                c.frictionStiffness[n], c.firstSide[n], {}};
        for (int which = 0; which < 2; ++which) {
            const Side side = sideOf(pair.firstSide, which);
            const int first = pair.vertices[side.begin], last = pair.vertices[side.end - 1];
            const int apart = std::abs(unknowns_.slot[first] - unknowns_.slot[last]), size = side.end - side.begin;
            pair.inStrands[which] =
                unknowns_.isOnStrand(first) && unknowns_.isOnStrand(last) && (size == 1 || (size == 2 && apart == kNextVertex));
        }
    });
}

/// Gradient, and what S or the preconditioner of the cloth takes of the matrix.
void VertexSystem::addContacts(const ActiveContacts& c)
{
    constexpr int kNextVertex = 4 * kLanes;
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

/// Rows and columns of what is held become those of the identity; the gradient there 0.
void VertexSystem::holdPins()
{
    const StrandLayout& layout = rods_.layout();
    heldSlots_.clear();
    for (int v : fabric_.pins.vertex)
        for (int a = 0; a < 3; ++a) heldSlots_.push_back(unknowns_.slot[v] + a * kLanes);
    for (std::size_t e = 0; e < fabric_.edges.size(); ++e)
        if (fabric_.edges.twistHeld[e]) heldSlots_.push_back(unknowns_.twistSlot[e]);
    for (int slot : heldSlots_) {
        gradient_[slot] = 0.0;
        if (slot >= unknowns_.strandSize) continue;
        const int row = slot / kLanes, lane = slot % kLanes;
        const auto group = std::ranges::upper_bound(layout.groups, row, {}, &StrandLayout::Group::firstRow) - 1;
        for (int k = 1; k < StrandMatrix::kBand; ++k) {
            if (row - k >= group->firstRow) strands_.at(row, k, lane) = 0.0;
            if (row + k < group->firstRow + group->rows()) strands_.at(row + k, k, lane) = 0.0;
        }
        strands_.at(row, 0, lane) = 1.0;
    }
}

void VertexSystem::factor()
{
    if (!rods_.empty()) strands_.factor(rods_.layout());
    if (!shells_.empty()) clothFactor_.factor(cloth_, clothExtra_);
}

Vec3 VertexSystem::move(int vertex) const
{
    const int slot = unknowns_.slot[vertex];
    return {solution_[slot], solution_[slot + kLanes], solution_[slot + 2 * kLanes]};
}

}  // namespace sim
