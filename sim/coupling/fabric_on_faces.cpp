#include "sim/coupling/fabric_on_faces.h"

#include "sim/core/parallel.h"
#include "sim/coupling/yarn_flow.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>

namespace sim {

namespace {

constexpr double kRoundOff = 1.0e-12;  ///< relative [-]
/// Distances (LiquidAround::Found) of a flat surface that the vertex is on, and that is a tenth of a cell away: up to the first liquid drags fabric
/// fully, from the second on not at all [cells]. Below those of uptake, so that fabric that is carried ahead of liquid drinks from it.
constexpr double kFullDrag = 0.56, kNoDrag = 0.63;

/// Normal to a triangle, as long as twice its area [cm^2].
Vec3 doubleArea(const std::vector<Vec3>& x, const Vec3i& f) { return (x[f[1]] - x[f[0]]).cross(x[f[2]] - x[f[0]]); }

bool isUniformIn(const std::vector<double>& all)
{
    return std::ranges::all_of(all, [&](double one) { return one == all[0]; });
}

/// Numbers of the elements at each vertex.
template <class Corners>
void sortByVertex(std::size_t vertices, const std::vector<Corners>& elements, std::vector<int>& begin, std::vector<int>& at)
{
    begin.assign(vertices + 1, 0);
    for (const Corners& e : elements)
        for (int v : e) ++begin[v + 1];
    for (std::size_t v = 0; v < vertices; ++v) begin[v + 1] += begin[v];
    at.resize(begin.back());
    std::vector<int> next(begin.begin(), begin.end() - 1);
    for (std::size_t e = 0; e < elements.size(); ++e)
        for (int v : elements[e]) at[next[v]++] = static_cast<int>(e);
}

}  // namespace

FabricOnFaces::FabricOnFaces(const Fabric& fabric, double liquidDensity) : fabric_(fabric), liquidDensity_(liquidDensity)
{
    const std::size_t n = fabric.vertexCount();
    sortByVertex(n, fabric.edges.vertices, edgesBegin_, edgesAt_);
    sortByVertex(n, fabric.faces.vertices, facesBegin_, facesAt_);
    squaresOf_.resize(n);
    envelopeOf_.resize(n);
    restLength_.resize(n);
    restArea_.resize(n);
    massOf_.resize(n);
    solidOf_.resize(n);
    for (std::size_t v = 0; v < n; ++v) {
        fibresOf_.push_back(fabric.materials[fabric.vertexMaterial[v]].volumeFraction * fabric.volume[v]);
        double yarn = 0.0;  // volume [cm^3]
        for (int i = edgesBegin_[v]; i < edgesBegin_[v + 1]; ++i) {
            const auto [a, b] = fabric.strands.radius[fabric.edges.strand[edgesAt_[i]]];
            yarn += 0.5 * kPi * a * b * fabric.edges.restLength[edgesAt_[i]];
            restLength_[v] += fabric.edges.restLength[edgesAt_[i]];
        }
        for (int i = facesBegin_[v]; i < facesBegin_[v + 1]; ++i) restArea_[v] += doubleArea(fabric.rest, fabric.faces.vertices[facesAt_[i]]).norm();
        shapeOf_.push_back(facesBegin_[v] == facesBegin_[v + 1] ? 1.0 : std::min(1.0, yarn / fabric.volume[v]));
    }
    isOneShape_ = isUniformIn(shapeOf_);
    hasYarns_ = fabric.edges.size() > 0;
    const double first = fibresOf_[0] / fabric.mass[0];
    bool isUniform = true;
    for (std::size_t v = 0; v < n; ++v) isUniform &= std::abs(fibresOf_[v] / fabric.mass[v] - first) < kRoundOff * first;
    if (isUniform) fibresPerMass_ = first;
}

/// Yarns as liquid that flows around them meets them.
void FabricOnFaces::findYarns()
{
    diameterOf_ = yarnDiameters(fabric_);
    constrictionOf_ = constrictions(fabric_, diameterOf_);
    isOneDiameter_ = isUniformIn(diameterOf_);
    isOneNarrowing_ = isUniformIn(constrictionOf_);
}

/// Squares of the components of tangents and normals, weighted by lengths and areas; and by how much these have grown.
void FabricOnFaces::findDirections(const FabricState& state)
{
    const auto normalized = [](const Vec3& sum) { return sum.sum() > 0.0 ? Vec3(sum / sum.sum()) : Vec3::Constant(1.0 / 3.0).eval(); };
    parallelFor(vertices_->count(), kGrain, [&](std::size_t s) {
        const std::size_t v = vertices_->particles.id[s];
        Vec3 tangents = Vec3::Zero(), normals = Vec3::Zero();
        double length = 0.0, area = 0.0;
        for (int i = edgesBegin_[v]; i < edgesBegin_[v + 1]; ++i) {
            const Vec2i& e = fabric_.edges.vertices[edgesAt_[i]];
            const Vec3 t = state.x[e[1]] - state.x[e[0]];
            if (t.norm() > 0.0) tangents += t.cwiseAbs2() / t.norm();
            length += t.norm();
        }
        for (int i = facesBegin_[v]; i < facesBegin_[v + 1]; ++i) {
            const Vec3i& f = fabric_.faces.vertices[facesAt_[i]];
            const Vec3 across = doubleArea(state.x, f);
            if (across.norm() > 0.0) normals += across.cwiseAbs2() / across.norm();
            area += across.norm();
        }
        double stretch = 0.0;  // of yarns along, of cloth in its plane: sections and thickness stay
        if (shapeOf_[v] > 0.0) stretch += shapeOf_[v] * length / restLength_[v];
        if (shapeOf_[v] < 1.0) stretch += (1.0 - shapeOf_[v]) * area / restArea_[v];
        envelopeOf_[v] = stretch * fabric_.volume[v];
        squaresOf_[v] = shapeOf_[v] * normalized(tangents) + (1.0 - shapeOf_[v]) * normalized(normals);
    });
}

/// Mass-weighted sums become means.
void FabricOnFaces::divideByMass(BlockArray<double, 3>& u) const
{
    parallelFor(grid().count(), 8, [&](std::size_t b) {
        const double* m = mass.block(static_cast<int>(b));
        double* value = u.block(static_cast<int>(b));
        for (std::size_t i = 0; i < BlockArray<double, 3>::kStride; ++i) value[i] = m[i] > 0.0 ? value[i] / m[i] : 0.0;
    });
}

void FabricOnFaces::spreadVelocity(const FabricState& state)
{
    scatter([&](int v) { return Vec3(massOf_[v] * state.v[v]); }, velocity);
    divideByMass(velocity);
}

void FabricOnFaces::takeVelocity(const FabricFaces& faces)
{
    parallelFor(grid().count(), 8, [&](std::size_t i) {
        const int b = static_cast<int>(i), from = faces.grid.find(grid().coords(b));
        if (from == BlockGrid::kNone) return;  // fabric is in blocks beside it only
        std::copy_n(faces.velocity.block(from), kAxes * kBlockCells, velocity.block(b));
    });
}

void FabricOnFaces::spread(SortedVertices& vertices, const FabricState& state, std::span<const double> distance)
{
    vertices_ = &vertices;
    const std::size_t n = vertices.count();
    Particles& particles = vertices.particles;
    points_.find(particles, vertices.order, vertices.grid, 0, static_cast<std::uint32_t>(fabric_.vertexCount()));
    onPoints_.resize(n);
    parallelFor(n, kGrain, [&](std::size_t s) {
        const std::size_t v = particles.id[s];
        particles.mass[s] = massOf_[v] = fabric_.mass[v] + state.absorbed[v];
        solidOf_[v] = fibresOf_[v] + state.absorbed[v] / liquidDensity_;
    });
    for (int a = 0; a < kAxes; ++a) {
        double* mode = particles.mode(a, 0);
        parallelFor(n, kGrain, [&](std::size_t s) { mode[vertices.order.source[s]] = state.v[particles.id[s]][a]; });
    }
    particlesToFaces({particles, vertices.order, vertices.grid}, scatter_, sums_);
    for (BlockArray<double, 3>* u : {&mass, &velocity, &fibres, &envelope, &touched, &diameter, &constriction, &solid, &shape, &squares})
        u->resize(grid().count());
    parallelFor(grid().count(), 8, [&](std::size_t i) {
        const int b = static_cast<int>(i);
        std::copy_n(sums_.sums.block(b, FaceFields::kMass), kAxes * kBlockCells, mass.block(b));
        std::copy_n(sums_.sums.block(b, FaceFields::kMomentum), kAxes * kBlockCells, velocity.block(b));
    });
    rows_.find(mass);
    findDirections(state);
    divideByMass(velocity);
    scatter([&](int v) { return Vec3(massOf_[v] * squaresOf_[v]); }, squares);
    divideByMass(squares);
    findVolumes(state);
    if (!distance.empty()) {
        scatter([&](int v) { return Vec3::Constant(envelopeOf_[v]); }, envelope);
        scatter([&](int v) { return Vec3::Constant(envelopeOf_[v] * wettedPart(distance[v], kFullDrag, kNoDrag)); }, touched);
    }
    averageOverMass(shapeOf_, isOneShape_, shape);
    if (!distance.empty() && hasYarns_) {
        if (diameterOf_.empty()) findYarns();
        averageOverMass(diameterOf_, isOneDiameter_, diameter);
        averageOverMass(constrictionOf_, isOneNarrowing_, constriction);
    }
    findHeld(state);
}

void FabricOnFaces::findHeld(const FabricState& state)
{
    held.resize(grid().count());
    scatter([&](int v) { return Vec3(massOf_[v] * state.held[v]); }, held);
    divideByMass(held);
}

/// Mean over the mass on each face.
void FabricOnFaces::averageOverMass(const std::vector<double>& ofVertex, bool isUniform, BlockArray<double, 3>& mean)
{
    if (!isUniform) {
        scatter([&](int v) { return Vec3::Constant(massOf_[v] * ofVertex[v]); }, mean);
        divideByMass(mean);
        return;
    }
    parallelFor(grid().count(), 8, [&](std::size_t b) { std::fill_n(mean.block(static_cast<int>(b)), BlockArray<double, 3>::kStride, ofVertex[0]); });
}

/// Volumes of fibres and of what is absorbed, without a pass over vertices where masses tell: in dry fabric, and where all is of one density.
void FabricOnFaces::findVolumes(const FabricState& state)
{
    const std::size_t n = vertices_->count();
    const bool isWet = parallelMax(n, [&](std::size_t s) { return state.absorbed[vertices_->particles.id[s]]; }) > 0.0;
    if (isWet) scatter([&](int v) { return Vec3::Constant(state.absorbed[v] / liquidDensity_); }, solid);
    if (!fibresPerMass_) scatter([&](int v) { return Vec3::Constant(fibresOf_[v]); }, fibres);
    parallelFor(grid().count(), 8, [&](std::size_t i) {
        const int b = static_cast<int>(i);
        const double* m = mass.block(b);
        double *fibre = fibres.block(b), *volume = solid.block(b);
        for (std::size_t c = 0; c < BlockArray<double, 3>::kStride; ++c) {
            if (!(m[c] > 0.0)) continue;
            const double absorbed = isWet ? volume[c] : 0.0;
            if (fibresPerMass_) fibre[c] = *fibresPerMass_ * (m[c] - liquidDensity_ * absorbed);
            volume[c] = fibre[c] + absorbed;
        }
    });
}

}  // namespace sim
