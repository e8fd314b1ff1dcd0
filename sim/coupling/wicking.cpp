#include "sim/coupling/wicking.h"

#include "sim/core/parallel.h"
#include "sim/coupling/cell_stencil.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <limits>

namespace sim {

namespace {

constexpr double kStable = 0.4;  ///< safe length of an explicit step, relative to h²/(2D) (coupling/README.md, Wicking) [-]

/// Length of an edge, or least height of a face, at rest [cm].
double leastExtent(const Fabric& fabric, const std::array<int, 3>& v)
{
    const auto x = [&](int c) { return fabric.rest[v[c]]; };
    if (v[2] < 0) return (x(1) - x(0)).norm();
    const double longest = std::max({(x(1) - x(0)).norm(), (x(2) - x(1)).norm(), (x(0) - x(2)).norm()});
    return (x(1) - x(0)).cross(x(2) - x(0)).norm() / longest;
}

/// An element as it stands.
struct ShapeGradients {
    std::array<Vec3, 3> of;  ///< gradients of the corners' hat functions [1/cm]
    double size = 0.0;       ///< length or area [cm, cm^2]
    Vec3 direction;          ///< direction of an edge, or normal to a face
    bool isEdge = false;
    /// The part of a vector that lies in the element.
    Vec3 within(const Vec3& u) const { return isEdge ? Vec3(direction * direction.dot(u)) : Vec3(u - direction * direction.dot(u)); }
};

/// False for an element without extent.
bool findShapeGradients(const std::vector<Vec3>& x, const std::array<int, 3>& v, ShapeGradients& out)
{
    out.isEdge = v[2] < 0;
    if (out.isEdge) {
        const Vec3 along = x[v[1]] - x[v[0]];
        out.size = along.norm();
        out.direction = along / out.size;
        out.of[1] = out.direction / out.size;
        out.of[0] = -out.of[1];
    } else {
        const Vec3 area = 0.5 * (x[v[1]] - x[v[0]]).cross(x[v[2]] - x[v[0]]);
        out.size = area.norm();
        out.direction = area / out.size;
        for (int c = 0; c < 3; ++c) out.of[c] = out.direction.cross(x[v[(c + 2) % 3]] - x[v[(c + 1) % 3]]) / (2.0 * out.size);
    }
    return out.size > 0.0;
}

}  // namespace

Wicking::Wicking(const Fabric& fabric, const PorousElements& elements, const Settings& settings)
    : fabric_(fabric),
      elements_(elements),
      settings_(settings.coupling.wicking),
      unsaturated_(settings_),
      density_(settings.liquid.density),
      capacity_(poreCapacity(fabric, density_)),
      leastSubsteps_(settings.solver.wickingSubsteps),
      rate_(elements.size()),
      filling_(elements.size()),
      flow_(elements.size()),
      carried_(elements.size())
{
    for (std::vector<double>* u : {&saturation_, &moving_, &head_, &outflowLimiter_, &absorbed_}) u->resize(fabric.vertexCount());
    isWetElement_.resize(elements.size());
    isActive_.resize(fabric.vertexCount());
    for (std::vector<Vec3>* u : {&acceleration_, &velocity_, &pinImpulse_}) u->resize(fabric.vertexCount());
    CouplingSettings inPores = settings.coupling;  // whatever liquid around the fabric feels, in its pores fibres hold it
    if (inPores.drag == DragLaw::Off) inPores.drag = CouplingSettings().drag;
    for (const FabricMaterial& m : fabric.materials) {
        laws_.emplace_back(PorousSettings{settings.porous.fibreDiameter, m.volumeFraction}, settings.liquid, inPores);
        suction_.push_back(laws_.back().suction(m.volumeFraction));
        along_.push_back(permeability(m.volumeFraction, settings.porous.fibreDiameter).along);
    }
    longest_ = std::numeric_limits<double>::infinity();
    for (const std::array<int, 3>& v : elements.vertices) {
        const int m = fabric.vertexMaterial[v[0]];
        const double drag = laws_[m].drag(along_[m], fabric.materials[m].volumeFraction, 0.0);
        if (!(drag > 0.0 && settings_.rateScale > 0.0)) continue;
        const double extent = leastExtent(fabric, v), pores = settings_.rateScale * (1.0 - fabric.materials[m].volumeFraction);
        const double diffusivity = pores * 2.0 * suction_[m] / drag * unsaturated_.steepest();
        if (diffusivity > 0.0) longest_ = std::min(longest_, kStable * std::pow(extent, 2) / (2.0 * diffusivity));
        if (unsaturated_.isLinear()) continue;
        const double fall = pores * density_ * settings.gravity.norm() / drag * unsaturated_.steepestPermeability();  // [cm/s]
        if (fall > 0.0) longest_ = std::min(longest_, kStable * extent / fall);
    }
}

int Wicking::substeps(double dt) const { return std::max(leastSubsteps_, static_cast<int>(std::ceil(dt / longest_))); }

bool Wicking::isWet(const FabricState& state) const
{
    return parallelMax(state.absorbed.size(), [&](std::size_t v) { return state.absorbed[v]; }) > 0.0;
}

/// The elements that hold liquid, and the vertices that it may flow from or to.
void Wicking::findActive(const FabricState& state)
{
    parallelFor(elements_.size(), kGrain, [&](std::size_t e) {
        double held = 0.0;
        for (int c = 0; c < elements_.corners(e); ++c) held += state.absorbed[elements_.vertices[e][c]];
        isWetElement_[e] = held > 0.0;
        rate_[e] = {0.0, 0.0, 0.0};
    });
    parallelFor(isActive_.size(), kGrain, [&](std::size_t v) {
        isActive_[v] = std::any_of(elements_.at.begin() + elements_.begin[v], elements_.at.begin() + elements_.begin[v + 1],
                                   [&](int e) { return isWetElement_[e] != 0; });
    });
}

/// Pressure of the liquid around a point, 0 where there is none [dyn/cm^2].
double Wicking::pressureAt(const Vec3& x, const BlockGrid& grid, const BlockArray<double>& pressure) const
{
    if (!settings_.pressure || grid.count() == 0) return 0.0;
    const Vec3 at = (x - grid.origin) / (kBlockEdge * grid.dx);
    const int block = grid.find(at.array().floor().matrix().cast<int>());
    if (block == BlockGrid::kNone) return 0.0;
    double sum = 0.0;
    CellStencil(x, grid.lowerCorner(block), grid.dx).forEach(grid.neighbours(block), [&](int b, int c, double weight) {
        sum += weight * pressure.block(b)[c];
    });
    return sum;
}

/// How full vertices are, what drives liquid towards each, suction of its empty pores less the pressure around it, and what moves from it.
void Wicking::findHeads(const BlockGrid& grid, const BlockArray<double>& pressure, const FabricState& state)
{
    parallelFor(head_.size(), kGrain, [&](std::size_t v) {
        if (!isActive_[v]) return;
        saturation_[v] = capacity_[v] > 0.0 ? std::clamp(state.absorbed[v] / capacity_[v], 0.0, 1.0) : 1.0;
        head_[v] = 2.0 * suction_[fabric_.vertexMaterial[v]] * unsaturated_.suction(saturation_[v]) - pressureAt(state.x[v], grid, pressure);
        moving_[v] = unsaturated_.isLinear() ? state.absorbed[v] / fabric_.volume[v]
                                             : capacity_[v] / fabric_.volume[v] * unsaturated_.permeability(saturation_[v]);
    });
}

/// Filling that moves in an element: mean of its corners, by the law between each two of them where that is not linear [g/cm^3].
double Wicking::fillingAmong(const std::array<int, 3>& v, int corners) const
{
    double sum = 0.0;
    if (unsaturated_.isLinear()) {
        for (int c = 0; c < corners; ++c) sum += moving_[v[c]] / corners;
        return sum;
    }
    const int pairs = corners == 2 ? 1 : 3;
    for (int c = 0; c < pairs; ++c) {
        const int one = v[c], other = v[(c + 1) % corners];
        const double full = 0.5 * (capacity_[one] / fabric_.volume[one] + capacity_[other] / fabric_.volume[other]);
        sum += full * unsaturated_.meanPermeability(saturation_[one], saturation_[other]) / pairs;
    }
    return sum;
}

/// Outflow at the corners of each element.
void Wicking::findFlow(const Vec3& gravity, const FabricState& state)
{
    parallelFor(elements_.size(), kGrain, [&](std::size_t e) {
        const std::array<int, 3>& v = elements_.vertices[e];
        const int corners = elements_.corners(e);
        ShapeGradients gradients;
        if (!isWetElement_[e] || !findShapeGradients(state.x, v, gradients)) return;
        filling_[e] = fillingAmong(v, corners);
        Vec3 body = density_ * gravity, force = Vec3::Zero();
        for (int c = 0; c < corners; ++c) {
            body -= density_ / corners * acceleration_[v[c]];
            force += head_[v[c]] * gradients.of[c];
        }
        force += gradients.within(body);
        const double strength = force.norm();
        if (!(strength > 0.0)) return;
        const int m = fabric_.vertexMaterial[v[0]];
        const double fraction = fabric_.materials[m].volumeFraction;
        const double speed = laws_[m].speedUnder((1.0 - fraction) * strength, along_[m], fraction);
        const Vec3 flow = settings_.rateScale * elements_.crossSection[e] * gradients.size * speed / strength * force;
        for (int c = 0; c < corners; ++c) rate_[e][c] = -flow.dot(gradients.of[c]);
    });
}

/// No vertex gives more than it has.
void Wicking::limitDonors(double h, const FabricState& state)
{
    parallelFor(outflowLimiter_.size(), kGrain, [&](std::size_t v) {
        if (!isActive_[v]) return;
        double out = 0.0;  // [g]
        for (int i = elements_.begin[v]; i < elements_.begin[v + 1]; ++i) {
            const int e = elements_.at[i];
            for (int c = 0; c < elements_.corners(e); ++c)
                if (elements_.vertices[e][c] == static_cast<int>(v)) out += h * std::max(rate_[e][c], 0.0) * fillingOf(e, static_cast<int>(v));
        }
        outflowLimiter_[v] = out > state.absorbed[v] ? state.absorbed[v] / out : 1.0;
    });
}

void Wicking::transport(double h, FabricState& state)
{
    const auto leaves = [&](std::size_t e, int c) {
        const int v = elements_.vertices[e][c];
        return outflowLimiter_[v] * h * std::max(rate_[e][c], 0.0) * fillingOf(e, v);
    };
    parallelFor(elements_.size(), kGrain, [&](std::size_t e) {
        if (!isWetElement_[e]) return;
        flow_[e] = 0.0;
        carried_[e].setZero();
        double received = 0.0;
        for (int c = 0; c < elements_.corners(e); ++c) {
            const double mass = leaves(e, c);
            flow_[e] += mass;
            carried_[e] += mass * state.v[elements_.vertices[e][c]];
            received += std::max(-rate_[e][c], 0.0);
        }
        if (!(received > 0.0)) return;
        flow_[e] /= received;
        carried_[e] /= received;
    });
    parallelFor(absorbed_.size(), kGrain, [&](std::size_t v) {
        absorbed_[v] = state.absorbed[v];
        velocity_[v] = state.v[v];
        if (!isActive_[v]) return;
        double mass = state.absorbed[v], gained = 0.0;
        Vec3 momentum = Vec3::Zero();
        for (int i = elements_.begin[v]; i < elements_.begin[v + 1]; ++i) {
            const int e = elements_.at[i];
            if (!isWetElement_[e]) continue;
            for (int c = 0; c < elements_.corners(e); ++c) {
                if (elements_.vertices[e][c] != static_cast<int>(v)) continue;
                const double share = std::max(-rate_[e][c], 0.0);
                mass -= leaves(e, c);
                gained += share * flow_[e];
                momentum += share * carried_[e];
            }
        }
        absorbed_[v] = std::max(mass, 0.0) + gained;
        if (!(gained > 0.0)) return;
        if (fabric_.pinned[v]) pinImpulse_[v] += momentum - gained * state.v[v];
        else velocity_[v] = ((fabric_.mass[v] + std::max(mass, 0.0)) * state.v[v] + momentum) / (fabric_.mass[v] + absorbed_[v]);
    });
    state.absorbed.swap(absorbed_);
    state.v.swap(velocity_);
}

std::span<const Vec3> Wicking::move(double dt, const Vec3& gravity, const BlockGrid& grid, const BlockArray<double>& pressure,
                                    std::span<const Vec3> before, FabricState& state)
{
    std::ranges::fill(pinImpulse_, Vec3::Zero());
    if (!(settings_.rateScale > 0.0)) return pinImpulse_;
    const int parts = substeps(dt);
    const double h = dt / parts;
    parallelFor(before.size(), kGrain, [&](std::size_t v) { acceleration_[v] = (state.v[v] - before[v]) / dt; });
    for (int n = 0; n < parts; ++n) {
        findActive(state);
        findHeads(grid, pressure, state);
        findFlow(gravity, state);
        limitDonors(h, state);
        transport(h, state);
    }
    return pinImpulse_;
}

}  // namespace sim
