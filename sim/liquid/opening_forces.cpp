#include "sim/liquid/openings.h"
#include "sim/liquid/surface_weight.h"

#include <algorithm>
#include <cmath>

namespace sim {

namespace {

constexpr double kSlowness = 100.0;  ///< time of the mean of what goes out, relative to that of a long wave over its depth [-]

/// Does a face carry liquid, and no solid close it?
bool isPassed(const CutGrid& cut, const LiquidGrid& liquid, const CellRef& face, int axis)
{
    return face.block != cut.grid.count() && liquid.wet.test(face.block, face.cell, axis) && cut.field.open(face.block, axis)[face.cell] > 0.0;
}

double massOf(const LiquidGrid& liquid, const CellRef& face, int axis)
{
    return liquid.faces.sums.block(face.block, FaceFields::kMass + axis)[face.cell];
}

}  // namespace

/// Mean velocity at which liquid goes out through a plane, by mass [cm/s].
std::optional<double> Openings::meanOut(const Side& side, const LiquidGrid& liquid) const
{
    const int a = side.opening.axis;
    double mass = 0.0, momentum = 0.0;
    for (std::size_t n = side.firstFace; n < side.endFace; ++n) {
        const CellRef& face = planeFaces_[n].face;
        const double m = massOf(liquid, face, a);
        mass += m;
        momentum += m * liquid.faces.velocity.block(face.block, a)[face.cell];
    }
    return mass > 0.0 ? std::optional(side.opening.outward() * momentum / mass) : std::nullopt;
}

void Openings::followMean(const LiquidGrid& liquid, double gravity, double dt, std::span<OpeningMemory> memory) const
{
    for (std::size_t n = 0; n < sides_.size(); ++n) {
        const double depth = sides_[n].depth;
        if (!(depth > 0.0) || !(gravity > 0.0)) continue;
        const std::optional<double> out = meanOut(sides_[n], liquid);
        if (!out) continue;
        const double share = memory[n].isKnown > 0.0 ? -std::expm1(-dt / (kSlowness * std::sqrt(depth / gravity))) : 1.0;
        memory[n].mean += share * (*out - memory[n].mean);
        memory[n].isKnown = 1.0;
    }
}

/// Face by face, from the top of each column down, against the middle of its liquid.
void Openings::weigh(const LiquidGrid& liquid, const Vec3& fall)
{
    int a = 0;
    if (fall.cwiseAbs().maxCoeff(&a) == 0.0) return;
    for (const PlaneFace& top : planeFaces_) {
        if (top.above != kNone) continue;
        double missing = 0.0;
        int wet = 0;
        for (int n = static_cast<int>(&top - planeFaces_.data()); n != kNone; n = planeFaces_[n].below) {
            PlaneFace& plane = planeFaces_[n];
            const auto [block, cell] = plane.over;
            plane.missing = missing;
            if (!liquid.wet.test(block, cell, a)) continue;
            const double before = liquid.faces.sums.block(block, FaceFields::kMomentum + a)[cell] / massOf(liquid, plane.over, a);
            plane.missing = missing += 1.0 - (liquid.faces.velocity.block(block, a)[cell] - before) / fall[a];
            ++wet;
        }
        int seen = 0;
        double inMiddle = 0.0;
        for (int n = static_cast<int>(&top - planeFaces_.data()); n != kNone; n = planeFaces_[n].below)
            if (liquid.wet.test(planeFaces_[n].over.block, planeFaces_[n].over.cell, a) && 2 * seen++ <= wet) inMiddle = planeFaces_[n].missing;
        for (int n = static_cast<int>(&top - planeFaces_.data()); n != kNone; n = planeFaces_[n].below) planeFaces_[n].missing -= inMiddle;
    }
}

/// What stands beyond an outlet acts on its plane.
void Openings::press(const CutGrid& cut, const Push& push, const PressureFaces& faces, const OpeningMemory& memory, const Side& side,
                     LiquidGrid& liquid)
{
    const int a = side.opening.axis;
    const double gravity = push.gravity.norm(), ofCell = push.density * gravity * dx_;
    const double perPressure = push.fallTime * liquid.fullMass / (push.density * dx_);
    double level = side.opening.level;
    if (side.depth > 0.0)
        if (const std::optional<double> out = meanOut(side, liquid)) level += std::sqrt(side.depth / gravity) * (*out - memory.mean);
    for (std::size_t n = side.firstFace; n < side.endFace; ++n) {
        PlaneFace& plane = planeFaces_[n];
        const auto [block, cell] = plane.face;
        plane.pushed = 0.0;
        if (!(gravity > 0.0) || !isPassed(cut, liquid, plane.face, a)) continue;
        const double out = side.opening.outward(), depth = std::max(0.0, depthOfPressure((level - plane.height) / dx_) - plane.missing);
        const double impulse = -out * perPressure * ofCell * depth;
        const double coefficient = faces.coefficient().block(block, a)[cell], room = cut.field.room(block, a)[cell];
        double& u = liquid.faces.velocity.block(block, a)[cell];
        if (coefficient > 0.0) plane.pushed = impulse * coefficient / (faces.ofFull() * liquid.fullMass * cut.field.open(block, a)[cell]);
        else {
            // Beyond the surface it holds against PressureBeyond, and gives what has no pressure no more than its head.
            const double wanted = impulse * room / std::max(massOf(liquid, plane.face, a), kLeastFill * liquid.fullMass * room);
            const double fastest = std::max(-out * u, std::sqrt(2.0 * gravity * depth * dx_));
            plane.pushed = -out * std::min(-out * wanted, fastest + out * u);
        }
        u += plane.pushed;
    }
}

/// The velocity that an inlet gives to one of its faces [cm/s].
double Openings::velocityOf(const DrivenFace& driven, const LiquidGrid& liquid)
{
    const bool meetsWall = driven.by == DrivenFace::By::VelocityInAir && liquid.inside.test(driven.from.block, driven.from.cell);
    return meetsWall ? 0.0 : driven.velocity;
}

void Openings::drive(const CutGrid& cut, const Push& push, const PressureFaces& faces, std::span<const OpeningMemory> memory, LiquidGrid& liquid)
{
    driven_ = held_ = 0.0;
    fall_ = push.fallTime * push.gravity;
    for (const DrivenFace& driven : drivenFaces_) {
        if (driven.by == DrivenFace::By::Copy || !isPassed(cut, liquid, driven.face, driven.axis)) continue;
        const double fall = fall_[driven.axis], mass = massOf(liquid, driven.face, driven.axis);
        held_ += mass * fall * (liquid.faces.velocity.block(driven.face.block, driven.axis)[driven.face.cell] - 0.5 * fall);
        const double to = velocityOf(driven, liquid);
        double& u = liquid.faces.velocity.block(driven.face.block, driven.axis)[driven.face.cell];
        driven_ += 0.5 * mass * (to - u) * (to + u);
        u = to;
    }
    for (std::size_t n = 0; n < sides_.size(); ++n) {
        const Side& side = sides_[n];
        if (!side.opening.isInlet()) press(cut, push, faces, memory[n], side, liquid);
        for (std::size_t f = side.firstFace; side.opening.isInlet() && f < side.endFace; ++f) {
            const auto [block, cell] = planeFaces_[f].face;
            planeFaces_[f].kept = liquid.faces.velocity.block(block, side.opening.axis)[cell];
        }
    }
}

double Openings::viscousWork(const CutGrid& cut, const LiquidGrid& liquid, const BlockArray<double, 3>& withheld) const
{
    double work = 0.0;
    for (const DrivenFace& driven : drivenFaces_) {
        const auto [block, cell] = driven.face;
        if (driven.by == DrivenFace::By::Copy || !isPassed(cut, liquid, driven.face, driven.axis)) continue;
        const double change = liquid.faces.velocity.block(block, driven.axis)[cell] - velocityOf(driven, liquid);
        work += massOf(liquid, driven.face, driven.axis) * withheld.block(block, driven.axis)[cell] * change;
    }
    return work;
}

void Openings::keepMoved(const BlockArray<double, 3>& velocity)
{
    for (const Side& side : sides_)
        for (std::size_t n = side.firstFace; n < side.endFace; ++n) {
            const auto [block, cell] = planeFaces_[n].face;
            planeFaces_[n].moved = velocity.block(block, side.opening.axis)[cell];
        }
}

/// As far as the face that another moves like has been held against its weight, that one is.
Openings::Carried Openings::carry(const CutGrid& cut, const LiquidGrid& liquid, BlockArray<double, 3>& velocity) const
{
    Carried carried;
    for (const DrivenFace& driven : drivenFaces_) {
        const int a = driven.axis;
        if (driven.by != DrivenFace::By::Copy || !isPassed(cut, liquid, driven.face, a) || !isPassed(cut, liquid, driven.from, a)) continue;
        const double to = velocity.block(driven.from.block, a)[driven.from.cell];
        double& u = velocity.block(driven.face.block, a)[driven.face.cell];
        const double mass = massOf(liquid, driven.face, a), held = fall_[a] != 0.0 ? std::clamp((u - to) / fall_[a], 0.0, 1.0) * fall_[a] : 0.0;
        carried.gained += 0.5 * mass * (to - u) * (to + u);
        carried.held += mass * held * (u - 0.5 * held);
        u = to;
    }
    return carried;
}

double Openings::inletWork(const CutGrid& cut, const LiquidGrid& liquid, const BlockArray<double>& pressure, double perPressure) const
{
    double work = 0.0;
    for (const Side& side : sides_) {
        const int a = side.opening.axis;
        for (std::size_t n = side.firstFace; side.opening.isInlet() && n < side.endFace; ++n) {
            const PlaneFace& plane = planeFaces_[n];
            const auto [block, cell] = plane.face;
            const double inwards = -side.opening.outward() * liquid.faces.velocity.block(block, a)[cell];
            work += cut.field.open(block, a)[cell] * perPressure * inwards * pressure.block(plane.inner.block)[plane.inner.cell];
        }
    }
    return work;
}

double Openings::pressureWork(const CutGrid& cut, const LiquidGrid& liquid, const BlockArray<double>& pressure, double perPressure) const
{
    double work = inletWork(cut, liquid, pressure, perPressure);
    for (const Side& side : sides_)
        for (std::size_t n = side.firstFace; !side.opening.isInlet() && n < side.endFace; ++n) {
            const PlaneFace& plane = planeFaces_[n];
            const int a = side.opening.axis;
            const double now = liquid.faces.velocity.block(plane.face.block, a)[plane.face.cell];
            work += massOf(liquid, plane.face, a) * plane.pushed * plane.moved.value_or(now);
        }
    return work;
}

Vec3 Openings::impulse(const CutGrid& cut, const Outcome& outcome, const LiquidOnSolids::Levelling* onSolids) const
{
    const LiquidGrid& liquid = outcome.liquid;
    Vec3 sum = Vec3::Zero();
    const auto add = [&](const CellRef& face, int axis, double impulse) {
        sum[axis] += impulse;
        if (onSolids != nullptr) onSolids->weightGrew(face.block, axis, face.cell, impulse);
    };
    for (const DrivenFace& driven : drivenFaces_) {
        const auto [block, cell] = driven.face;
        const int a = driven.axis;
        if (!isPassed(cut, liquid, driven.face, a)) continue;
        const double change = outcome.velocity.block(block, a)[cell] - liquid.unpressed.block(block, a)[cell];
        add(driven.face, a, massOf(liquid, driven.face, a) * change);
    }
    for (const Side& side : sides_)
        for (std::size_t n = side.firstFace; n < side.endFace; ++n) {
            const PlaneFace& plane = planeFaces_[n];
            const int a = side.opening.axis;
            double impulse = massOf(liquid, plane.face, a) * plane.pushed;
            if (side.opening.isInlet()) {
                const auto [block, cell] = plane.inner;
                const double p = outcome.pressure.block(block)[cell] + (outcome.again ? outcome.again->block(block)[cell] : 0.0);
                impulse = -side.opening.outward() * outcome.perPressure * cut.field.open(plane.face.block, a)[plane.face.cell] * p;
            }
            add(plane.face, a, impulse);
        }
    return sum;
}

void Openings::swapAtInlets(BlockArray<double, 3>& advected)
{
    for (const Side& side : sides_)
        for (std::size_t n = side.firstFace; side.opening.isInlet() && n < side.endFace; ++n)
            std::swap(planeFaces_[n].kept, advected.block(planeFaces_[n].face.block, side.opening.axis)[planeFaces_[n].face.cell]);
}

}  // namespace sim
