#include "sim/fabric/vertex/vertex_system.h"

#include "sim/core/parallel.h"

#include <algorithm>
#include <cmath>

namespace sim {

VertexSystem::VertexSystem(const Fabric& fabric, const FabricSettings& settings)
    : fabric_(fabric),
      rods_(fabric, restState(fabric), settings),
      shells_(fabric, settings),
      unknowns_(fabric, rods_.layout(), shells_),
      cloth_(shells_.matrix()),
      components_(fabric)
{
    strands_.resize(rods_.layout());
    ownsDiagonal_.resize(shells_.vertices().size());
    for (std::size_t row = 0; row < ownsDiagonal_.size(); ++row) ownsDiagonal_[row] = unknowns_.isOnStrand(shells_.vertices()[row]);
    if (!shells_.empty()) clothFactor_ = ClothPreconditioner(cloth_, shells_.neighbors(), ownsDiagonal_);
    for (AlignedArray<double>* v : {&gradient_, &solution_, &residual_, &z_, &p_, &sp_, &q_}) v->resize(unknowns_.size);
    pOfVertex_.resize(4 * fabric.vertexCount());
    layOutPieces();
    findLinks();
    findFreePieces();
    clothExtra_.resize(shells_.vertices().size());
    clothIn_.resize(4 * shells_.vertices().size());
    clothOut_.resize(4 * shells_.vertices().size());
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
    rods_.includeTwistHessian();
    assembleFactored(at, obstacles, contacts);
}

void VertexSystem::assembleDefinite(const NewtonPoint& at, std::span<const ObstacleContact> obstacles, const ActiveContacts* contacts)
{
    rods_.excludeTwistHessian(lanesNotIndefinite());
    assembleFactored(at, obstacles, contacts);
}

void VertexSystem::assembleFactored(const NewtonPoint& at, std::span<const ObstacleContact> obstacles, const ActiveContacts* contacts)
{
    assembleSums(at, obstacles, contacts);
    if (!rods_.empty() && !strands_.factor(rods_.layout())) {
        rods_.excludeTwistHessian(strands_.definite());
        assembleSums(at, obstacles, contacts);
        strands_.factor(rods_.layout());
    }
    if (!shells_.empty()) clothFactor_.factor(cloth_, clothExtra_);
}

void VertexSystem::assembleSums(const NewtonPoint& at, std::span<const ObstacleContact> obstacles, const ActiveContacts* contacts)
{
    copyPairs(contacts);
    gradient_.fill(0.0);
    if (!rods_.empty()) at.step.rods.forces(at.state, at.h, packsOf(gradient_), &strands_);
    if (!shells_.empty()) {
        cloth_.clear();
        for (Mat3& m : clothExtra_) m.setZero();
    }
    addInertia(at);
    if (!shells_.empty()) {
        at.step.shells.forces(at.state.x, at.h, unknowns_.slot, gradient_, &cloth_);
        for (std::size_t row = 0; row < ownsDiagonal_.size(); ++row)
            if (ownsDiagonal_[row]) {
                Eigen::Map<Mat3> block(cloth_.block(cloth_.begin(static_cast<int>(row))));
                addToDiagonal(shells_.vertices()[row], block);
                block.setZero();
            }
    }
    addObstacles(obstacles);
    if (!pairs_.empty()) addContacts(*contacts);
    weighFreePieces(at, obstacles, contacts);
    findComponents(at, contacts);
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
                    strands_.at(row + a, 0, l) += isOwner ? at.inertia[v][a] * perStep2 : 1.0;
                    if (isOwner) gradient_[slot + a * kLanes] += at.inertia[v][a] * perStep2 * (at.state.x[v][a] - at.freePositions[v][a]);
                }
                if (j == group.edges()) continue;
                const int e = layout.edge[group.firstEdge + j][l];
                const double inertia = (e >= 0 ? at.twistInertia * twistInertia(fabric_, at.state.absorbed, e) : 1.0) * perStep2;
                strands_.at(row + 3, 0, l) += inertia;
                if (e >= 0) gradient_[slot + 3 * kLanes] += inertia * (at.state.theta[e] - at.freeAngles[e]);
            }
    });
    parallelFor(shells_.vertices().size(), 256, [&](std::size_t row) {
        if (ownsDiagonal_[row]) return;
        const int v = shells_.vertices()[row], slot = unknowns_.slot[v];
        double* block = cloth_.block(cloth_.begin(static_cast<int>(row)));
        for (int a = 0; a < 3; ++a) {
            block[4 * a] += at.inertia[v][a] * perStep2;
            gradient_[slot + a * kLanes] += at.inertia[v][a] * perStep2 * (at.state.x[v][a] - at.freePositions[v][a]);
        }
    });
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
    const auto add = [&](int v, const Vec3& gradient, const Mat3& stiffness) {
        const int slot = unknowns_.slot[v];
        for (int a = 0; a < 3; ++a) gradient_[slot + a * kLanes] += gradient[a];
        if (unknowns_.isOnStrand(v)) addToDiagonal(v, stiffness);
        else asBlock(cloth_.begin(clothRow_[v])) += stiffness;
    };
    for (const ObstacleContact& contact : obstacles) {
        if (!contact.isEdge()) {
            add(contact.vertex, contact.gradient, contact.stiffness);
            continue;
        }
        const std::array<int, 3> v = contact.vertices();
        const std::array<double, 3> share = contact.shares();
        const int corners = contact.third == ObstacleContact::kNone ? 2 : 3;
        std::array<double, 3> own;
        for (int k = 0; k < corners; ++k) own[k] = share[k] * share[k];
        for (int k = 0; k < corners; ++k)
            for (int l = k + 1; l < corners; ++l) {
                const double both = share[k] * share[l];
                if (addCoupling(v[k], v[l], both * contact.stiffness)) continue;
                own[k] += both;
                own[l] += both;
            }
        for (int k = 0; k < corners; ++k) add(v[k], share[k] * contact.gradient, own[k] * contact.stiffness);
    }
}

/// Adds a block between two corners of an edge or a face, if the matrix has a place for it.
bool VertexSystem::addCoupling(int a, int b, const Mat3& block)
{
    if (!unknowns_.isOnStrand(a) && !unknowns_.isOnStrand(b)) {
        asBlock(cloth_.find(std::min(clothRow_[a], clothRow_[b]), std::max(clothRow_[a], clothRow_[b]))) += block;
        return true;
    }
    if (std::abs(unknowns_.slot[a] - unknowns_.slot[b]) != kNextVertex) return false;
    const int later = unknowns_.slot[a] > unknowns_.slot[b] ? a : b, row = unknowns_.row(later), lane = unknowns_.lane(later);
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) strands_.at(row + i, 4 + i - j, lane) += block(i, j);
    return true;
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
    heldGradient_.clear();
    for (int slot : heldSlots_) {
        heldGradient_.push_back(gradient_[slot]);
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

Vec3 VertexSystem::move(int vertex) const
{
    const int slot = unknowns_.slot[vertex];
    return {solution_[slot], solution_[slot + kLanes], solution_[slot + 2 * kLanes]};
}

}  // namespace sim
