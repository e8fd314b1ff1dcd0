#include "sim/coupling/mixture.h"
#include "sim/coupling/yarn_flow.h"

#include <algorithm>
#include <cmath>

// Drag of the fabric on a face of the grid.

namespace sim {

namespace {

constexpr double kDensest = 0.9;     ///< part of its envelope that fibres of squeezed fabric fill at most [-]
constexpr double kLeastOpen = 0.05;  ///< share of a face that fabric leaves at least for liquid that flows past it [-]

}  // namespace

/// |u_f − u_s|: the face's own component, the others from the four faces around it that are shared.
double Mixture::speedAt(int block, int axis, int cell) const
{
    const int at[kAxes] = {cell % kBlockEdge, cell / kBlockEdge % kBlockEdge, cell / (kBlockEdge * kBlockEdge)};
    double square = std::pow(relative_.block(block, axis)[cell], 2);
    for (int other = 0; other < kAxes; ++other) {
        if (other == axis) continue;
        double sum = 0.0;
        int count = 0;
        for (int corner = 0; corner < 4; ++corner) {
            int near[kAxes] = {at[0], at[1], at[2]};
            near[axis] -= corner & 1;
            near[other] += corner >> 1;
            const CellRef ref = cellNear(onFaces_.grid(), block, near[0], near[1], near[2]);
            if (!(liquidMass_.block(ref.block, other)[ref.cell] > 0.0)) continue;
            sum += relative_.block(ref.block, other)[ref.cell];
            ++count;
        }
        if (count > 0) square += std::pow(sum / count, 2);
    }
    return std::sqrt(square);
}

/// D = dt c V on a face. By the fabric's own fraction φ of fibres: V is the envelope of fabric that liquid touches, and c(φ) goes by
/// the superficial velocity U. On a face whose part ψ are fibres, and V_s of V_c with what they hold, the phases are ΔU/(1 - ψ) apart, and
/// pressure on V_s adds V_s/(V_c - V_s) of D to what the fabric feels; less by both, the force is c U on the envelope for any cell (Darcy's
/// law). Yarns are resistances side by side: liquid flows through them, and around. By the cell's fraction, as published: c(ψ) (V_f + V_s).
/// @param room  of the face outside obstacles [-]
double Mixture::dragOn(int b, int a, int c, double liquidVolume, double room) const
{
    if (settings_.drag == DragLaw::Off) return 0.0;
    const double cell = std::pow(onFaces_.grid().dx, 3);
    const double fibres = onFaces_.fibres.block(b, a)[c], solid = onFaces_.solid.block(b, a)[c];
    const double shape = onFaces_.shape.block(b, a)[c], square = onFaces_.squares.block(b, a)[c];
    const double fraction = std::clamp(fibres / cell, 0.0, 1.0);
    if (settings_.dragFraction == DragFraction::Cell)
        return dt_ * (liquidVolume + solid) * dragAlongAxis(law_.drag(fraction, speedAt(b, a, c)), shape, square);

    const double envelope = onFaces_.envelope.block(b, a)[c];
    const double speed = (1.0 - fraction) * speedAt(b, a, c), own = std::min(fibres / envelope, kDensest);
    const double open = std::max(1.0 - fraction, kLeastOpen) * std::max(1.0 - solid / cell, kLeastOpen);
    const double wet = std::min(1.0, (liquidVolume + solid) / (room * cell));
    PorousLaw::Drag drag = law_.drag(own, speed);
    double alongAxis = shape < 1.0 ? (1.0 - shape) * dragAlongAxis(drag, 0.0, square) : 0.0;
    if (shape > 0.0) {
        const DragAround around = dragAround(liquid_, settings_.drag, onFaces_.diameter.block(b, a)[c], onFaces_.constriction.block(b, a)[c], speed);
        const auto sideBySide = [](double one, double other) { return one > 0.0 && other > 0.0 ? one * other / (one + other) : 0.0; };
        drag = {sideBySide(drag.along, around.along), sideBySide(drag.across, around.across)};
        alongAxis += shape * dragAlongAxis(drag, 1.0, square);
    }
    return dt_ * alongAxis * onFaces_.touched.block(b, a)[c] * wet * open;
}

}  // namespace sim
