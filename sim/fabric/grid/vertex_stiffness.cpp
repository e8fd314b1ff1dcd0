#include "sim/fabric/grid/vertex_stiffness.h"

#include "sim/core/parallel.h"
#include "sim/fabric/pins.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace sim {

VertexStiffness::VertexStiffness(const Fabric& fabric, const FabricSettings& settings)
    : fabric_(fabric),
      rods_(fabric, restState(fabric), settings),
      shells_(fabric, settings),
      unknowns_(fabric, rods_.layout(), shells_),
      cloth_(shells_.matrix()),
      restReference_(restState(fabric).reference)
{
    strands_.resize(rods_.layout());
    for (AlignedArray<double>* u : {&gradient_, &reached_, &product_}) u->resize(unknowns_.size);
    clothIn_.resize(4 * shells_.vertices().size());
    findShared();
    findPinStiffness(fabric);
}

void VertexStiffness::findShared()
{
    const StrandLayout& layout = rods_.layout();
    for (const StrandLayout::Group& group : layout.groups)
        for (int j = 0; j < group.vertices; ++j)
            for (int l = 0; l < kLanes; ++l) {
                const int v = layout.vertex[group.firstVertex + j][l], slot = (group.firstRow + 4 * j) * kLanes + l;
                if (v >= 0 && unknowns_.slot[v] != slot) shared_.push_back({slot, unknowns_.slot[v]});
            }
}

void VertexStiffness::findPinStiffness(const Fabric& fabric)
{
    for (int v : fabric.pins.vertex) {
        const FabricMaterial& m = fabric.materials[fabric.vertexMaterial[v]];
        pinStiffness_.push_back(m.young * m.pinStiffness * std::cbrt(fabric.volume[v]));
    }
    for (std::size_t e = 0; e < fabric.edges.size(); ++e) {
        if (!fabric.edges.twistHeld[e]) continue;
        const int strand = fabric.edges.strand[e];
        const FabricMaterial& m = fabric.materials[fabric.strands.material[strand]];
        const auto [a, b] = fabric.strands.radius[strand];
        heldEdges_.push_back(static_cast<int>(e));
        heldStiffness_.push_back(m.shear() * m.pinStiffness * 0.25 * kPi * a * b * (a * a + b * b) / fabric.edges.restLength[e]);
    }
}

/// What shared vertices have in other strands goes to where they are at home.
void VertexStiffness::addToOwners(AlignedArray<double>& u) const
{
    for (const Shared& s : shared_)
        for (int a = 0; a < kAxes; ++a) {
            u[s.ownerSlot + a * kLanes] += u[s.slot + a * kLanes];
            u[s.slot + a * kLanes] = 0.0;
        }
}

/// The transpose: shared vertices in all their strands.
void VertexStiffness::copyFromOwners(AlignedArray<double>& u) const
{
    for (const Shared& s : shared_)
        for (int a = 0; a < kAxes; ++a) u[s.slot + a * kLanes] = u[s.ownerSlot + a * kLanes];
}

/// body(g, rows of strand group g in u), in parallel.
void VertexStiffness::forEachGroup(AlignedArray<double>& u, auto&& body) const
{
    const std::vector<StrandLayout::Group>& groups = rods_.layout().groups;
    parallelFor(groups.size(), [&](std::size_t g) { body(g, reinterpret_cast<Pack*>(u.data()) + groups[g].firstRow); });
}

void VertexStiffness::findPins(const FabricState& state, double end)
{
    const std::vector<Vec3> targets = pinTargets(fabric_, end);
    for (std::size_t i = 0; i < targets.size(); ++i) {
        const int v = fabric_.pins.vertex[i];
        springs_.push_back({{v, v, v}, {1.0, 0.0, 0.0}, pinStiffness_[i] * Mat3::Identity(), pinStiffness_[i] * (state.x[v] - targets[i])});
    }
    heldTorque_.resize(heldEdges_.size());
    for (std::size_t i = 0; i < heldEdges_.size(); ++i)
        heldTorque_[i] = heldStiffness_[i] * (state.theta[heldEdges_[i]] - heldAngle(fabric_, restReference_, end, state, heldEdges_[i]));
}

/// Assembles gradient and Hessian of the material's internal forces.
void VertexStiffness::assembleInternal(const FabricState& at, double h)
{
    gradient_.fill(0.0);
    if (!rods_.empty()) step_->rods.forces(at, h, packsOf(gradient_), &strands_);
    if (!shells_.empty()) {
        cloth_.clear();
        step_->shells.forces(at.x, h, unknowns_.slot, gradient_, &cloth_);
    }
    addToOwners(gradient_);
}

/// Adds the forces of pins and obstacles at the state to the gradient.
void VertexStiffness::addConstraints()
{
    for (const Spring& s : springs_) addToPoint(gradient_, s, s.gradient);
    for (std::size_t i = 0; i < heldEdges_.size(); ++i) gradient_[unknowns_.twistSlot[heldEdges_[i]]] += heldTorque_[i];
}

VertexStiffness::Assembled VertexStiffness::assemble(const FabricState& state, double t, double h, std::span<const ObstacleContact> obstacles,
                                                     std::span<const Vec3> predicted)
{
    springs_.clear();
    step_ = {rods_.startStep(state), shells_.startStep(state.x)};
    at_ = &state;
    reached_.fill(0.0);
    assembleInternal(state, h);
    findPins(state, t + h);
    for (const ObstacleContact& contact : obstacles) {
        const std::array<int, 3> v = contact.vertices();
        const std::array<double, 3> share = contact.shares();
        const Vec3 ahead = share[0] * predicted[v[0]] + share[1] * predicted[v[1]] + share[2] * predicted[v[2]];
        // Known at the predicted position; by its derivative, at the present one.
        springs_.push_back({v, share, contact.stiffness, contact.gradient - contact.stiffness * (h * ahead)});
    }
    addConstraints();
    return Assembled();
}

VertexStiffness::Assembled VertexStiffness::assembleAt(const Assembled&, const FabricState& there, double h, AlignedArray<double>& u)
{
    at_ = &there;
    std::ranges::copy(u, reached_.begin());
    assembleInternal(there, h);
    extrapolateToStart(h);
    addConstraints();
    return Assembled();
}

/// Extrapolates the gradient at at_ linearly, by K, back to the start of the step.
void VertexStiffness::extrapolateToStart(double h)
{
    multiplyInternal(reached_, product_);
    for (std::size_t i = 0; i < product_.size(); ++i) gradient_[i] -= h * product_[i];
}

VertexStiffness::Work VertexStiffness::workOfConstraints(double h, const AlignedArray<double>& u) const
{
    Work work;
    for (std::size_t i = 0; i < springs_.size(); ++i) {
        const Spring& s = springs_[i];
        const Vec3 mean = atPoint(u, s);
        (i < pinStiffness_.size() ? work.pins : work.obstacles) -= mean.dot(h * s.gradient + h * h * (s.stiffness * mean));
    }
    for (std::size_t i = 0; i < heldEdges_.size(); ++i) {
        const double speed = u[unknowns_.twistSlot[heldEdges_[i]]];
        work.pins -= speed * (h * heldTorque_[i] + h * h * heldStiffness_[i] * speed);
    }
    return work;
}

/// −u·(h gradient + h² product_).
double VertexStiffness::workOfProduct(double h, const AlignedArray<double>& u) const
{
    return -parallelSum(u.size(), [&](std::size_t i) { return u[i] * (h * gradient_[i] + h * h * product_[i]); });
}

double VertexStiffness::internalWork(double h, AlignedArray<double>& u) const
{
    multiply(u, product_);
    const Work constraints = workOfConstraints(h, u);
    return workOfProduct(h, u) - constraints.pins - constraints.obstacles;
}

VertexStiffness::Work VertexStiffness::work(double h, AlignedArray<double>& u)
{
    Work work = workOfConstraints(h, u);
    const double internal = internalWork(h, u);
    assembleInternal(*at_, std::numeric_limits<double>::infinity());
    extrapolateToStart(h);
    multiplyInternal(u, product_);
    work.elastic = workOfProduct(h, u);
    work.damping = internal - work.elastic;
    return work;
}

void VertexStiffness::multiplyCloth(const AlignedArray<double>& in, AlignedArray<double>& out) const
{
    const std::vector<int>& vertices = shells_.vertices();
    parallelFor(vertices.size(), 512, [&](std::size_t row) {
        const double* p = in.data() + unknowns_.slot[vertices[row]];
        for (int a = 0; a < kAxes; ++a) clothIn_[4 * row + a] = p[a * kLanes];
        clothIn_[4 * row + 3] = 0.0;
    });
    parallelFor(cloth_.chunks(), [&](std::size_t chunk) {
        cloth_.timesChunk(
            static_cast<int>(chunk), [&](int row) { return *reinterpret_cast<const HalfPack*>(clothIn_.data() + 4 * row); },
            [&](int row, const HalfPack& product) {
                add(out, vertices[row], {product[0], product[1], product[2]});
            });
    });
}

void VertexStiffness::multiplyInternal(AlignedArray<double>& in, AlignedArray<double>& out) const
{
    copyFromOwners(in);
    const StrandLayout& layout = rods_.layout();
    forEachGroup(in, [&](std::size_t g, const Pack* rows) {
        const StrandLayout::Group& group = layout.groups[g];
        strands_.multiply(group, rows, reinterpret_cast<Pack*>(out.data()) + group.firstRow);
    });
    std::fill(out.begin() + unknowns_.strandSize, out.end(), 0.0);
    addToOwners(out);
    if (!shells_.empty()) multiplyCloth(in, out);
}

void VertexStiffness::multiply(AlignedArray<double>& in, AlignedArray<double>& out) const
{
    multiplyInternal(in, out);
    for (const Spring& s : springs_) addToPoint(out, s, s.stiffness * atPoint(in, s));
    for (std::size_t i = 0; i < heldEdges_.size(); ++i) {
        const int slot = unknowns_.twistSlot[heldEdges_[i]];
        out[slot] += heldStiffness_[i] * in[slot];
    }
}

void VertexStiffness::factorTwist(std::span<const double> inertia, double h)
{
    std::vector<double> held(fabric_.edges.size(), 0.0);
    for (std::size_t i = 0; i < heldEdges_.size(); ++i) held[heldEdges_[i]] = heldStiffness_[i];
    twist_.factor(rods_.layout(), strands_, inertia, held, h);
}

void VertexStiffness::backSubstituteTwist(AlignedArray<double>& u) const
{
    copyFromOwners(u);
    forEachGroup(u, [&](std::size_t g, Pack* rows) { twist_.backSubstitute(g, rows); });
}

void VertexStiffness::solveTwist(AlignedArray<double>& u) const
{
    forEachGroup(u, [&](std::size_t g, Pack* rows) { twist_.solve(g, rows); });
}

}  // namespace sim
