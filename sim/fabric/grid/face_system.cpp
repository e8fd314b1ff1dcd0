#include "sim/fabric/grid/face_system.h"

#include "sim/core/parallel.h"

#include <numeric>

namespace sim {

namespace {

/// Of a face that elements feel, relative to the mean mass of vertices [-].
constexpr double kLeastMass = 1.0e-9;

}  // namespace

FaceSystem::FaceSystem(const Fabric& fabric, VertexStiffness& stiffness, const ElementContact& contact)
    : fabric_(fabric), stiffness_(stiffness), contact_(contact)
{
    const std::size_t edges = fabric.edges.size(), padded = (edges + kLanes - 1) / kLanes * kLanes;
    inertia_.resize(padded);
    for (std::size_t e = 0; e < padded; ++e) inertia_[e] = e < edges ? fabric.edges.twistInertia[e] : 1.0;
    totalMass_ = std::accumulate(fabric.mass.begin(), fabric.mass.end(), 0.0);
    in_.resize(stiffness.unknowns().size);
    out_.resize(stiffness.unknowns().size);
}

void FaceSystem::takeUp(std::span<const double> absorbed)
{
    parallelFor(edges(), 4096, [&](std::size_t e) { inertia_[e] = twistInertia(fabric_, absorbed, e); });
}

void FaceSystem::begin(const FabricParticles& particles, double h, const FaceLoads* loads)
{
    particles_ = &particles;
    grid_ = &particles.grid();
    h_ = h;
    mass_.resize(blocks());
    parallelFor(blocks(), 8, [&](std::size_t b) {
        const int block = static_cast<int>(b);
        std::copy_n(particles.faces().sums.block(block, FaceFields::kMass), kAxes * kBlockCells, mass_.block(block));
        const int loaded = loads ? loads->grid.find(grid_->coords(block)) : BlockGrid::kNone;
        if (loaded == BlockGrid::kNone) return;
        for (int i = 0; i < kAxes * kBlockCells; ++i) mass_.block(block)[i] += loads->drag.block(loaded)[i];
    });
    for (FaceVector* v : {&residual_, &p_, &q_}) v->resize(blocks(), edges());
    rows_.find(mass_);
    onVertices_.resize(particles.vertices().size());
    findMissing();
}

void FaceSystem::assemble()
{
    findPushes();
    stiffness_.balanceTwist(inertia_, h_);
}

/// ∇u of all elements times the cell size.
void FaceSystem::gatherElements(const BlockArray<double, 3>& u, std::vector<Mat3>& gradients)
{
    const BlockPoints& elements = particles_->elements();
    onElements_.resize(elements.size());
    gradients.resize(contact_.size());
    forEachBlock(particles_->order(), *grid_, u, [&](std::size_t n, FaceTile& tile) {
        clearLight(n, tile);
        gatherGradients(tile, elements, n, onElements_);
        for (int s = elements.begin(n); s < elements.end(n); ++s)
            for (int i = 0; i < 9; ++i) gradients[elements.id[s]](i / 3, i % 3) = onElements_.of[i][s];
    });
}

/// Which faces elements feel. The stiffness of contact over a mass that is next to none would be an eigenvalue which round-off makes negative.
void FaceSystem::findMissing()
{
    counts_.resize(blocks());
    const double least = kLeastMass * totalMass_ / static_cast<double>(fabric_.vertexCount());
    const double* mass = mass_.block(0);
    parallelFor(mass_.size() / kBlockCells, 8, [&](std::size_t c) {
        for (std::size_t i = c * kBlockCells; i < (c + 1) * kBlockCells; ++i) counts_.block(0)[i] = mass[i] > least ? 1.0 : 0.0;
    });
    hasLight_.resize(particles_->order().occupied.size());
    forEachBlock(particles_->order(), *grid_, mass_, [&](std::size_t n, const FaceTile& tile) {
        const OccupiedBox box(particles_->order().cells(particles_->order().occupied[n]));
        bool any = false;
        for (const auto& field : tile.v)
            for (int z = box.low[2] - 1; z <= box.high[2] + 2; ++z)
                for (int y = box.low[1] - 1; y <= box.high[1] + 2; ++y)
                    for (int x = box.low[0] - 1; x <= box.high[0] + 2; ++x) {
                        const double m = field[tileIndex(x, y, z)];
                        any = any || (m > 0.0 && m <= least);
                    }
        hasLight_[n] = any;
    });
    gatherElements(counts_, missing_);
    constexpr double kRoundOff = 1.0e-12;
    for (Mat3& missing : missing_)
        if (missing.cwiseAbs().maxCoeff() <= kRoundOff) missing.setZero();
}

/// What elements do not feel, or do not push, in the tile of occupied block n becomes 0.
void FaceSystem::clearLight(std::size_t n, FaceTile& tile) const
{
    if (!hasLight_[n]) return;
    const ParticleOrder& order = particles_->order();
    const int block = order.occupied[n];
    forEachTileRow(*grid_, block, OccupiedBox(order.cells(block)), [&](int piece, int cell, int node, auto length) {
        for (int a = 0; a < kAxes; ++a)
            for (int i = 0; i < length; ++i) tile.v[a][node + i] *= counts_.block(piece, a)[cell + i];
    });
}

/// The pressed elements, and which of their pushes act on each vertex.
void FaceSystem::findPushes()
{
    const BlockPoints& elements = particles_->elements();
    pressedEdges_.assemble(contact_, stiffness_, elements, missing_, grid_->dx, 0);
    pressedFaces_.assemble(contact_, stiffness_, elements, missing_, grid_->dx, static_cast<int>(pressedEdges_.pushes()));
    const int none = static_cast<int>(pressedEdges_.pushes() + pressedFaces_.pushes());
    pushes_.resize(none);
    first_.assign(contact_.size(), none);
    forEachPressed([&](auto& pressed) { pressed.tellPushes(first_); });
    const BlockPoints& vertices = particles_->vertices();
    const std::vector<int>& begin = contact_.incidenceBegin();
    pushOf_.clear();
    pushBegin_.assign(1, 0);
    for (int v : vertices.id) {
        for (int i = begin[v]; i < begin[v + 1]; ++i) {
            const int at = contact_.incidence()[i], first = first_[at / 3];
            if (first != none) pushOf_.push_back(first + at % 3);
        }
        pushBegin_.push_back(static_cast<int>(pushOf_.size()));
    }
}

/// Velocities of the vertices into in_, gradients of the pressed elements.
void FaceSystem::gather(const BlockArray<double, 3>& u)
{
    const BlockPoints& vertices = particles_->vertices();
    forEachBlock(particles_->order(), *grid_, u, [&](std::size_t n, FaceTile& tile) {
        gatherValues(tile, vertices, n, onVertices_);
        for (int s = vertices.begin(n); s < vertices.end(n); ++s)
            stiffness_.set(in_, vertices.id[s], {onVertices_.of[0][s], onVertices_.of[1][s], onVertices_.of[2][s]});
        clearLight(n, tile);
        forEachPressed([&](auto& pressed) {
            gatherAlong<std::remove_reference_t<decltype(pressed)>::kDirections>(tile, pressed.points(), n, pressed.across(), pressed.carried());
        });
    });
}

/// Wᵀ out_ with the elements' pushes, and Gᵀ of what they give to the faces.
void FaceSystem::spread(FaceVector& q)
{
    const BlockPoints& vertices = particles_->vertices();
    sumOverBlocks(particles_->order(), *grid_, rows_, q.faces, [&](std::size_t n, FaceTile& tile) {
        for (int s = vertices.begin(n); s < vertices.end(n); ++s) {
            Vec3 sum = stiffness_.at(out_, vertices.id[s]);
            for (int i = pushBegin_[s]; i < pushBegin_[s + 1]; ++i) sum += pushes_[pushOf_[i]];
            for (int a = 0; a < kAxes; ++a) onVertices_.of[a][s] = sum[a];
        }
        forEachPressed([&](auto& pressed) {
            scatterAlong<std::remove_reference_t<decltype(pressed)>::kDirections>(pressed.points(), n, pressed.across(), pressed.carried(), tile);
        });
        clearLight(n, tile);
        scatterValues(vertices, n, onVertices_, tile);
    });
    forEachTwist([&](std::size_t e, int slot) { q.twist[e] = out_[slot]; });
}

AlignedArray<double>& FaceSystem::onVertices(const FaceVector& u)
{
    forEachTwist([&](std::size_t e, int slot) { in_[slot] = u.twist[e]; });
    gather(u.faces);
    return in_;
}

double FaceSystem::contactWork(const FaceVector& u)
{
    onVertices(u);
    out_.fill(0.0);
    const auto power = [&] {
        spread(q_);
        return forEachPack([&](auto isFace, std::size_t i, Pack& sum) { sum += u.pack(isFace, i) * q_.pack(isFace, i); });
    };
    forEachPressed([&](auto& pressed) { pressed.multiply(in_, pushes_); });
    const double byStiffness = power();
    forEachPressed([&](auto& pressed) { pressed.impulses(contact_, pushes_); });
    return h_ * power() - h_ * h_ * byStiffness;
}

void FaceSystem::multiply(const FaceVector& p, FaceVector& q)
{
    onVertices(p);
    finishProduct(p, q);
}

/// q = A p where twist follows: that of p becomes what leaves none in q. Returns p·q.
double FaceSystem::multiplyFollowed(FaceVector& p, FaceVector& q)
{
    gather(p.faces);
    stiffness_.followWithTwist(in_);
    forEachTwist([&](std::size_t e, int slot) { p.twist[e] = in_[slot]; });
    return finishProduct(p, q);
}

/// q = A p of a p that has been gathered; returns p·q.
double FaceSystem::finishProduct(const FaceVector& p, FaceVector& q)
{
    stiffness_.multiply(in_, out_);
    forEachPressed([&](auto& pressed) { pressed.multiply(in_, pushes_); });
    spread(q);
    const double h2 = h_ * h_;
    return forEachPack([&](auto isFace, std::size_t i, Pack& product) {
        const Pack m = mass(isFace, i), from = p.pack(isFace, i);
        Pack& to = q.pack(isFace, i);
        to = select(m > 0.0, m * from + h2 * to, broadcast(0.0));
        product += from * to;
    });
}

/// The twist of p: rates that take up what is left of its equations, faces at rest.
void FaceSystem::takeUpTwist(const FaceVector& residual, FaceVector& p)
{
    forEachTwist([&](std::size_t e, int slot) { in_[slot] = residual.twist[e]; });
    stiffness_.takeUpTwist(in_);
    forEachTwist([&](std::size_t e, int slot) { p.twist[e] = in_[slot]; });
}

void FaceSystem::impulses(FaceVector& q)
{
    q.resize(blocks(), edges());
    const AlignedArray<double>& gradient = stiffness_.gradient();
    for (std::size_t i = 0; i < out_.size(); ++i) out_[i] = -gradient[i];
    forEachPressed([&](auto& pressed) { pressed.impulses(contact_, pushes_); });
    spread(q);
    forEachPack([&](auto isFace, std::size_t i, Pack&) {
        const Pack m = mass(isFace, i);
        Pack& out = q.pack(isFace, i);
        out = select(m > 0.0, h_ * out, broadcast(0.0));
    });
}

void FaceSystem::gatherVertices(const BlockArray<double, 3>& u, std::span<Vec3> atVertices)
{
    const BlockPoints& vertices = particles_->vertices();
    forEachBlock(particles_->order(), *grid_, u, [&](std::size_t n, const FaceTile& tile) {
        gatherValues(tile, vertices, n, onVertices_);
        for (int s = vertices.begin(n); s < vertices.end(n); ++s)
            atVertices[vertices.id[s]] = {onVertices_.of[0][s], onVertices_.of[1][s], onVertices_.of[2][s]};
    });
}

void FaceSystem::findMotion(const BlockArray<double, 3>& u, FabricMotion& motion)
{
    motion.velocity.resize(fabric_.vertexCount());
    gatherVertices(u, motion.velocity);
    gatherElements(u, motion.gradient);
    parallelFor(contact_.size(), kElementsPerTask, [&](std::size_t e) {
        Mat3& gradient = motion.gradient[e];
        if (!missing_[e].isZero(0.0)) gradient -= contact_.mean(e, motion.velocity).asDiagonal() * missing_[e];
        gradient /= grid_->dx;
    });
}

}  // namespace sim
