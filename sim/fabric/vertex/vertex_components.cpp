#include "sim/fabric/vertex/vertex_system.h"

#include <algorithm>
#include <cmath>

// Conjugate gradients of each connected component by itself: with scalars for all of the fabric together, a strand that falls freely is left
// with errors that are small for the weave beside it, and gains energy by them.

namespace sim {

namespace {

/// Factor on the share that is asked for (LinearTolerance), to which a component's error is solved in the step's first iteration [-].
constexpr double kShareOfFirst = 0.3;

}  // namespace

void VertexSystem::PieceLanes::findCommon()
{
    common = *std::ranges::max_element(piece);
    for (int p : piece)
        if (p >= 0 && p != common) common = -1;
}

/// Where the pieces stand in vectors, and runs of rows of cloth.
void VertexSystem::layOutPieces()
{
    const StrandLayout& layout = rods_.layout();
    for (const StrandLayout::Group& group : layout.groups) {
        PieceLanes& lanes = strandPieces_.emplace_back();
        for (int l = 0; l < kLanes; ++l) {
            const int first = layout.vertex[group.firstVertex][l];
            lanes.piece[l] = first >= 0 ? components_.pieceOf(first) : -1;
        }
        lanes.findCommon();
    }
    laneDot_.resize(layout.groups.size());
    PieceLanes none;
    none.piece.fill(-1);
    clothPieces_.assign((unknowns_.size - unknowns_.strandSize) / (3 * kLanes), none);
    std::vector<char> begins(shells_.vertices().size() + 1, 0);
    for (int part = 0; part < clothFactor_.parts(); ++part) begins[clothFactor_.partBegin(part)] = 1;
    for (std::size_t row = 0; row < shells_.vertices().size(); ++row) {
        const int v = shells_.vertices()[row], piece = components_.pieceOf(v), cloth = unknowns_.slot[v] - unknowns_.strandSize;
        if (cloth >= 0) clothPieces_[cloth / (3 * kLanes)].piece[cloth % kLanes] = piece;
        if (row % BlockMatrix::kRowsAtOnce == 0 || begins[row] || runPiece_.back() != piece) runPiece_.push_back(piece);
        runOfRow_.push_back(static_cast<int>(runPiece_.size()) - 1);
    }
    for (PieceLanes& lanes : clothPieces_) lanes.findCommon();
    runDot_.resize(runPiece_.size());
    pieceMass_.resize(components_.pieces());
    pieceAtFirst_.resize(components_.pieces());
}

/// What the active pairs tie.
void VertexSystem::findComponents(const NewtonPoint& at, const ActiveContacts* contacts)
{
    components_.untie();
    for (std::size_t i = 0; contacts && i < contacts->size(); ++i) components_.tie(contacts->vertices[i][0], contacts->vertices[i][3]);
    components_.number();
    conjugate_.assign(components_.count(), {});
    std::ranges::fill(pieceMass_, 0.0);
    for (std::size_t v = 0; v < fabric_.vertexCount(); ++v)
        if (!fabric_.pinned[v]) pieceMass_[components_.pieceOf(static_cast<int>(v))] += at.inertia[v].mean();
    for (int piece = 0; piece < components_.pieces(); ++piece) conjugate_[components_.ofPiece(piece)].mass += pieceMass_[piece];
}

void VertexSystem::beginComponents()
{
    for (Component& c : conjugate_) c = {.mass = c.mass};
}

/// Where each component is solved for well enough, from its energy at the start.
void VertexSystem::setTargets(const LinearTolerance& tolerance, bool isFirst)
{
    for (Component& c : conjugate_) c.energy = c.next;
    if (isFirst)
        for (int piece = 0; piece < components_.pieces(); ++piece) {
            const Component& c = conjugate_[components_.ofPiece(piece)];
            pieceAtFirst_[piece] = c.mass > 0.0 ? c.energy / c.mass : 0.0;
        }
    for (Component& c : conjugate_) c.target = 0.0;
    if (!isFirst)
        for (int piece = 0; piece < components_.pieces(); ++piece)
            conjugate_[components_.ofPiece(piece)].target += kShareOfFirst * kShareOfFirst * pieceMass_[piece] * pieceAtFirst_[piece];
    const double share = tolerance.share * tolerance.share, left = tolerance.left * tolerance.left;
    for (Component& c : conjugate_) {
        const double enough = std::max(share * std::max(c.energy, c.target), c.mass * tolerance.speed * tolerance.speed);
        c.roundOff = c.mass * tolerance.roundOff * tolerance.roundOff;
        c.target = std::max(std::min({enough, c.mass * tolerance.most * tolerance.most, left * c.energy}), c.roundOff);
    }
}

/// Marks what is still to be solved for; false if that is nothing. One iteration at least, above round-off: as steps begin with the forces of
/// the last, errors too small for one would stay for good.
bool VertexSystem::findUnsolved(int iterations)
{
    bool isAny = false;
    for (Component& c : conjugate_) {
        c.isActive = c.isActive && c.energy > (iterations == 0 ? c.roundOff : c.target);
        isAny = isAny || c.isActive;
    }
    return isAny;
}

void VertexSystem::findSteps()
{
    for (Component& c : conjugate_) {
        c.isIndefinite = c.isIndefinite || (c.isActive && !(c.curvature > 0.0));
        c.isActive = c.isActive && !c.isIndefinite;
        c.step = c.isActive ? c.energy / c.curvature : 0.0;
    }
}

/// Packs of each group of strands: 1 in lanes of components that the last solve has not found to be indefinite, else 0.
std::vector<Pack> VertexSystem::lanesNotIndefinite() const
{
    std::vector<Pack> lanes(strandPieces_.size(), broadcast(1.0));
    for (std::size_t g = 0; g < lanes.size(); ++g)
        for (int l = 0; l < kLanes; ++l)
            if (const int piece = strandPieces_[g].piece[l]; piece >= 0 && conjugate_[components_.ofPiece(piece)].isIndefinite) lanes[g][l] = 0.0;
    return lanes;
}

void VertexSystem::findRatios()
{
    for (Component& c : conjugate_) {
        c.ratio = c.isActive ? c.next / c.energy : 0.0;
        if (c.isActive) c.energy = c.next;
    }
}

/// The rms of all of the fabric [cm/s].
double VertexSystem::speedError() const
{
    double energy = 0.0, mass = 0.0;
    for (const Component& c : conjugate_) {
        energy += std::max(c.energy, 0.0);
        mass += c.mass;
    }
    return mass > 0.0 ? std::sqrt(energy / mass) : 0.0;
}

/// Dot products of strands and of runs of cloth, by components.
void VertexSystem::sumDots(double Component::*to)
{
    for (Component& c : conjugate_) c.*to = 0.0;
    for (std::size_t g = 0; g < laneDot_.size(); ++g)
        for (int l = 0; l < kLanes; ++l)
            if (strandPieces_[g].piece[l] >= 0) conjugate_[components_.ofPiece(strandPieces_[g].piece[l])].*to += laneDot_[g][l];
    for (std::size_t run = 0; run < runDot_.size(); ++run) conjugate_[components_.ofPiece(runPiece_[run])].*to += runDot_[run];
}

bool VertexSystem::isActive(const PieceLanes& lanes) const
{
    if (lanes.common >= 0) return conjugate_[components_.ofPiece(lanes.common)].isActive;
    return std::ranges::any_of(lanes.piece, [&](int piece) { return piece >= 0 && conjugate_[components_.ofPiece(piece)].isActive; });
}

bool VertexSystem::isAnyRowActive(int begin, int end) const
{
    const int last = std::min(end, static_cast<int>(runOfRow_.size())) - 1;
    for (int run = runOfRow_[begin]; run <= runOfRow_[last]; ++run)
        if (conjugate_[components_.ofPiece(runPiece_[run])].isActive) return true;
    return false;
}

/// A scalar of the components that the lanes of a pack belong to.
Pack VertexSystem::scalarsOf(const PieceLanes& lanes, double Component::*which) const
{
    if (lanes.common >= 0) return broadcast(conjugate_[components_.ofPiece(lanes.common)].*which);
    Pack scalars{};
    for (int l = 0; l < kLanes; ++l)
        if (lanes.piece[l] >= 0) scalars[l] = conjugate_[components_.ofPiece(lanes.piece[l])].*which;
    return scalars;
}

}  // namespace sim
