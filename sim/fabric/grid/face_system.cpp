#include "sim/fabric/grid/face_system.h"

#include "sim/core/parallel.h"

#include <cmath>

namespace sim {

namespace {

constexpr std::size_t kElementsPerTask = 256, kVerticesPerTask = 512;

}  // namespace

FaceSystem::FaceSystem(const Fabric& fabric, const VertexStiffness& stiffness, const ElementContact& contact)
    : fabric_(fabric), stiffness_(stiffness), contact_(contact)
{
    const std::size_t edges = fabric.edges.size(), padded = (edges + kLanes - 1) / kLanes * kLanes;
    inertia_.resize(padded);
    perTwistSpeed_.resize(padded);
    for (std::size_t e = 0; e < padded; ++e) {
        inertia_[e] = e < edges ? fabric.edges.twistInertia[e] : 1.0;
        if (e >= edges) continue;
        const auto [a, b] = fabric.strands.radius[fabric.edges.strand[e]];
        perTwistSpeed_[e] = 0.5 * std::sqrt(a * a + b * b) / inertia_[e];  // the radius of gyration times the rate
    }
    in_.resize(stiffness.unknowns().size);
    out_.resize(stiffness.unknowns().size);
    isActive_.resize(contact.size());
    missing_.resize(contact.size());
    raw_.resize(contact.size());
    mean_.resize(contact.size());
    push_.resize(contact.size());
}

void FaceSystem::assemble(const FabricParticles& particles, double h)
{
    particles_ = &particles;
    grid_ = &particles.grid();
    h_ = h;
    mass_.resize(blocks());
    parallelFor(blocks(), 8, [&](std::size_t b) {
        const int block = static_cast<int>(b);
        std::copy_n(particles.faces().sums.block(block, FaceFields::kMass), kAxes * kBlockCells, mass_.block(block));
    });
    std::ranges::fill(isActive_, 0);
    for (int e : contact_.active()) isActive_[e] = 1;
    for (FaceVector* v : {&residual_, &z_, &p_, &q_, &inverse_}) v->resize(blocks(), edges());
    findActiveRows();
    findMissing();
    findDiagonal();
}

void FaceSystem::findActiveRows()
{
    rows_.clear();
    const double* mass = mass_.block(0);
    std::size_t faces = 0;
    double sum = 0.0;
    for (std::size_t i = 0; i < mass_.size(); i += kLanes) {
        bool any = false;
        for (int l = 0; l < kLanes; ++l) {
            any = any || mass[i + l] > 0.0;
            faces += mass[i + l] > 0.0;
            sum += mass[i + l];
        }
        if (any) rows_.push_back(static_cast<int>(i));
    }
    leastMass_ = faces > 0 ? kLeastMass * sum / static_cast<double>(faces) : 1.0;
}

/// Velocities of the vertices into in_, gradients of active elements (or all) into raw_.
void FaceSystem::gatherPoints(const BlockArray<double, 3>& u, bool all)
{
    const BlockPoints &vertices = particles_->vertices(), &elements = particles_->elements();
    forEachBlock(particles_->order(), *grid_, u, [&](std::size_t n, const FaceTile& tile) {
        const PointPlace* at = vertices.placesOf(n);
        for (int v : vertices.idsOf(n)) stiffness_.set(in_, v, interpolate(tile, PointWeights(*at++)));
        at = elements.placesOf(n);
        for (int e : elements.idsOf(n)) {
            if (all || isActive_[e]) raw_[e] = gradientAt(tile, PointWeights(*at));
            ++at;
        }
    });
}

void FaceSystem::findMissing()
{
    work_.resize(blocks());
    const double* mass = mass_.block(0);
    parallelFor(mass_.size() / kBlockCells, 8, [&](std::size_t c) {
        for (std::size_t i = c * kBlockCells; i < (c + 1) * kBlockCells; ++i)
            work_.block(0)[i] = mass[i] > 0.0 ? 1.0 : 0.0;
    });
    gatherPoints(work_, true);
    constexpr double kRoundOff = 1.0e-12;
    for (std::size_t e = 0; e < missing_.size(); ++e)
        missing_[e] = raw_[e].cwiseAbs().maxCoeff() > kRoundOff ? raw_[e] : Mat3(Mat3::Zero());
}

/// Gathered gradient of an element, faces without mass moving like the mean of its corners [1/s].
Mat3 FaceSystem::relative(std::size_t e) const
{
    const std::array<int, 3>& corners = contact_.corners(e);
    Vec3 mean = Vec3::Zero();
    for (int k = 0; k < 3; ++k)
        if (corners[k] >= 0) mean += contact_.shares(e)[k] * stiffness_.at(in_, corners[k]);
    return (raw_[e] - mean.asDiagonal() * missing_[e]) / grid_->dx;
}

/// Transpose of `relative`: what an element gives to its corners, and in raw_ to the faces.
void FaceSystem::pushCorners(std::size_t e, const ElementContact::Push& push, double sign)
{
    raw_[e] = sign / grid_->dx * push.onGrid;
    const Vec3 onMean = -raw_[e].cwiseProduct(missing_[e]).rowwise().sum();
    for (int k = 0; k < 3; ++k) push_[e][k] = sign * push.onCorners[k] + contact_.shares(e)[k] * onMean;
}

/// Wᵀ out_ with the active elements' pushes, and Gᵀ of what they give to the faces.
void FaceSystem::spread(FaceVector& q)
{
    const std::vector<int>& begin = contact_.incidenceBegin();
    parallelFor(fabric_.vertexCount(), kVerticesPerTask, [&](std::size_t v) {
        Vec3 sum = Vec3::Zero();
        for (int i = begin[v]; i < begin[v + 1]; ++i) {
            const int e = contact_.incidence()[i] / 3, k = contact_.incidence()[i] % 3;
            if (isActive_[e]) sum += push_[e][k];
        }
        stiffness_.add(out_, static_cast<int>(v), sum);
    });
    const BlockPoints &vertices = particles_->vertices(), &elements = particles_->elements();
    sumOverBlocks(particles_->order(), *grid_, q.faces, [&](std::size_t n, FaceTile& tile) {
        const PointPlace* at = vertices.placesOf(n);
        for (int v : vertices.idsOf(n)) distribute(PointWeights(*at++), stiffness_.at(out_, v), tile);
        at = elements.placesOf(n);
        for (int e : elements.idsOf(n)) {
            if (isActive_[e]) distributeGradient(PointWeights(*at), raw_[e], tile);
            ++at;
        }
    });
    const std::vector<int>& twistSlot = stiffness_.unknowns().twistSlot;
    for (std::size_t e = 0; e < edges(); ++e) q.twist[e] = out_[twistSlot[e]];
}

void FaceSystem::multiply(const FaceVector& p, FaceVector& q)
{
    const std::vector<int>& twistSlot = stiffness_.unknowns().twistSlot;
    for (std::size_t e = 0; e < edges(); ++e) in_[twistSlot[e]] = p.twist[e];
    gatherPoints(p.faces, false);
    stiffness_.multiply(in_, out_);
    const std::vector<int>& active = contact_.active();
    parallelFor(active.size(), kElementsPerTask, [&](std::size_t i) {
        const std::size_t e = active[i];
        std::array<Vec3, 3> u = {Vec3::Zero(), Vec3::Zero(), Vec3::Zero()};
        for (int k = 0; k < 3; ++k)
            if (contact_.corners(e)[k] >= 0) u[k] = stiffness_.at(in_, contact_.corners(e)[k]);
        pushCorners(e, contact_.hessian(e, relative(e), u), 1.0);
    });
    spread(q);
    const double h2 = h_ * h_;
    const double* mass = mass_.block(0);
    forEachPack([&](bool isFace, std::size_t i) {
        const Pack m = loadPack((isFace ? mass : inertia_.data()) + i);
        Pack& out = q.pack(isFace, i);
        out = select(m > 0.0, m * p.pack(isFace, i) + h2 * out, broadcast(0.0));
    });
}

void FaceSystem::impulses(FaceVector& q)
{
    q.resize(blocks(), edges());
    const AlignedArray<double>& gradient = stiffness_.gradient();
    for (std::size_t i = 0; i < out_.size(); ++i) out_[i] = -gradient[i];
    for (int e : contact_.active()) pushCorners(e, contact_.gradient(e), -1.0);
    spread(q);
    const double* mass = mass_.block(0);
    forEachPack([&](bool isFace, std::size_t i) {
        const Pack m = loadPack((isFace ? mass : inertia_.data()) + i);
        Pack& out = q.pack(isFace, i);
        out = select(m > 0.0, h_ * out, broadcast(0.0));
    });
}

/// inverse_ = 1 / (M + h² (Σ w² K_pp + Σ of contact)).
void FaceSystem::findDiagonal()
{
    stiffness_.diagonal(out_);
    const BlockPoints &vertices = particles_->vertices(), &elements = particles_->elements();
    const double perCell2 = 1.0 / (grid_->dx * grid_->dx), h2 = h_ * h_;
    sumOverBlocks(particles_->order(), *grid_, inverse_.faces, [&](std::size_t n, FaceTile& tile) {
        const PointPlace* at = vertices.placesOf(n);
        for (int v : vertices.idsOf(n)) distribute(PointWeights(*at++).squared(), stiffness_.at(out_, v), tile);
        at = elements.placesOf(n);
        for (int e : elements.idsOf(n)) {
            if (isActive_[e])
                for (int a = 0; a < kAxes; ++a)
                    distributeSquare(PointWeights(*at), a, perCell2 * contact_.diagonalForm(e, a), tile);
            ++at;
        }
    });
    const std::vector<int>& twistSlot = stiffness_.unknowns().twistSlot;
    for (std::size_t e = 0; e < edges(); ++e) inverse_.twist[e] = out_[twistSlot[e]];
    const double* mass = mass_.block(0);
    forEachPack([&](bool isFace, std::size_t i) {
        const Pack m = loadPack((isFace ? mass : inertia_.data()) + i);
        Pack& out = inverse_.pack(isFace, i);
        out = select(m > 0.0, 1.0 / (m + h2 * out), broadcast(0.0));
    });
}

void FaceSystem::elementGradients(const BlockArray<double, 3>& u, std::vector<Mat3>& gradients)
{
    gatherPoints(u, true);
    gradients.resize(contact_.size());
    parallelFor(contact_.size(), kElementsPerTask, [&](std::size_t e) { gradients[e] = relative(e); });
}

}  // namespace sim
