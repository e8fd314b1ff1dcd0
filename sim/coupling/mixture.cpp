#include "sim/coupling/mixture.h"

#include "sim/core/check.h"
#include "sim/core/parallel.h"
#include "sim/coupling/mixture_face.h"
#include "sim/liquid/pressure.h"

#include <algorithm>
#include <cmath>

namespace sim {

namespace {

/// Where all of the fabric is held: what else could move of it, so that its mass stays finite.
constexpr double kLeastFree = 1.0e-9;

}  // namespace

Mixture::Mixture(const Fabric& fabric, const Settings& settings)
    : law_(settings.porous, settings.liquid, settings.coupling),
      liquid_(settings.liquid),
      liquidDensity_(settings.liquid.density),
      settings_(settings.coupling),
      suction_(fabric, settings),
      onFaces_(fabric, settings.liquid.density)
{
    loads_.drag.resize(fabric.vertexCount());
    loads_.impulse.resize(fabric.vertexCount());
    if (hasReaction()) reactionOf_.resize(fabric.vertexCount());
}

/// @param vertices, grid  of the fabric, and of the liquid
bool Mixture::matchBlocks(const BlockGrid& vertices, const BlockGrid& grid)
{
    liquidBlock_.clear();
    for (const Vec3i& coords : vertices.coords()) liquidBlock_.push_back(grid.find(coords));
    return std::ranges::any_of(liquidBlock_, [](int b) { return b != BlockGrid::kNone; });
}

std::optional<Mixture::SharedFaces> Mixture::findSharedFaces(const CutGrid& cut, const Vec3& gravity, double dt, const MetFabric& fabric,
                                                             LiquidGrid& liquid)
{
    vertices_ = &fabric.vertices;
    if (!matchBlocks(vertices_->grid, cut.grid)) return std::nullopt;
    dt_ = dt;
    SIM_CHECK(fabric.distance.empty() != isDragByFabric(settings_));
    onFaces_.spread(*vertices_, fabric.state, fabric.distance);
    if (fabric.faces) onFaces_.takeVelocity(*fabric.faces);
    for (Faces* u : {&liquidMass_, &relative_, &liquidVolume_, &drag_, &predicted_, &pressed_, &mixed_, &mobility_, &suctionImpulse_, &reaction_,
                     &onFabric_, &dragImpulse_, &pressureImpulse_, &faceImpulse_, &scratch_})
        u->resize(onFaces_.grid().count());
    findRelative(gravity, cut.field, liquid);
    if (settings_.capillary) addSuction(cut, fabric.state, liquid);
    if (hasReaction()) applyReaction();
    mixVelocities(gravity, cut.field, liquid);
    addDisplacedMass(liquid);
    return SharedFaces();
}

/// Which faces are shared, and how the phases move past each other there before anything acts on them. Faces at openings move as these say, whatever
/// fabric does.
void Mixture::findRelative(const Vec3& gravity, const ObstacleField& obstacles, const LiquidGrid& liquid)
{
    parallelFor(liquidBlock_.size(), [&](std::size_t n) {
        const int b = static_cast<int>(n), m = liquidBlock_[b];
        std::fill_n(liquidMass_.block(b), Faces::kStride, 0.0);
        std::fill_n(relative_.block(b), Faces::kStride, 0.0);
        if (m == BlockGrid::kNone) return;
        for (int a = 0; a < kAxes; ++a) {
            const double *mass = liquid.faces.sums.block(m, FaceFields::kMass + a), *u = liquid.faces.velocity.block(m, a);
            const double *fabric = onFaces_.mass.block(b, a), *v = onFaces_.velocity.block(b, a), *room = obstacles.room(m, a);
            for (int c = 0; c < kBlockCells; ++c) {
                if (!(mass[c] > 0.0 && fabric[c] > 0.0 && room[c] > 0.0)) continue;
                if (liquid.hasOpenings && liquid.atOpenings.test(m, c, a)) continue;
                liquidMass_.block(b, a)[c] = mass[c];
                relative_.block(b, a)[c] = u[c] - dt_ * gravity[a] - v[c];
                predicted_.block(b, a)[c] = u[c];
            }
        }
    });
}

/// Fabric draws liquid to where its pores are empty (coupling/README.md, Suction).
void Mixture::addSuction(const CutGrid& cut, const FabricState& state, const LiquidGrid& liquid)
{
    suction_.find(*vertices_, state, cut.grid, liquidBlock_, liquid);
    Faces& perSlope = scratch_;  // for applyReaction
    parallelFor(liquidBlock_.size(), [&](std::size_t b) { std::fill_n(perSlope.block(static_cast<int>(b)), Faces::kStride, 0.0); });
    const double cell = std::pow(onFaces_.grid().dx, 3);
    forEachShared([&](int b, int m, int a, int c) {
        const double mass = liquidMass_.block(b, a)[c], volume = mass / liquidDensity_;
        const double fibres = onFaces_.fibres.block(b, a)[c], held = onFaces_.solid.block(b, a)[c] - fibres;
        const double saturation = fibres < cell ? std::clamp((volume + held) / (cell - fibres), 0.0, 1.0) : 0.0;
        const double along = suctionAlongAxis(onFaces_.shape.block(b, a)[c], onFaces_.squares.block(b, a)[c]);
        const double factor = dt_ * volume * saturation * cut.field.open(m, a)[c] * along;
        const double impulse = factor * suction_.slope(onFaces_.grid(), b, a, c);
        perSlope.block(b, a)[c] = factor;
        suctionImpulse_.block(b, a)[c] = impulse;
        predicted_.block(b, a)[c] += impulse / mass;
    });
}

/// Suction draws the fabric to the liquid by as much.
void Mixture::applyReaction()
{
    suction_.applyReaction(*vertices_, scratch_, reactionOf_);
    parallelFor(liquidBlock_.size(), [&](std::size_t b) { std::fill_n(reaction_.block(static_cast<int>(b)), Faces::kStride, 0.0); });
    onFaces_.scatter([&](int v) { return reactionOf_[v]; }, reaction_);
}

/// Drag, and what both phases together do (MixtureSplit).
void Mixture::mixVelocities(const Vec3& gravity, const ObstacleField& obstacles, const LiquidGrid& liquid)
{
    const double cell = std::pow(onFaces_.grid().dx, 3);
    forEachShared([&](int b, int m, int a, int c) {
        const double fibres = onFaces_.fibres.block(b, a)[c];
        const double mass = liquidMass_.block(b, a)[c], full = liquid.fullMass * obstacles.room(m, a)[c];
        MixtureFace face;
        const double free = std::clamp(1.0 - onFaces_.held.block(b, a)[c], kLeastFree, 1.0);
        face.liquidMass = mass;
        face.fabricMass = onFaces_.mass.block(b, a)[c] / free;  // what is held does not give way to drag and pressure
        face.fabricVolume = onFaces_.solid.block(b, a)[c];
        // Pressure acts on all the room that the fabric leaves, as without fabric; on a little liquid as on kLeastFill.
        face.liquidVolume = std::max(full / liquidDensity_ - face.fabricVolume, 0.0) * std::min(1.0, mass / (kLeastFill * full));
        face.fraction = std::clamp(fibres / cell, 0.0, 1.0);
        face.drag = dragOn(b, a, c, mass / liquidDensity_, obstacles.room(m, a)[c]);

        if (!settings_.pressureOnFabric) face.fabricVolume = 0.0;

        const MixtureSplit split = splitMixture(face);
        const double back = hasReaction() ? reaction_.block(b, a)[c] / face.fabricMass : 0.0;
        const double fabric = onFaces_.velocity.block(b, a)[c] + dt_ * free * gravity[a] + back;
        liquidVolume_.block(b, a)[c] = face.liquidVolume;
        drag_.block(b, a)[c] = face.drag;
        mixed_.block(b, a)[c] = split.ofLiquid * predicted_.block(b, a)[c] + split.ofFabric * fabric;
        mobility_.block(b, a)[c] = split.mobility;
    });
}

/// Room that fabric takes up is full.
void Mixture::addDisplacedMass(LiquidGrid& liquid) const
{
    const double perVolume = liquid.fullMass / std::pow(onFaces_.grid().dx, 3);
    forEachShared(
        [&](int b, int m, int a, int c) { liquid.faces.sums.block(m, FaceFields::kMass + a)[c] += perVolume * onFaces_.solid.block(b, a)[c]; });
}

void Mixture::removeDisplacedMass(const SharedFaces&, LiquidGrid& liquid) const { removeDisplacedMass(liquid); }

void Mixture::removeDisplacedMass(LiquidGrid& liquid) const
{
    forEachShared([&](int b, int m, int a, int c) { liquid.faces.sums.block(m, FaceFields::kMass + a)[c] = liquidMass_.block(b, a)[c]; });
}

void Mixture::toMassesOfBoth(const EliminatedDrag&, LiquidGrid& liquid, BlockArray<double, 3>& change) const
{
    forEachShared([&](int b, int m, int a, int c) {
        const double mobility = mobility_.block(b, a)[c], pushed = liquidVolume_.block(b, a)[c] + onFaces_.solid.block(b, a)[c];
        liquid.faces.sums.block(m, FaceFields::kMass + a)[c] = mobility > 0.0 ? pushed / mobility : 0.0;
        change.block(m, a)[c] = liquid.faces.velocity.block(m, a)[c] - mixed_.block(b, a)[c];
    });
}

void Mixture::fromMassesOfBoth(const EliminatedDrag&, LiquidGrid& liquid) const
{
    removeDisplacedMass(liquid);
    addDisplacedMass(liquid);
}

Mixture::EliminatedDrag Mixture::eliminateDrag(const SharedFaces&, const ObstacleField& obstacles, LiquidGrid& liquid,
                                               BlockArray<double, 3>& coefficient)
{
    const double scale = dt_ / (onFaces_.grid().dx * onFaces_.grid().dx);
    forEachShared([&](int b, int m, int a, int c) {
        liquid.faces.velocity.block(m, a)[c] = mixed_.block(b, a)[c];
        double& k = coefficient.block(m, a)[c];
        if (k > 0.0) k = scale * obstacles.open(m, a)[c] * mobility_.block(b, a)[c];
    });
    return EliminatedDrag();
}

Mixture::AppliedPressure Mixture::applyPressure(const EliminatedDrag&, const LiquidGrid& liquid)
{
    parallelFor(liquidBlock_.size(), [&](std::size_t b) {
        for (Faces* u : {&onFabric_, &dragImpulse_, &pressureImpulse_}) std::fill_n(u->block(static_cast<int>(b)), Faces::kStride, 0.0);
    });
    forEachShared([&](int b, int m, int a, int c) {
        const double mass = liquidMass_.block(b, a)[c], drag = drag_.block(b, a)[c], mobility = mobility_.block(b, a)[c];
        const double change = liquid.faces.velocity.block(m, a)[c] - mixed_.block(b, a)[c];
        const double push = mobility > 0.0 ? -change / mobility : 0.0;
        const double u = predicted_.block(b, a)[c] - liquidVolume_.block(b, a)[c] / mass * push;
        pressed_.block(b, a)[c] = u;
        pressureImpulse_.block(b, a)[c] = push;
        onFabric_.block(b, a)[c] = drag * mass / (mass + drag);
        dragImpulse_.block(b, a)[c] = onFabric_.block(b, a)[c] * u;
    });
    return AppliedPressure();
}

void Mixture::clearShared(const SharedFaces&, BlockArray<double, 3>& values) const
{
    forEachShared([&](int, int m, int a, int c) { values.block(m, a)[c] = 0.0; });
}

void Mixture::clearShared(const SharedFaces&, BlockBits<3>& faces) const
{
    forEachShared([&](int, int m, int a, int c) { faces.block(m, a)[c >> 6] &= ~(std::uint64_t{1} << (c & 63)); });
}

/// Values of shared faces over the fabric's mass there, for a vertex gets its share of them by mass; 0 on other faces. In scratch_.
const Mixture::Faces& Mixture::perFabricMass(const Faces& values)
{
    parallelFor(liquidBlock_.size(), [&](std::size_t b) { std::fill_n(scratch_.block(static_cast<int>(b)), Faces::kStride, 0.0); });
    forEachShared([&](int b, int, int a, int c) { scratch_.block(b, a)[c] = values.block(b, a)[c] / onFaces_.mass.block(b, a)[c]; });
    return scratch_;
}

const LiquidLoads& Mixture::vertexLoads(const AppliedPressure&)
{
    // Vertices far from the liquid are not visited.
    std::ranges::fill(loads_.drag, Vec3::Zero());
    std::ranges::fill(loads_.impulse, Vec3::Zero());
    onFaces_.gather(perFabricMass(onFabric_), [&](int v, const Vec3& d) { loads_.drag[v] = onFaces_.massOf(v) * d; });
    onFaces_.gather(perFabricMass(dragImpulse_), [&](int v, const Vec3& f) { loads_.impulse[v] = onFaces_.massOf(v) * f; });
    if (settings_.pressureOnFabric) onFaces_.gather(pressureImpulse_, [&](int v, const Vec3& f) { loads_.impulse[v] -= onFaces_.solidOf(v) * f; });
    if (hasReaction())
        for (std::size_t v = 0; v < reactionOf_.size(); ++v) loads_.impulse[v] += reactionOf_[v];
    return loads_;
}

FaceLoads Mixture::faceLoads(const AppliedPressure&)
{
    Faces& impulse = faceImpulse_;
    parallelFor(liquidBlock_.size(), [&](std::size_t n) {
        const int b = static_cast<int>(n);
        std::copy_n(dragImpulse_.block(b), Faces::kStride, impulse.block(b));
    });
    if (settings_.pressureOnFabric)
        forEachShared([&](int b, int, int a, int c) { impulse.block(b, a)[c] -= onFaces_.solid.block(b, a)[c] * pressureImpulse_.block(b, a)[c]; });
    if (hasReaction())
        parallelFor(liquidBlock_.size(), [&](std::size_t b) {
            double* pull = impulse.block(static_cast<int>(b));
            const double* reaction = reaction_.block(static_cast<int>(b));
            for (std::size_t i = 0; i < Faces::kStride; ++i) pull[i] += reaction[i];
        });
    return {onFaces_.grid(), onFabric_, impulse};
}

Mixture::SeparatedPhases Mixture::recoverPhaseVelocities(const AppliedPressure&, const FabricState& state, LiquidGrid& liquid)
{
    onFaces_.spreadVelocity(state);
    recoverLiquidVelocities(liquid);
    return SeparatedPhases();
}

Mixture::SeparatedPhases Mixture::recoverPhaseVelocities(const AppliedPressure&, const FabricFaces& faces, LiquidGrid& liquid)
{
    onFaces_.takeVelocity(faces);
    recoverLiquidVelocities(liquid);
    return SeparatedPhases();
}

void Mixture::recoverLiquidVelocities(LiquidGrid& liquid) const
{
    forEachShared([&](int b, int m, int a, int c) {
        const double mass = liquidMass_.block(b, a)[c], drag = drag_.block(b, a)[c], fabric = onFaces_.velocity.block(b, a)[c];
        liquid.faces.velocity.block(m, a)[c] = (mass * pressed_.block(b, a)[c] + drag * fabric) / (mass + drag);
    });
}

/// Impulse that a shared face's liquid gave, by the fabric's velocity at the end of the step [g cm/s].
double Mixture::impulseTaken(int block, int axis, int cell) const
{
    const double mass = liquidMass_.block(block, axis)[cell], drag = drag_.block(block, axis)[cell];
    double impulse = mass * drag / (mass + drag) * (pressed_.block(block, axis)[cell] - onFaces_.velocity.block(block, axis)[cell]);
    if (settings_.capillary) impulse -= suctionImpulse_.block(block, axis)[cell];
    if (settings_.pressureOnFabric) impulse -= onFaces_.solid.block(block, axis)[cell] * pressureImpulse_.block(block, axis)[cell];
    return impulse;
}

bool Mixture::isShared(const SharedFaces&, int axis, const Vec3i& cell) const
{
    const int block = onFaces_.grid().find(cell.unaryExpr([](int i) { return i >> 3; }));
    return block != BlockGrid::kNone && liquidMass_.block(block, axis)[cellInBlock(cell.x() & 7, cell.y() & 7, cell.z() & 7)] > 0.0;
}

}  // namespace sim
