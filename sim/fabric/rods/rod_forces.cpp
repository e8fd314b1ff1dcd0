#include "sim/core/parallel.h"
#include "sim/fabric/rods/rod_walk.h"

namespace sim {

void Rods::forces(const FabricState& state, double h, std::span<Pack> gradient, StrandMatrix* matrix) const
{
    if (matrix) matrix->clear();
    parallelFor(layout_.groups.size(), [&](std::size_t g) {
        const StrandLayout::Group& rowsOf = layout_.groups[g];
        const std::span<Pack> rows = gradient.subspan(rowsOf.firstRow, rowsOf.rows()), band = matrix ? matrix->rows(rowsOf) : std::span<Pack>();
        const int group = static_cast<int>(g);
        addStretching(group, state, h, rows, band);
        addBendingAndTwisting(group, state, h, rows, band);
    });
}

namespace {

/// The torque's part of the Hessian: what turns a twisted rod out of its plane. Not definite by itself.
void addTorque(const Pack& torque, const RodEdge<Pack>& e, const RodEdge<Pack>& f, std::span<Pack> band)
{
    constexpr int kBand = StrandMatrix::kBand;
    const TwistCurvature<Pack> c = twistCurvature(e, f);
    const auto entry = [&](int row, int column) -> Pack& { return band[row * kBand + row - column]; };
    for (int a = 0; a < 3; ++a)
        for (int b = 0; b < 3; ++b) {
            entry(4 + a, b) += torque * (c.ef[b][a] - c.ee[a][b]);
            entry(8 + a, b) -= torque * c.ef[b][a];
            entry(8 + a, 4 + b) += torque * (c.ef[b][a] - c.ff[a][b]);
            if (b > a) continue;
            entry(a, b) += torque * c.ee[a][b];
            entry(4 + a, 4 + b) += torque * (c.ee[a][b] - c.ef[a][b] - c.ef[b][a] + c.ff[a][b]);
            entry(8 + a, 8 + b) += torque * c.ff[a][b];
        }
}

/// What a yarn that is straighter than at rest opposes to turning about its tangent, beyond |κ|² of Gauss and Newton: with it |κ||κ̄|, so
/// that where the section is round the energy stays below its quadratic model for any angle. Without it Newton turned straightened
/// crimped yarns to and fro by a radian and more in every step.
Pack torsionalCorrection(const Pack& b00, const Pack& b01, const Pack& b11, const Pack* now, const Pack* rest)
{
    const auto square = [&](const Pack* k) { return (b00 * k[0] + 2.0 * b01 * k[1]) * k[0] + b11 * k[1] * k[1]; };
    const Pack here = square(now);
    return maxPack(sqrtPack(here * square(rest)) - here, broadcast(0.0));
}

}  // namespace

void Rods::addStretching(int g, const FabricState& state, double h, std::span<Pack> gradient, std::span<Pack> band) const
{
    constexpr int kBand = StrandMatrix::kBand;
    const StrandLayout::Group& group = layout_.groups[g];
    const Stiffness& k = stiffness_[g];
    const Pack one = broadcast(1.0), stretchRate = broadcast(damped_ ? 1.0 / h : 0.0) * k.stretchDamping;

    for (int j = 0; j < group.edges(); ++j) {
        const int i = group.firstEdge + j, row = 4 * j;
        const PackVec3 from = gathered(state.x, layout_.vertex[group.firstVertex + j]);
        const PackVec3 to = gathered(state.x, layout_.vertex[group.firstVertex + j + 1]);
        const RodEdge<Pack> e = edgeBetween(from, to, layout_.edge[i]);
        const Pack stretch = e.length * perRestLength_[i];
        Pack force = select(perRestLength_[i] > 0.0, k.stretch * (stretch - one), broadcast(0.0));
        if (damped_) force += k.stretch * stretchRate * (stretch - startStretch_[i]);
        for (int a = 0; a < 3; ++a) {
            gradient[row + a] -= force * e.tangent[a];
            gradient[row + 4 + a] += force * e.tangent[a];
        }
        if (band.empty()) continue;
        const Pack across = select(perRestLength_[i] > 0.0, k.stretch * maxPack(perRestLength_[i] - one / e.length, broadcast(0.0)), broadcast(0.0));
        const Pack along = k.stretch * perRestLength_[i] * (one + stretchRate) - across;
        for (int a = 0; a < 3; ++a)
            for (int b = 0; b < 3; ++b) {
                Pack entry = along * e.tangent[a] * e.tangent[b];
                if (a == b) entry += across;
                if (b <= a) {
                    band[(row + a) * kBand + a - b] += entry;
                    band[(row + 4 + a) * kBand + a - b] += entry;
                }
                band[(row + 4 + a) * kBand + 4 + a - b] -= entry;
            }
    }
}

void Rods::addBendingAndTwisting(int g, const FabricState& state, double h, std::span<Pack> gradient, std::span<Pack> band) const
{
    constexpr int kBand = StrandMatrix::kBand;
    const StrandLayout::Group& group = layout_.groups[g];
    const Stiffness& k = stiffness_[g];
    const bool hasTorque = sumLanes(twistHessianShare_[g]) > 0.0;
    const Pack one = broadcast(1.0), perStep = broadcast(damped_ ? 1.0 / h : 0.0);
    const Pack bendRate = perStep * k.bendDamping, twistRate = perStep * k.twistDamping;
    forEachInnerVertex(g, state, [&](const InnerVertex& at) {
        const Bend& bend = bends_[group.firstVertex + at.j];
        const RodStrain<Pack>& s = at.strain;
        const Pack half = broadcast(0.5) * bend.perLength, twistStiffness = k.twist * bend.perLength;
        std::array<Pack, 4> change;
        for (int c = 0; c < 4; ++c) change[c] = s.curvature[c] - bend.curvature[c];
        Pack twist = at.twist;
        if (damped_) {
            const std::array<Pack, 5>& start = startBend_[group.firstVertex + at.j];
            for (int c = 0; c < 4; ++c) change[c] += bendRate * (s.curvature[c] - start[c]);
            twist += twistRate * (at.twist - start[4]);
        }
        std::array<Pack, 4> moment;  // ∂E/∂κ
        for (int c = 0; c < 4; c += 2) {
            moment[c] = half * (k.bend00 * change[c] + k.bend01 * change[c + 1]);
            moment[c + 1] = half * (k.bend01 * change[c] + k.bend11 * change[c + 1]);
        }
        const Pack torque = twistStiffness * twist;
        const int row = 4 * (at.j - 1);
        for (int r = 0; r < kRodUnknowns; ++r) {
            Pack sum = torque * s.twistGradient[r];
            for (int c = 0; c < 4; ++c) sum += moment[c] * s.curvatureGradient[c][r];
            gradient[row + r] += sum;
        }
        if (band.empty()) return;
        const Pack bending = half * (one + bendRate), twisting = twistStiffness * (one + twistRate);
        const Pack b00 = bending * k.bend00, b01 = bending * k.bend01, b11 = bending * k.bend11;
        const auto& d = s.curvatureGradient;
        for (int r = 0; r < kRodUnknowns; ++r) {
            const Pack e0 = b00 * d[0][r] + b01 * d[1][r], e1 = b01 * d[0][r] + b11 * d[1][r];
            const Pack f0 = b00 * d[2][r] + b01 * d[3][r], f1 = b01 * d[2][r] + b11 * d[3][r];
            const Pack t = twisting * s.twistGradient[r];
            for (int c = 0; c <= r; ++c)
                band[(row + r) * kBand + r - c] += e0 * d[0][c] + e1 * d[1][c] + f0 * d[2][c] + f1 * d[3][c] + t * s.twistGradient[c];
        }
        const std::array<Pack, 4>&now = s.curvature, &rest = bend.curvature;
        band[(row + 3) * kBand] += torsionalCorrection(b00, b01, b11, &now[0], &rest[0]);
        band[(row + 7) * kBand] += torsionalCorrection(b00, b01, b11, &now[2], &rest[2]);
        if (hasTorque) addTorque(twistHessianShare_[g] * torque, at.before, at.after, band.subspan(row * kBand));
    });
}

}  // namespace sim
