#include "sim/fabric/grid/fabric_particles.h"

#include "sim/core/parallel.h"
#include "sim/liquid/energy.h"
#include "sim/particles/velocity_modes.h"

#include <algorithm>
#include <cmath>

namespace sim {

FabricParticles::FabricParticles(const Fabric& fabric, const Settings& settings)
    : transfer_(settings.fabricTransfer),
      dampingDt_(settings.transfer.dampingDt),
      dampingPerStep_(settings.transfer.dampingPerStep),
      dampModes_(settings.transfer.dampModes)
{
    if (transfer_.method == TransferMethod::Flip) transfer_.method = TransferMethod::Apic;
    modes_ = transfer_.method == TransferMethod::Pic    ? 1
             : transfer_.method == TransferMethod::Apic ? 4
                                                        : std::min(transfer_.modes, FabricTransferSettings::kMostModes);
    particles_.modeCount = storedModes(modes_);
    grid_.dx = settings.cell;
    particles_.resize(fabric.vertexCount());
}

double FabricParticles::retainedOver(double damping, double h) const
{
    const double kept = 1.0 - damping;
    return dampingPerStep_ || kept == 1.0 ? kept : std::pow(kept, h / dampingDt_);
}

void FabricParticles::load(std::span<const double> mass, std::span<const Vec3> elements, FabricState& state)
{
    const std::size_t n = state.x.size();
    if (state.gridSolver.modes.size() != kAxes * rows() * n) state.gridSolver.modes.assign(kAxes * rows() * n, 0.0);
    particles_.resize(n + elements.size());
    parallelFor(n + elements.size(), 1024, [&](std::size_t p) {
        const Vec3& x = p < n ? state.x[p] : elements[p - n];
        particles_.id[p] = static_cast<std::uint32_t>(p);
        particles_.mass[p] = p < n ? mass[p] : 0.0;
        for (int a = 0; a < kAxes; ++a) {
            particles_.x[a][p] = x[a];
            double mean = 0.0;
            for (int r = 0; r < rows(); ++r) {
                const double c = p < n ? modeOf(state, a, r, p) : 0.0;
                particles_.mode(a, r)[p] = c;
                mean += kMeanOfMode[r] * c;
            }
            if (p < n) particles_.mode(a, 0)[p] += state.v[p][a] - mean;
        }
    });
}

void FabricParticles::toFaces(std::span<const double> mass, std::span<const Vec3> elements, FabricState& state)
{
    load(mass, elements, state);
    sortParticles(particles_, grid_, nullptr, order_, nullptr);
    const auto vertices = static_cast<std::uint32_t>(state.x.size());
    vertices_.find(particles_, order_, grid_, 0, vertices);
    elements_.find(particles_, order_, grid_, vertices, vertices + static_cast<std::uint32_t>(elements.size()));
    const SortedParticles sorted{particles_, order_, grid_};
    if (differsFromTranslation(transfer_.xi, modes_)) {
        const LiquidEnergies own = liquidEnergies(particles_, grid_, Vec3::Zero(), &order_);
        particlesToFacesBounded(sorted, transfer_.xi, state.gridSolver.sinceGather, own.kinetic + own.modal, bounded_, faces_);
    } else particlesToFaces(sorted, scatter_, faces_);
    faces_.velocity.resize(grid_.count());
    parallelFor(grid_.count(), 8, [&](std::size_t b) {
        const int block = static_cast<int>(b);
        for (int a = 0; a < kAxes; ++a) {
            const double *m = faces_.sums.block(block, FaceFields::kMass + a), *p = faces_.sums.block(block, FaceFields::kMomentum + a);
            double* v = faces_.velocity.block(block, a);
            for (int c = 0; c < kBlockCells; ++c) v[c] = m[c] > 0.0 ? p[c] / m[c] : 0.0;
        }
    });
}

/// Damps the velocity gradient's symmetric and antisymmetric parts and the velocity, each by a factor of its own (fabric/grid/README.md, Transfers of
/// the fabric). Modes beyond the linear ones are deformation: they fade with the symmetric part.
void FabricParticles::damp(double h, std::size_t v, FabricState& state) const
{
    if (rows() > 1 && (modes_ <= 4 || dampModes_)) {
        const double stretch = retainedOver(transfer_.stretchDamping, h), rotation = retainedOver(transfer_.rotationDamping, h);
        for (int a = 0; a < kAxes; ++a)
            for (int b = 0; b <= a; ++b) {
                double &one = modeOf(state, a, 1 + b, v), &other = modeOf(state, b, 1 + a, v);
                const double even = 0.5 * stretch * (one + other), odd = 0.5 * rotation * (one - other);
                one = even + odd;
                other = even - odd;
            }
        for (int a = 0; a < kAxes; ++a)
            for (int r = 4; r < rows(); ++r) {
                double& c = modeOf(state, a, r, v);
                modeOf(state, a, 0, v) += (1.0 - stretch) * kMeanOfMode[r] * c;
                c *= stretch;
            }
    }
    const double lost = 1.0 - retainedVelocity(h);
    for (int a = 0; a < kAxes; ++a) {
        double mean = 0.0;
        for (int r = 0; r < rows(); ++r) mean += kMeanOfMode[r] * modeOf(state, a, r, v);
        modeOf(state, a, 0, v) -= lost * mean;
        state.v[v][a] = 0.0;
        for (int r = 0; r < rows(); ++r) state.v[v][a] += kMeanOfMode[r] * modeOf(state, a, r, v);
    }
}

void FabricParticles::toVertices(double h, FabricState& state)
{
    GatherSettings settings;
    settings.modes = modes_;
    facesToParticles(faces_, order_, grid_, settings, gather_, particles_);
    parallelFor(particles_.count, 1024, [&](std::size_t s) {
        const std::size_t v = particles_.id[s];
        if (v >= state.x.size()) return;
        for (int a = 0; a < kAxes; ++a)
            for (int r = 0; r < rows(); ++r) modeOf(state, a, r, v) = particles_.mode(a, r)[s];
        damp(h, v, state);
    });
}

}  // namespace sim
