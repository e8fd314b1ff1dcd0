#include "sim/momentum_budget.h"

#include "sim/core/parallel.h"
#include "sim/core/simd.h"

namespace sim {

void MomentumBudget::prepare(const Scene& scene, const Fabric& fabric)
{
    if (scene.obstacles.empty() && fabric.empty()) return;
    fabric_ = &fabric;
    isLed_ = scene.settings.fabric.solver == FabricSolver::Off;
    forces_.obstacles.resize(scene.obstacles.size());
    forces_.fabrics.resize(fabric.pieces());
    forces_.hardest.resize(fabric.pieces());
    forces_.pins.resize(fabric.pins.motions.size());
    pieces_.resize(fabric.pieces());
    before_.resize(fabric.pieces());
    pinsOf_.resize(fabric.pieces());
    pinned_.assign(fabric.pins.motions.size(), 0);
    for (std::size_t i = 0; i < fabric.pins.vertex.size(); ++i) {
        const int group = fabric.pins.motion[i];
        if (pinned_[group]++ == 0) pinsOf_[fabric.pieceOf(fabric.pins.vertex[i])].push_back(group);
    }
}

/// Momenta of the fabrics as they are.
void MomentumBudget::look(const FabricState& state)
{
    for (std::size_t k = 0; k < pieces_.size(); ++k) {
        before_[k] = pieces_[k].momentum;
        pieces_[k].momentum = {};
        pieces_[k].mass = 0.0;
        pieces_[k].moment.setZero();
    }
    for (std::size_t v = 0; v < state.v.size(); ++v) {
        Piece& piece = pieces_[fabric_->pieceOf(static_cast<int>(v))];
        const double mass = fabric_->mass[v] + state.absorbed[v];
        piece.momentum += Impulse::at(state.x[v], mass * state.v[v]);
        piece.mass += mass;
        piece.moment += mass * state.x[v];
    }
}

void MomentumBudget::begin(double dt, const State& state)
{
    if (!isOpen()) return;
    forces_.begin(dt);
    look(state.fabric);
    for (Piece& piece : pieces_) piece.byLiquid = piece.onPins = Vec3::Zero();
    liquid_.setZero();
    leftSoFar_ = state.ledger.leftMomentum;
    for (const Piece& piece : pieces_) forces_.balance.change -= piece.momentum.linear;
}

void MomentumBudget::entered(const State& state, std::size_t first)
{
    if (!isOpen()) return;
    Vec3& entered = forces_.balance.entered;
    for (std::size_t p = first; p < state.liquid.count; ++p) entered += state.liquid.mass[p] * state.liquid.velocity(p);
    liquid_ += entered;
}

void MomentumBudget::pushedIn(const Vec3& impulse)
{
    if (!isOpen()) return;
    forces_.balance.entered += impulse;
    liquid_ += impulse;
}

void MomentumBudget::left(const State& state)
{
    if (!isOpen()) return;
    forces_.balance.left = state.ledger.leftMomentum - leftSoFar_;
    liquid_ -= forces_.balance.left;
}

void MomentumBudget::exchanged(const State& state, std::span<const Vec3> pinImpulse)
{
    if (!isOpen()) return;
    look(state.fabric);
    for (std::size_t k = 0; k < pieces_.size(); ++k) {
        const Impulse got = pieces_[k].momentum - before_[k];
        forces_.fabrics[k].liquid += got;
        liquid_ -= got.linear;
    }
    Vec3 toNobody = Vec3::Zero();
    for (const Vec3& held : pinImpulse) toNobody += held;
    for (std::size_t i = 0; i < fabric_->pins.vertex.size() && !pinImpulse.empty(); ++i) {
        const int v = fabric_->pins.vertex[i];
        const Impulse held = Impulse::at(state.fabric.x[v], pinImpulse[v]);
        forces_.pins[fabric_->pins.motion[i]] += held;
        forces_.fabrics[fabric_->pieceOf(v)].liquid += held;
        liquid_ -= held.linear;
        toNobody -= held.linear;
    }
    if (isLed_) {
        forces_.balance.unresolved -= toNobody;
        liquid_ -= toNobody;
    }
    for (std::size_t k = 0; k < pieces_.size(); ++k) {
        pieces_[k].byLiquid = forces_.fabrics[k].liquid.linear;
        pieces_[k].onPins = onPins(k);
    }
}

/// What the pins of a fabric got so far [g cm/s].
Vec3 MomentumBudget::onPins(std::size_t piece) const
{
    Vec3 sum = Vec3::Zero();
    for (int group : pinsOf_[piece]) sum += forces_.pins[group].linear;
    return sum;
}

void MomentumBudget::fabricMoved(double dt, const Vec3& gravity, const State& state)
{
    if (!isOpen()) return;
    look(state.fabric);
    for (std::size_t k = 0; k < pieces_.size(); ++k) {
        Piece& piece = pieces_[k];
        const Vec3 weight = dt * piece.mass * gravity, byLiquid = forces_.fabrics[k].liquid.linear - piece.byLiquid;
        const Vec3 known = weight + byLiquid + forces_.fabrics[k].contact.linear - (onPins(k) - piece.onPins);
        piece.missing = piece.momentum.linear - before_[k].linear - known;
        forces_.balance.weight += weight;
        liquid_ -= byLiquid;
    }
    if (isLed_) {
        for (const Piece& piece : pieces_) forces_.balance.unresolved += piece.missing;
        return;
    }
    if (pieces_.size() > 1) settleLoose();
    for (std::size_t k = 0; k < pieces_.size(); ++k) settleHeld(k, state.fabric);
}

/// Fabrics that nothing holds have what is missing from those that are held, which give it by their masses; where none is, from each other.
void MomentumBudget::settleLoose()
{
    bool anyHeld = false;
    for (std::size_t k = 0; k < pieces_.size(); ++k) anyHeld = anyHeld || isHeld(k);
    const auto ofLoose = [&](std::size_t k) { return isHeld(k) ? Impulse() : Impulse::at(pieces_[k].middle(), pieces_[k].missing); };
    Impulse sum;
    double mass = 0.0;
    for (std::size_t k = 0; k < pieces_.size(); ++k) {
        sum += ofLoose(k);
        if (isHeld(k) == anyHeld) mass += pieces_[k].mass;
    }
    for (std::size_t k = 0; k < pieces_.size(); ++k) {
        Impulse got = ofLoose(k);
        if (isHeld(k) == anyHeld) got -= pieces_[k].mass / mass * sum;
        forces_.fabrics[k].contact += got;
        pieces_[k].missing -= got.linear;
    }
}

/// What is missing is from the pins, by the number of their vertices, or from the solid that was pushed hardest.
void MomentumBudget::settleHeld(std::size_t piece, const FabricState& state)
{
    const Vec3& missing = pieces_[piece].missing;
    if (!isHeld(piece)) {
        forces_.balance.unresolved += missing;
        return;
    }
    forces_.balance.borne -= missing;
    if (pinsOf_[piece].empty()) {
        const Impulse onObstacle = Impulse::at(pieces_[piece].middle(), -missing);
        forces_.obstacles[forces_.hardest[piece].obstacle].contact += onObstacle;
        forces_.fabrics[piece].contact -= onObstacle;
        return;
    }
    double vertices = 0.0;
    for (int group : pinsOf_[piece]) vertices += pinned_[group];
    for (std::size_t i = 0; i < fabric_->pins.vertex.size(); ++i) {
        const int v = fabric_->pins.vertex[i];
        if (fabric_->pieceOf(v) == static_cast<int>(piece)) forces_.pins[fabric_->pins.motion[i]] += Impulse::at(state.x[v], -missing / vertices);
    }
}

void MomentumBudget::liquidOnFaces(const FaceFields& faces, int blocks)
{
    if (!isOpen()) return;
    Vec3 momentum;
    for (int a = 0; a < kAxes; ++a)
        momentum[a] = parallelSum(blocks, [&](std::size_t b) {
            const double* of = faces.sums.block(static_cast<int>(b), FaceFields::kMomentum + a);
            Pack sum = loadPack(of);
            for (int c = kLanes; c < kBlockCells; c += kLanes) sum += loadPack(of + c);
            return sumLanes(sum);
        });
    forces_.balance.change += liquid_ - momentum;
    liquid_ = onFaces_ = momentum;
}

Vec3 MomentumBudget::liquidMoved(const Vec3& now, const Vec3& weight, const LiquidOnSolids& onSolids, const ChunkSums<Impulse>& pushed)
{
    if (!isOpen()) return Vec3::Zero();
    forces_.balance.weight += weight;
    liquid_ += weight;
    LiquidOnSolids::OnSolid most;
    int bearer = -1;
    for (std::size_t n = 0; n < forces_.obstacles.size(); ++n) {
        const LiquidOnSolids::OnSolid solid = onSolids.on(static_cast<int>(n));
        forces_.obstacles[n].liquid += solid.impulse;
        liquid_ -= solid.impulse.linear;
        if (solid.pressed > most.pressed) most = solid, bearer = static_cast<int>(n);
    }
    const Vec3 missing = now - liquid_;
    imposedMomentum_ = {};
    if (bearer >= 0) {
        imposedMomentum_ = {-missing, most.moment / most.pressed};
        forces_.obstacles[bearer].liquid += Impulse::at(imposedMomentum_.place, -missing);
        forces_.balance.borne -= missing;
    } else forces_.balance.unresolved += missing;
    liquid_ = now;
    for (std::size_t n = 0; n < forces_.obstacles.size(); ++n) {
        const Impulse stopped = pushed.sum(n);
        forces_.obstacles[n].liquid += stopped;
        liquid_ -= stopped.linear;
    }
    return now - onFaces_ - weight;
}

void MomentumBudget::finish()
{
    if (!isOpen()) return;
    forces_.balance.change += liquid_;
    for (const Piece& piece : pieces_) forces_.balance.change += piece.momentum.linear;
}

}  // namespace sim
