#include "sim/fabric/shells/shells.h"

#include "sim/core/parallel.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>

namespace sim {

namespace {

constexpr double kSharpest = 5.0 / 6.0 * std::numbers::pi;  ///< fold from which on 2 tan(θ/2) grows as its tangent does [rad]

template <class Batch>
ShellCorners<Pack> cornersOf(const Batch& batch, std::span<const Vec3> x)
{
    ShellCorners<Pack> c{};
    for (int i = 0; i < kShellVertices; ++i)
        for (int l = 0; l < kLanes; ++l)
            if (batch.vertex[i][l] >= 0) setLane(c[i], l, x[batch.vertex[i][l]]);
    for (int l = 0; l < kLanes; ++l) {
        if (batch.vertex[0][l] < 0) {  // an unused lane: any triangle
            setLane(c[1], l, Vec3::UnitX());
            setLane(c[2], l, Vec3::UnitY());
        }
        for (int k = 0; k < 3; ++k)  // no neighbour: the flat continuation
            if (batch.vertex[3 + k][l] < 0) setLane(c[3 + k], l, laneOf(c[(k + 1) % 3], l) + laneOf(c[(k + 2) % 3], l) - laneOf(c[k], l));
    }
    return c;
}

/// A measure Φ of a hinge's angle with its first and second derivative [-].
struct HingeAngle {
    double value, slope, second;
};

HingeAngle twiceSine(double angle)
{
    const double s = std::sin(0.5 * angle), c = std::cos(0.5 * angle);
    return {2.0 * s, c, -0.5 * s};
}

/// 2 tan(θ/2), which has no bound where cloth folds flat, up to kSharpest, and from there on its tangent.
HingeAngle twiceTangent(double angle)
{
    const double bent = std::clamp(angle, -kSharpest, kSharpest), t = std::tan(0.5 * bent), slope = 1.0 + t * t;
    if (bent == angle) return {2.0 * t, slope, t * slope};
    return {2.0 * t + slope * (angle - bent), slope, 0.0};
}

}  // namespace

MembraneStress<Pack> Shells::stressOf(const Batch& batch, const MembraneStrain<Pack>& strain) const
{
    return settings_.membrane == MembraneModel::StVk ? stVenantKirchhoff(batch.rest, strain) : neoHookean(batch.rest, strain);
}

Shells::BendMeasure Shells::measured(const Batch& batch, const ShellBend<Pack>& bend) const
{
    BendMeasure m;
    const bool isHinge = settings_.bending == BendingModel::Hinge;
    for (int k = 0; k < 3; ++k) {
        const Pack angle = bend.angle[k], rest = batch.rest.angle[k];
        if (!isHinge || settings_.hingeMeasure == HingeMeasure::Angle) {
            m.change[k] = angle - rest;
            m.slope[k] = m.curvature[k] = broadcast(1.0);
            continue;
        }
        const auto at = settings_.hingeMeasure == HingeMeasure::Tan ? twiceTangent : twiceSine;
        for (int l = 0; l < kLanes; ++l) {
            const HingeAngle h = at(angle[l]);
            const double change = h.value - at(rest[l]).value;
            m.change[k][l] = change;
            m.slope[k][l] = h.slope;
            m.curvature[k][l] = std::max(0.0, h.slope * h.slope + change * h.second);
        }
    }
    return m;
}

Shells::Step Shells::startStep(std::span<const Vec3> x)
{
    if (!damped_) return Step(*this);
    parallelFor(batches_.size(), kBatchesPerTask, [&](std::size_t n) {
        Batch& batch = batches_[n];
        const ShellCorners<Pack> corners = cornersOf(batch, x);
        batch.startGreen = membraneStrain(batch.rest, corners).green;
        batch.startAngle = shellBend(batch.rest, corners).angle;
    });
    return Step(*this);
}

/// Stresses and moments of kLanes triangles, and what they depend on.
struct Shells::Forces {
    MembraneStress<Pack> elastic;                     ///< elastic stress of the membrane
    std::array<Pack, 3> stress;                       ///< stress of the membrane with its damping
    std::array<std::array<PackVec3, 3>, 3> byStrain;  ///< derivatives ∂ε/∂x of the three strains for each own vertex
    ShellBend<Pack> bend;
    BendMeasure measure;
    std::array<Pack, 3> moment;  ///< ∂E/∂θ of each edge
    Pack rate, bendRate;         ///< damping of membrane and bending over the step [-]
};

[[gnu::always_inline]] inline Shells::Forces Shells::forcesOf(const Batch& batch, std::span<const Vec3> x, double h) const
{
    Forces forces;
    const ShellRest<Pack>& rest = batch.rest;
    const ShellCorners<Pack> corners = cornersOf(batch, x);
    const Pack perStep = broadcast(damped_ ? 1.0 / h : 0.0);

    const MembraneStrain<Pack> strain = membraneStrain(rest, corners);
    forces.elastic = stressOf(batch, strain);
    const std::array<Pack, 6>& c = forces.elastic.tangent;
    forces.rate = perStep * batch.damping;
    std::array<Pack, 3>& stress = forces.stress = forces.elastic.stress;
    if (damped_) {
        const Pack d0 = forces.rate * (strain.green[0] - batch.startGreen[0]), d1 = forces.rate * (strain.green[1] - batch.startGreen[1]);
        const Pack d2 = forces.rate * (strain.green[2] - batch.startGreen[2]);
        stress[0] += c[0] * d0 + c[3] * d1 + c[4] * d2;
        stress[1] += c[3] * d0 + c[1] * d1 + c[5] * d2;
        stress[2] += c[4] * d0 + c[5] * d1 + c[2] * d2;
    }

    forces.bend = shellBend(rest, corners);
    forces.measure = measured(batch, forces.bend);
    forces.bendRate = perStep * batch.bendDamping;
    std::array<Pack, 3> change = forces.measure.change;
    if (damped_)
        for (int k = 0; k < 3; ++k) change[k] += forces.bendRate * forces.measure.slope[k] * (forces.bend.angle[k] - batch.startAngle[k]);
    forces.moment = timesBending(rest.bending, change);
    for (int k = 0; k < 3; ++k) forces.moment[k] *= forces.measure.slope[k];

    for (int i = 0; i < 3; ++i) forces.byStrain[i] = {rest.ru[i] * strain.u, rest.rw[i] * strain.w, rest.ru[i] * strain.w + rest.rw[i] * strain.u};
    return forces;
}

[[gnu::always_inline]] inline void Shells::addGradient(const Batch& batch, const Forces& forces, std::span<const int> slot,
                                                       std::span<double> gradient) const
{
    const Pack zero{};
    for (int i = 0; i < kShellVertices; ++i) {
        PackVec3 g{zero, zero, zero};
        for (int k = 0; k < 3; ++k) g += forces.moment[k] * forces.bend.gradient[k][i];
        if (i < 3)
            for (int s = 0; s < 3; ++s) g += (batch.rest.area * forces.stress[s]) * forces.byStrain[i][s];
        for (int l = 0; l < kLanes; ++l) {
            if (batch.vertex[i][l] < 0) continue;
            const int at = slot[batch.vertex[i][l]];
            for (int a = 0; a < 3; ++a) gradient[at + a * kLanes] += g[a][l];
        }
    }
}

[[gnu::always_inline]] inline void Shells::addHessian(const Batch& batch, const Forces& forces, BlockMatrix& matrix) const
{
    const ShellRest<Pack>& rest = batch.rest;
    const ShellBend<Pack>& bend = forces.bend;
    const std::array<Pack, 6>& c = forces.elastic.tangent;
    const auto& byStrain = forces.byStrain;
    const Pack one = broadcast(1.0);
    const std::array<Pack, 3> tension = positivePart(forces.elastic.stress);
    const Pack stiff = rest.area * (one + forces.rate);
    std::array<Pack, 6> q = rest.bending;
    for (int k = 0; k < 3; ++k) q[k] *= forces.measure.curvature[k];
    for (Pack& entry : q) entry *= one + forces.bendRate;
    for (int i = 0; i < kShellVertices; ++i) {
        std::array<PackVec3, 3> bendRow;  // Q times the derivatives by vertex i
        for (int a = 0; a < 3; ++a) {
            const std::array<Pack, 3> column = timesBending(q, {bend.gradient[0][i][a], bend.gradient[1][i][a], bend.gradient[2][i][a]});
            for (int k = 0; k < 3; ++k) bendRow[k][a] = column[k];
        }
        for (int j = i; j < kShellVertices; ++j) {
            if (!areTied(i, j)) continue;
            std::array<Pack, 9> block;
            for (int a = 0; a < 3; ++a)
                for (int b = 0; b < 3; ++b) {
                    Pack v = bendRow[0][a] * bend.gradient[0][j][b];
                    for (int k = 1; k < 3; ++k) v += bendRow[k][a] * bend.gradient[k][j][b];
                    block[3 * a + b] = v;
                }
            if (j < 3) {
                for (int b = 0; b < 3; ++b) {
                    const Pack e0 = byStrain[j][0][b], e1 = byStrain[j][1][b], e2 = byStrain[j][2][b];
                    const Pack s0 = stiff * (c[0] * e0 + c[3] * e1 + c[4] * e2), s1 = stiff * (c[3] * e0 + c[1] * e1 + c[5] * e2);
                    const Pack s2 = stiff * (c[4] * e0 + c[5] * e1 + c[2] * e2);
                    for (int a = 0; a < 3; ++a) block[3 * a + b] += byStrain[i][0][a] * s0 + byStrain[i][1][a] * s1 + byStrain[i][2][a] * s2;
                }
                const Pack geometric = rest.area * (tension[0] * rest.ru[i] * rest.ru[j] + tension[1] * rest.rw[i] * rest.rw[j] +
                                                    tension[2] * (rest.ru[i] * rest.rw[j] + rest.rw[i] * rest.ru[j]));
                for (int a = 0; a < 3; ++a) block[4 * a] += geometric;
            }
            addBlock(batch, blockOf(i, j), block, matrix);
        }
    }
}

void Shells::forces(std::span<const Vec3> x, double h, std::span<const int> slot, std::span<double> gradient, BlockMatrix* matrix) const
{
    for (const std::vector<int>& color : tasks_)
        parallelFor(color.size(), [&](std::size_t n) {
            const std::size_t begin = color[n] * kBatchesPerTask, end = std::min(batches_.size(), begin + kBatchesPerTask);
            for (std::size_t b = begin; b < end; ++b) {
                const Forces at = forcesOf(batches_[b], x, h);
                addGradient(batches_[b], at, slot, gradient);
                if (matrix) addHessian(batches_[b], at, *matrix);
            }
        });
}

/// Row-major block number n of eight triangles to where each has it in the matrix.
void Shells::addBlock(const Batch& batch, int n, const std::array<Pack, 9>& block, BlockMatrix& matrix) const
{
    Pack ofLane[kLanes];  // but for the last number
    std::copy_n(block.begin(), kLanes, ofLane);
    transposeLanes(ofLane);
    for (int l = 0; l < kLanes; ++l) {
        if (batch.entry[n][l] < 0) continue;
        double* at = matrix.block(batch.entry[n][l]);
        Pack values = ofLane[l];
        if ((batch.isTransposed[n] >> l & 1u) == 0) values = permuteLanes(values, PackMask{0, 3, 6, 1, 4, 7, 2, 5});
        storeFirst(at, loadPack(at) + values, kLanes);
        at[8] += block[8][l];
    }
}

std::array<double, 2> Shells::energies(std::span<const Vec3> x) const
{
    const auto of = [&](const Batch& batch) {
        const ShellCorners<Pack> corners = cornersOf(batch, x);
        const MembraneStress<Pack> m = stressOf(batch, membraneStrain(batch.rest, corners));
        const BendMeasure b = measured(batch, shellBend(batch.rest, corners));
        const std::array<Pack, 3> moment = timesBending(batch.rest.bending, b.change);
        const Pack bending = 0.5 * (moment[0] * b.change[0] + moment[1] * b.change[1] + moment[2] * b.change[2]);
        return std::array<double, 2>{sumLanes(batch.rest.area * m.energy), sumLanes(bending)};
    };
    return parallelReduce(
        batches_.size(), std::array<double, 2>{}, [&](std::size_t n) { return of(batches_[n]); },
        [](std::array<double, 2> a, std::array<double, 2> b) {
            return std::array<double, 2>{a[0] + b[0], a[1] + b[1]};
        });
}

}  // namespace sim
