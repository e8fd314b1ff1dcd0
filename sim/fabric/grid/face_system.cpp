#include "sim/fabric/grid/face_system.h"

#include "sim/core/parallel.h"

#include <numeric>

namespace sim {

namespace {

/// Least mass of a face that elements feel, relative to the mean mass of vertices [-].
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

void FaceSystem::setAbsorbed(std::span<const double> absorbed)
{
    parallelFor(edges(), 4096, [&](std::size_t e) { inertia_[e] = twistInertia(fabric_, absorbed, e); });
}

FaceSystem::Begun FaceSystem::begin(const FabricParticles& particles, double h, const FaceLoads* loads)
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
    findMissingParts();
    return Begun();
}

void FaceSystem::assemble(const Begun&, const VertexStiffness::Assembled&, const ElementContact::Assembled&)
{
    findNodalForces();
    stiffness_.factorTwist(inertia_, h_);
}

/// ∇u of all elements times the cell size.
void FaceSystem::gatherElements(const BlockArray<double, 3>& u, std::vector<Mat3>& gradients)
{
    const BlockPoints& elements = particles_->elements();
    onElements_.resize(elements.size());
    gradients.resize(contact_.size());
    forEachBlock(particles_->order(), *grid_, u, [&](std::size_t n, FaceTile& tile) {
        clearSmallMasses(n, tile);
        gatherGradients(tile, elements, n, onElements_);
        for (int s = elements.begin(n); s < elements.end(n); ++s)
            for (int i = 0; i < 9; ++i) gradients[elements.id[s]](i / 3, i % 3) = onElements_.of[i][s];
    });
}

/// Which faces elements feel. The stiffness of contact over a mass that is next to none would be an eigenvalue which round-off makes negative.
void FaceSystem::findMissingParts()
{
    actsOnElements_.resize(blocks());
    const double least = kLeastMass * totalMass_ / static_cast<double>(fabric_.vertexCount());
    const double* mass = mass_.block(0);
    parallelFor(mass_.size() / kBlockCells, 8, [&](std::size_t c) {
        for (std::size_t i = c * kBlockCells; i < (c + 1) * kBlockCells; ++i) actsOnElements_.block(0)[i] = mass[i] > least ? 1.0 : 0.0;
    });
    hasSmallMasses_.resize(particles_->order().occupied.size());
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
        hasSmallMasses_[n] = any;
    });
    gatherElements(actsOnElements_, missing_);
    constexpr double kRoundOff = 1.0e-12;
    for (Mat3& missing : missing_)
        if (missing.cwiseAbs().maxCoeff() <= kRoundOff) missing.setZero();
}

/// Sets faces with too little mass to act on elements to 0 in the tile of occupied block n.
void FaceSystem::clearSmallMasses(std::size_t n, FaceTile& tile) const
{
    if (!hasSmallMasses_[n]) return;
    const ParticleOrder& order = particles_->order();
    const int block = order.occupied[n];
    forEachTileRow(*grid_, block, OccupiedBox(order.cells(block)), [&](int piece, int cell, int node, auto length) {
        for (int a = 0; a < kAxes; ++a)
            for (int i = 0; i < length; ++i) tile.v[a][node + i] *= actsOnElements_.block(piece, a)[cell + i];
    });
}

/// Assembles the active elements, and lists which of their nodal forces act on each vertex.
void FaceSystem::findNodalForces()
{
    const BlockPoints& elements = particles_->elements();
    activeEdges_.assemble(contact_, stiffness_, elements, missing_, grid_->dx, 0);
    activeFaces_.assemble(contact_, stiffness_, elements, missing_, grid_->dx, static_cast<int>(activeEdges_.forceCount()));
    const int none = static_cast<int>(activeEdges_.forceCount() + activeFaces_.forceCount());
    nodalForces_.resize(none);
    first_.assign(contact_.size(), none);
    forEachActive([&](auto& active) { active.listFirstForces(first_); });
    const BlockPoints& vertices = particles_->vertices();
    const std::vector<int>& begin = contact_.incidenceBegin();
    forceOf_.clear();
    forceBegin_.assign(1, 0);
    for (int v : vertices.id) {
        for (int i = begin[v]; i < begin[v + 1]; ++i) {
            const int at = contact_.incidence()[i], first = first_[at / 3];
            if (first != none) forceOf_.push_back(first + at % 3);
        }
        forceBegin_.push_back(static_cast<int>(forceOf_.size()));
    }
}

/// Interpolates u: velocities of the vertices into in_, rates of the directions into the active elements.
void FaceSystem::gather(const BlockArray<double, 3>& u)
{
    const BlockPoints& vertices = particles_->vertices();
    forEachBlock(particles_->order(), *grid_, u, [&](std::size_t n, FaceTile& tile) {
        gatherValues(tile, vertices, n, onVertices_);
        for (int s = vertices.begin(n); s < vertices.end(n); ++s)
            stiffness_.set(in_, vertices.id[s], {onVertices_.of[0][s], onVertices_.of[1][s], onVertices_.of[2][s]});
        clearSmallMasses(n, tile);
        forEachActive([&](auto& active) {
            gatherAlong<std::remove_reference_t<decltype(active)>::kDirections>(tile, active.points(), n, active.across(), active.directionRates());
        });
    });
}

/// q = Wᵀ (out_ + nodal forces) + Gᵀ stresses, on the faces and on twist.
void FaceSystem::spread(FaceVector& q)
{
    const BlockPoints& vertices = particles_->vertices();
    sumOverBlocks(particles_->order(), *grid_, rows_, q.faces, [&](std::size_t n, FaceTile& tile) {
        for (int s = vertices.begin(n); s < vertices.end(n); ++s) {
            Vec3 sum = stiffness_.at(out_, vertices.id[s]);
            for (int i = forceBegin_[s]; i < forceBegin_[s + 1]; ++i) sum += nodalForces_[forceOf_[i]];
            for (int a = 0; a < kAxes; ++a) onVertices_.of[a][s] = sum[a];
        }
        forEachActive([&](auto& active) {
            scatterAlong<std::remove_reference_t<decltype(active)>::kDirections>(active.points(), n, active.across(), active.stresses(), tile);
        });
        clearSmallMasses(n, tile);
        scatterValues(vertices, n, onVertices_, tile);
    });
    forEachTwist([&](std::size_t e, int slot) { q.twist[e] = out_[slot]; });
}

AlignedArray<double>& FaceSystem::vertexVelocities(const FaceVector& u)
{
    forEachTwist([&](std::size_t e, int slot) { in_[slot] = u.twist[e]; });
    gather(u.faces);
    return in_;
}

double FaceSystem::contactWork(const FaceVector& u)
{
    vertexVelocities(u);
    out_.fill(0.0);
    const auto power = [&] {
        spread(q_);
        return forEachPack([&](auto isFace, std::size_t i, Pack& sum) { sum += u.pack(isFace, i) * q_.pack(isFace, i); });
    };
    forEachActive([&](auto& active) { active.multiply(in_, nodalForces_); });
    const double byStiffness = power();
    forEachActive([&](auto& active) { active.impulses(contact_, nodalForces_); });
    return h_ * power() - h_ * h_ * byStiffness;
}

void FaceSystem::multiply(const FaceVector& p, FaceVector& q)
{
    vertexVelocities(p);
    completeProduct(p, q);
}

/// Product with the Schur complement of A in which twist is eliminated: sets the twist of p to the value that leaves none in q = A p.
/// Returns p·q.
double FaceSystem::applySchurComplement(FaceVector& p, FaceVector& q)
{
    gather(p.faces);
    stiffness_.backSubstituteTwist(in_);
    forEachTwist([&](std::size_t e, int slot) { p.twist[e] = in_[slot]; });
    return completeProduct(p, q);
}

/// q = A p of a p that has been gathered; returns p·q.
double FaceSystem::completeProduct(const FaceVector& p, FaceVector& q)
{
    stiffness_.multiply(in_, out_);
    forEachActive([&](auto& active) { active.multiply(in_, nodalForces_); });
    spread(q);
    const double h2 = h_ * h_;
    return forEachPack([&](auto isFace, std::size_t i, Pack& product) {
        const Pack m = mass(isFace, i), from = p.pack(isFace, i);
        Pack& to = q.pack(isFace, i);
        to = select(m > 0.0, m * from + h2 * to, broadcast(0.0));
        product += from * to;
    });
}

/// Solves the equations of twist for this residual with the faces at rest; the rates become the twist of p.
void FaceSystem::solveTwist(const FaceVector& residual, FaceVector& p)
{
    forEachTwist([&](std::size_t e, int slot) { in_[slot] = residual.twist[e]; });
    stiffness_.solveTwist(in_);
    forEachTwist([&](std::size_t e, int slot) { p.twist[e] = in_[slot]; });
}

void FaceSystem::impulses(FaceVector& q)
{
    q.resize(blocks(), edges());
    const AlignedArray<double>& gradient = stiffness_.gradient();
    for (std::size_t i = 0; i < out_.size(); ++i) out_[i] = -gradient[i];
    forEachActive([&](auto& active) { active.impulses(contact_, nodalForces_); });
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

void FaceSystem::findMotion(const Begun&, const BlockArray<double, 3>& u, FabricMotion& motion)
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
