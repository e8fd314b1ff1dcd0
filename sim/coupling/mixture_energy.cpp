#include "sim/coupling/mixture.h"

#include <cmath>

// Momentum and energy of the liquid on the faces that it shares with fabric.

namespace sim {

Vec3 Mixture::liquidMomentum(const SharedFaces&, const LiquidGrid& liquid) const
{
    Vec3 sum = Vec3::Zero();
    for (std::size_t b = 0; b < liquidBlock_.size(); ++b)
        for (int a = 0; a < kAxes; ++a) sum[a] += sumOver(liquid.faces.velocity, static_cast<int>(b), a, [](double m, double u) { return m * u; });
    return sum;
}

double Mixture::kinetic(const SharedFaces&, const BlockArray<double, 3>& velocity) const
{
    double sum = 0.0;
    const auto energy = [](double m, double u) { return 0.5 * m * u * u; };
    for (std::size_t b = 0; b < liquidBlock_.size(); ++b)
        for (int a = 0; a < kAxes; ++a) sum += sumOver(velocity, static_cast<int>(b), a, energy);
    return sum;
}

EnergyChanges Mixture::energyChanges(const SeparatedPhases&, const LiquidGrid& liquid, const BlockArray<double, 3>& before) const
{
    EnergyChanges sum;
    for (std::size_t n = 0; n < liquidBlock_.size(); ++n) {
        const int b = static_cast<int>(n), m = liquidBlock_[b];
        if (hasReaction()) {
            double byReaction = 0.0;
            for (std::size_t i = 0; i < Faces::kStride; ++i) byReaction += reaction_.block(b)[i] * onFaces_.velocity.block(b)[i];
            sum[EnergyChange::Suction] += byReaction;
            sum[EnergyChange::Drag] -= byReaction;
        }
        if (m == BlockGrid::kNone) continue;
        for (int a = 0; a < kAxes; ++a)
            for (int c = 0; c < kBlockCells; ++c) {
                const double mass = liquidMass_.block(b, a)[c];
                if (!(mass > 0.0)) continue;
                const double u = liquid.faces.velocity.block(m, a)[c], fabric = onFaces_.velocity.block(b, a)[c];
                const double push = pressureImpulse_.block(b, a)[c], onLiquid = liquidVolume_.block(b, a)[c] * push;
                const double onFabric = settings_.pressureOnFabric ? onFaces_.solid.block(b, a)[c] * push : 0.0;
                const double sucked = settings_.capillary ? suctionImpulse_.block(b, a)[c] : 0.0;
                sum[EnergyChange::Pressure] -= onLiquid * u + onFabric * fabric;
                sum[EnergyChange::Suction] += sucked * u;
                sum[EnergyChange::Drag] += drag_.block(b, a)[c] * (fabric - u) * u + onFabric * fabric;
                sum[EnergyChange::Implicit] -= 0.5 * mass * std::pow(u - before.block(m, a)[c], 2);
            }
    }
    return sum;
}

double Mixture::workOf(const SeparatedPhases&, const BlockArray<double, 3>& change, const LiquidGrid& liquid) const
{
    return parallelSum(liquidBlock_.size(), [&](std::size_t n) {
        const int b = static_cast<int>(n), m = liquidBlock_[b];
        double sum = 0.0;
        if (m == BlockGrid::kNone) return sum;
        for (int a = 0; a < kAxes; ++a)
            for (int c = 0; c < kBlockCells; ++c) {
                const double mobility = mobility_.block(b, a)[c];
                if (!(liquidMass_.block(b, a)[c] > 0.0 && mobility > 0.0)) continue;
                const double onFabric = settings_.pressureOnFabric ? onFaces_.solid.block(b, a)[c] * onFaces_.velocity.block(b, a)[c] : 0.0;
                sum += change.block(m, a)[c] / mobility * (liquidVolume_.block(b, a)[c] * liquid.faces.velocity.block(m, a)[c] + onFabric);
            }
        return sum;
    });
}

/// Σ of(mass, velocity) over the shared faces of a block.
template <class Of>
double Mixture::sumOver(const BlockArray<double, 3>& velocity, int block, int axis, Of&& of) const
{
    if (liquidBlock_[block] == BlockGrid::kNone) return 0.0;
    const double *mass = liquidMass_.block(block, axis), *u = velocity.block(liquidBlock_[block], axis);
    double sum = 0.0;
    for (int c = 0; c < kBlockCells; ++c) sum += of(mass[c], u[c]);
    return sum;
}

}  // namespace sim
