#include "sim/fabric/grid/fabric_particles.h"

#include "sim/core/parallel.h"
#include "sim/transfer/modes.h"
#include "sim/transfer/scatter_affine.h"

#include <cmath>

namespace sim {

FabricParticles::FabricParticles(const Fabric& fabric, const Settings& settings)
    : transfer_(settings.fabricTransfer),
      keepDt_(settings.transfer.keepDt),
      keepPerStep_(settings.transfer.keepPerStep),
      dampModes_(settings.transfer.dampModes)
{
    if (transfer_.method == TransferMethod::Flip) transfer_.method = TransferMethod::Apic;
    modes_ = transfer_.method == TransferMethod::Pic    ? 1
             : transfer_.method == TransferMethod::Apic ? 4
                                                        : transfer_.modes;
    particles_.modeCount = storedModes(modes_);
    grid_.dx = settings.cell;
    particles_.resize(fabric.vertexCount());
}

double FabricParticles::keptOver(double factor, double h) const
{
    return keepPerStep_ || factor == 1.0 ? factor : std::pow(factor, h / keepDt_);
}

void FabricParticles::load(std::span<const double> mass, std::span<const Vec3> elements, FabricState& state)
{
    const std::size_t n = state.x.size();
    if (state.modes.size() != kAxes * rows() * n) state.modes.assign(kAxes * rows() * n, 0.0);
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

/// Places of all points, in the order of the sort.
void FabricParticles::findPoints(std::size_t vertexCount)
{
    vertices_.clear();
    elements_.clear();
    vertexRow_.clear();
    elementRow_.clear();
    for (int block : order_.occupied) {
        const int* cells = order_.cells(block);
        for (int rank = 0; rank < kBlockCells; ++rank) {
            if (cells[rank] == cells[rank + 1]) continue;
            const int i = rank / (kBlockEdge * kBlockEdge), j = rank / kBlockEdge % kBlockEdge, k = rank % kBlockEdge;
            const int corner = tileIndex(i - 1, j - 1, k - 1);
            const std::size_t vertices = vertices_.size(), elements = elements_.size();
            for (int s = cells[rank]; s < cells[rank + 1]; ++s) {
                const std::size_t id = particles_.id[s];
                const bool isVertex = id < vertexCount;
                (isVertex ? vertices_ : elements_).id.push_back(static_cast<int>(isVertex ? id : id - vertexCount));
                (isVertex ? vertexRow_ : elementRow_).push_back(s);
            }
            if (vertices_.size() > vertices) vertices_.cells.push_back({corner, static_cast<int>(vertices)});
            if (elements_.size() > elements) elements_.cells.push_back({corner, static_cast<int>(elements)});
        }
        vertices_.blockBegin.push_back(static_cast<int>(vertices_.cells.size()));
        elements_.blockBegin.push_back(static_cast<int>(elements_.cells.size()));
    }
    place(vertexRow_, vertices_);
    place(elementRow_, elements_);
}

/// Ends the list of points and says where they are.
/// @param row  of each point: among the sorted particles
void FabricParticles::place(const std::vector<int>& row, BlockPoints& points) const
{
    points.cells.push_back({0, static_cast<int>(points.size())});
    for (AlignedArray<double>& x : points.inCell) x.resize(points.size() + kLanes);
    parallelFor(row.size(), 1024, [&](std::size_t i) {
        for (int a = 0; a < kAxes; ++a) {
            const double inCells = (particles_.x[a][row[i]] - grid_.origin[a]) * (1.0 / grid_.dx);
            points.inCell[a][i] = inCells - std::floor(inCells);
        }
    });
}

void FabricParticles::toFaces(std::span<const double> mass, std::span<const Vec3> elements, FabricState& state)
{
    load(mass, elements, state);
    sortParticles(particles_, grid_, nullptr, order_, ledger_);
    findPoints(state.x.size());
    if (differsFromTranslation(transfer_.xi, modes_))
        particlesToFacesAffine(particles_, order_, grid_, transfer_.xi, state.sinceGather, faces_);
    else
        particlesToFaces(particles_, order_, grid_, scatter_, faces_);
    faces_.velocity.resize(grid_.count());
    parallelFor(grid_.count(), 8, [&](std::size_t b) {
        const int block = static_cast<int>(b);
        for (int a = 0; a < kAxes; ++a) {
            const double *m = faces_.sums.block(block, FaceFields::kMass + a),
                         *p = faces_.sums.block(block, FaceFields::kMomentum + a);
            double* v = faces_.velocity.block(block, a);
            for (int c = 0; c < kBlockCells; ++c) v[c] = m[c] > 0.0 ? p[c] / m[c] : 0.0;
        }
    });
}

/// Model-fabric 3.6: the gradient's symmetric and antisymmetric part and the velocity by factors of their own. Modes
/// beyond the linear ones are deformation: they fade with the symmetric part.
void FabricParticles::damp(double h, std::size_t v, FabricState& state) const
{
    if (rows() > 1 && (modes_ <= 4 || dampModes_)) {
        const double stretch = keptOver(transfer_.keepStretch, h), rotation = keptOver(transfer_.keepRotation, h);
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
    const double lost = 1.0 - keptVelocity(h);
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
