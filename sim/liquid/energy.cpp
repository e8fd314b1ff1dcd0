#include "sim/liquid/energy.h"

#include "sim/core/parallel.h"
#include "sim/particles/velocity_modes.h"
#include "sim/transfer/reference.h"

namespace sim {

WeightSums weightSums(const Particles& particles, const Vec3& gravity)
{
    const auto weight = [&](std::size_t p) {
        const double mass = particles.mass[p];
        return WeightSums{-mass * (gravity.x() * particles.x[0][p] + gravity.y() * particles.x[1][p] + gravity.z() * particles.x[2][p]), mass};
    };
    return parallelReduce(particles.count, WeightSums{0.0, 0.0}, weight, [](WeightSums a, WeightSums b) {
        return WeightSums{a.potential + b.potential, a.mass + b.mass};
    });
}

double weightWork(const Particles& particles, const Vec3& gravity, double duration)
{
    double power = 0.0;
    for (int axis = 0; axis < kAxes; ++axis)
        for (int r = 0; r < particles.modeCount; ++r) {
            const double share = gravity[axis] * kMeanOfMode[r];  // most modes do not move the particle, few weights act along all axes
            if (share == 0.0) continue;
            const double* c = particles.mode(axis, r);
            power += share * parallelSum(particles.count, [&](std::size_t p) { return particles.mass[p] * c[p]; });
        }
    return duration * power;
}

namespace {

/// ⟨s_d, s_d⟩ of the 1-D factor of degree d (transfer/README.md, Modes), lengths in cells.
double squareNorm(const Basis1D& basis, int degree)
{
    double norm = 0.0;
    for (int n = 0; n < 3; ++n) {
        const double z = basis.z[n], s = degree == 0 ? 1.0 : degree == 1 ? z : z * z - basis.skew * z - 0.25;
        norm += basis.weight[n] * s * s;
    }
    return norm;
}

/// Orthogonal coefficients of one component of a particle whose modes are in a row.
Modes orthogonalModes(const Particles& particles, int axis, std::size_t row, const Stencil& stencil)
{
    Modes c{};
    for (int r = 0; r < particles.modeCount; ++r) c[r] = particles.mode(axis, r)[row];
    return toOrthogonal(stencil.basis, c);
}

}  // namespace

LiquidEnergies liquidEnergies(const Particles& particles, const BlockGrid& grid, const Vec3& gravity, const ParticleOrder* order)
{
    const auto rowOf = [&](std::size_t p) { return order ? static_cast<std::size_t>(order->source[p]) : p; };
    LiquidEnergies total;
    total.potential = weightSums(particles, gravity).potential;
    total.kinetic = parallelSum(particles.count, [&](std::size_t p) { return 0.5 * particles.mass[p] * particles.velocity(rowOf(p)).squaredNorm(); });
    if (particles.modeCount == 1) return total;
    total.modal = parallelSum(particles.count, [&](std::size_t p) {
        double square = 0.0;
        for (int axis = 0; axis < kAxes; ++axis) {
            const Stencil stencil(grid, axis, particles.position(p));
            const Modes c = orthogonalModes(particles, axis, rowOf(p), stencil);
            for (int r = 1; r < kMaxModes; ++r) {
                double norm = c[r] * c[r];
                for (int a = 0; a < kAxes; ++a) norm *= squareNorm(stencil.basis[a], kDegrees[r][a]);
                square += norm;
            }
        }
        return 0.5 * particles.mass[p] * square;
    });
    return total;
}

double strainEnergy(const Particles& particles, const BlockGrid& grid, const ParticleOrder* order)
{
    if (particles.modeCount == 1) return 0.0;
    return parallelSum(particles.count, [&](std::size_t p) {
        const std::size_t row = order ? static_cast<std::size_t>(order->source[p]) : p;
        Mat3 slope;  // in units of the cell
        for (int axis = 0; axis < kAxes; ++axis) {
            const Modes c = orthogonalModes(particles, axis, row, Stencil(grid, axis, particles.position(p)));
            slope.row(axis) = Vec3(c[1], c[2], c[3]);
        }
        return 0.5 * particles.mass[p] * kSplineVariance * (0.5 * (slope + slope.transpose())).squaredNorm();
    });
}

}  // namespace sim
