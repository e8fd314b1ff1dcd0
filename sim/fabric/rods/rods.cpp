#include "sim/fabric/rods/rods.h"

#include "sim/core/parallel.h"
#include "sim/fabric/rods/rod_kernel.h"

#include <algorithm>
#include <cmath>

namespace sim {

namespace {

/// Half axes a, b of an ellipse and how they resist (model-fabric 1.2).
struct Section {
    double a, b;
    double area() const { return kPi * a * b; }
    double alongA() const { return 0.25 * kPi * b * a * a * a; }   ///< second moment of bending in the direction of a [cm^4]
    double alongB() const { return 0.25 * kPi * a * b * b * b; }
    double torsion(TorsionModel model) const
    {
        if (model == TorsionModel::Polar) return 0.25 * kPi * a * b * (a * a + b * b);
        return kPi * a * a * a * b * b * b / (a * a + b * b);      // St-Venant
    }
};

PackTriple gathered(const std::vector<Vec3>& values, const StrandLayout::Lanes& index)
{
    PackTriple v{};
    for (int l = 0; l < kLanes; ++l)
        if (index[l] >= 0) setLane(v, l, values[index[l]]);
    return v;
}

Pack gathered(const std::vector<double>& values, const StrandLayout::Lanes& index)
{
    Pack v{};
    for (int l = 0; l < kLanes; ++l)
        if (index[l] >= 0) v[l] = values[index[l]];
    return v;
}

/// The edge between two gathered vertices; unused lanes get an edge of length 1.
RodEdge<Pack> edgeBetween(const PackTriple& from, const PackTriple& to, const StrandLayout::Lanes& edges)
{
    RodEdge<Pack> e;
    PackTriple along = to - from;
    for (int l = 0; l < kLanes; ++l)
        if (edges[l] < 0) setLane(along, l, Vec3::UnitX());
    e.length = norm(along);
    e.tangent = (broadcast(1.0) / e.length) * along;
    return e;
}

/// Turns the reference frame by θ.
void setMaterialFrame(const FabricState& state, const StrandLayout::Lanes& edges, RodEdge<Pack>& e)
{
    e.reference = gathered(state.reference, edges);
    const Pack theta = gathered(state.theta, edges);
    Pack c, s;
    for (int l = 0; l < kLanes; ++l) {
        c[l] = std::cos(theta[l]);
        s[l] = std::sin(theta[l]);
    }
    const PackTriple second = cross(e.tangent, e.reference);
    e.m1 = c * e.reference + s * second;
    e.m2 = c * second - s * e.reference;
}

}  // namespace

/// A vertex with an edge on either side, as walkGroup meets it.
struct Rods::Walk {
    int j;                       ///< the vertex within the strands; edge j − 1 ends and edge j begins here
    const RodEdge<Pack>&before, &after;
    RodStrain<Pack> strain;
    Pack twist;                  ///< m [rad]
};

Rods::Rods(const Fabric& fabric, const FabricState& rest, const FabricSettings& settings) : layout_(fabric.strands)
{
    for (const StrandLayout::Lanes& strands : layout_.strand) {
        Stiffness k{};
        for (int l = 0; l < kLanes; ++l) {
            if (strands[l] < 0) continue;
            const FabricMaterial& m = fabric.materials[fabric.strands.material[strands[l]]];
            const Section section{fabric.strands.radius[strands[l]][0], fabric.strands.radius[strands[l]][1]};
            const double young = m.packing() * m.young, c = std::cos(m.sectionRotation), s = std::sin(m.sectionRotation);
            k.stretch[l] = young * section.area() * m.stretchFactor;
            k.bend00[l] = young * (c * c * section.alongA() + s * s * section.alongB());
            k.bend01[l] = young * c * s * (section.alongA() - section.alongB());
            k.bend11[l] = young * (s * s * section.alongA() + c * c * section.alongB());
            k.twist[l] = settings.twist ? m.packing() * m.shear() * section.torsion(settings.torsion) : 0.0;
            const double viscous = 3.0 * m.dampingViscosity / m.young;
            k.stretchDamping[l] = m.dampStretching ? viscous : 0.0;
            k.bendDamping[l] = m.dampBending ? viscous : 0.0;
            k.twistDamping[l] = m.dampBending ? m.dampingViscosity / m.shear() : 0.0;
            damped_ = damped_ || (m.dampingViscosity > 0.0 && (m.dampStretching || m.dampBending));
        }
        stiffness_.push_back(k);
    }

    torqueShare_.assign(layout_.groups.size(), Pack{});
    perRestLength_.resize(layout_.edge.size());
    twistInertia_.resize(layout_.edge.size());
    for (std::size_t i = 0; i < layout_.edge.size(); ++i)
        for (int l = 0; l < kLanes; ++l) {
            const int e = layout_.edge[i][l];
            perRestLength_[i][l] = e >= 0 ? 1.0 / fabric.edges.restLength[e] : 0.0;
            twistInertia_[i][l] = e >= 0 ? fabric.edges.twistInertia[e] : 1.0;
        }

    bends_.resize(layout_.vertex.size());
    for (std::size_t g = 0; g < layout_.groups.size(); ++g) {
        const StrandLayout::Group& group = layout_.groups[g];
        walkGroup(static_cast<int>(g), rest, [&](const Walk& at) {
            Bend& bend = bends_[group.firstVertex + at.j];
            bend.curvature = at.strain.curvature;
            for (int l = 0; l < kLanes; ++l) {
                const int e = layout_.edge[group.firstEdge + at.j - 1][l], f = layout_.edge[group.firstEdge + at.j][l];
                if (f >= 0) bend.perLength[l] = 2.0 / (fabric.edges.restLength[e] + fabric.edges.restLength[f]);
            }
        });
    }
    if (damped_) {
        startStretch_.resize(layout_.edge.size());
        startBend_.resize(layout_.vertex.size());
    }
}

void Rods::useTorque() { std::ranges::fill(torqueShare_, broadcast(1.0)); }

void Rods::transportFrames(FabricState& state) const
{
    parallelFor(layout_.groups.size(), [&](std::size_t g) {
        const StrandLayout::Group& group = layout_.groups[g];
        PackTriple from = gathered(state.x, layout_.vertex[group.firstVertex]);
        PackTriple tangentBefore{}, referenceBefore{};
        for (int j = 0; j < group.edges(); ++j) {
            const StrandLayout::Lanes& edges = layout_.edge[group.firstEdge + j];
            const PackTriple to = gathered(state.x, layout_.vertex[group.firstVertex + j + 1]);
            const PackTriple tangent = edgeBetween(from, to, edges).tangent;
            const PackTriple reference =
                unitAcross(transported(gathered(state.reference, edges), gathered(state.tangent, edges), tangent), tangent);
            const PackTriple carried = j > 0 ? transported(referenceBefore, tangentBefore, tangent) : reference;
            const Pack sine = dot(cross(carried, reference), tangent), cosine = dot(carried, reference);
            for (int l = 0; l < kLanes; ++l) {
                const int e = edges[l];
                if (e < 0) continue;
                state.tangent[e] = laneOf(tangent, l);
                state.reference[e] = laneOf(reference, l);
                if (j == 0) continue;
                // The nearest of the angles that differ by full turns, so that many turns add up.
                double& twist = state.referenceTwist[e];
                twist += std::remainder(std::atan2(sine[l], cosine[l]) - twist, 2.0 * kPi);
            }
            from = to;
            tangentBefore = tangent;
            referenceBefore = reference;
        }
    });
}

/// Calls visit(Walk) for every vertex between two edges, from the first to the last.
template <class Visit>
void Rods::walkGroup(int g, const FabricState& state, Visit&& visit) const
{
    const StrandLayout::Group& group = layout_.groups[g];
    PackTriple from = gathered(state.x, layout_.vertex[group.firstVertex]);
    RodEdge<Pack> before;
    Pack thetaBefore{};
    for (int j = 0; j < group.edges(); ++j) {
        const StrandLayout::Lanes& edges = layout_.edge[group.firstEdge + j];
        const PackTriple to = gathered(state.x, layout_.vertex[group.firstVertex + j + 1]);
        RodEdge<Pack> edge = edgeBetween(from, to, edges);
        setMaterialFrame(state, edges, edge);
        const Pack theta = gathered(state.theta, edges);
        if (j > 0) {
            Walk at{j, before, edge, rodStrain(before, edge), gathered(state.referenceTwist, edges) + theta - thetaBefore};
            visit(at);
        }
        before = edge;
        thetaBefore = theta;
        from = to;
    }
}

void Rods::startStep(const FabricState& state)
{
    if (!damped_) return;
    parallelFor(layout_.groups.size(), [&](std::size_t g) {
        const StrandLayout::Group& group = layout_.groups[g];
        for (int j = 0; j < group.edges(); ++j) {
            const int i = group.firstEdge + j;
            const PackTriple from = gathered(state.x, layout_.vertex[group.firstVertex + j]);
            const PackTriple to = gathered(state.x, layout_.vertex[group.firstVertex + j + 1]);
            startStretch_[i] = edgeBetween(from, to, layout_.edge[i]).length * perRestLength_[i];
        }
        walkGroup(static_cast<int>(g), state, [&](const Walk& at) {
            const std::array<Pack, 4>& k = at.strain.curvature;
            startBend_[group.firstVertex + at.j] = {k[0], k[1], k[2], k[3], at.twist};
        });
    });
}

void Rods::forces(const FabricState& state, double h, Pack* gradient, StrandMatrix* matrix) const
{
    if (matrix) matrix->clear();
    parallelFor(layout_.groups.size(), [&](std::size_t g) {
        const int firstRow = layout_.groups[g].firstRow;
        forcesOfGroup(static_cast<int>(g), state, h, gradient + firstRow, matrix ? matrix->rows(firstRow) : nullptr);
    });
}

namespace {

/// The torque's part of the Hessian: what turns a twisted rod out of its plane. Not definite by itself.
void addTorque(const Pack& torque, const RodEdge<Pack>& e, const RodEdge<Pack>& f, Pack* band)
{
    constexpr int kBand = StrandMatrix::kBand;
    const TwistCurvature<Pack> c = twistCurvature(e, f);
    const auto entry = [&](int row, int column) -> Pack& { return band[row * kBand + row - column]; };
    for (int a = 0; a < 3; ++a)
        for (int b = 0; b < 3; ++b) {
            entry(4 + a, b) += torque * (c.ef[b][a] - c.ee[a][b]);
            entry(8 + a, b) -= torque * c.ef[b][a];
            entry(8 + a, 4 + b) += torque * (c.ef[b][a] - c.ff[a][b]);
            if (b > a) continue;
            entry(a, b) += torque * c.ee[a][b];
            entry(4 + a, 4 + b) += torque * (c.ee[a][b] - c.ef[a][b] - c.ef[b][a] + c.ff[a][b]);
            entry(8 + a, 8 + b) += torque * c.ff[a][b];
        }
}

/// What a yarn that is straighter than at rest opposes to turning about its tangent, beyond |κ|² of Gauss and Newton: with it |κ||κ̄|, so
/// that where the section is round the energy stays below its quadratic model for any angle. Without it Newton turned straightened
/// crimped yarns to and fro by a radian and more in every step.
Pack rollStiffness(const Pack& b00, const Pack& b01, const Pack& b11, const Pack* now, const Pack* rest)
{
    const auto square = [&](const Pack* k) { return (b00 * k[0] + 2.0 * b01 * k[1]) * k[0] + b11 * k[1] * k[1]; };
    const Pack here = square(now);
    return maxPack(sqrtPack(here * square(rest)) - here, broadcast(0.0));
}

}  // namespace

void Rods::forcesOfGroup(int g, const FabricState& state, double h, Pack* gradient, Pack* band) const
{
    constexpr int kBand = StrandMatrix::kBand;
    const StrandLayout::Group& group = layout_.groups[g];
    const Stiffness& k = stiffness_[g];
    const bool hasTorque = sumLanes(torqueShare_[g]) > 0.0;
    const Pack one = broadcast(1.0), perStep = broadcast(damped_ ? 1.0 / h : 0.0);
    const Pack stretchRate = perStep * k.stretchDamping, bendRate = perStep * k.bendDamping, twistRate = perStep * k.twistDamping;

    for (int j = 0; j < group.edges(); ++j) {
        const int i = group.firstEdge + j, row = 4 * j;
        const PackTriple from = gathered(state.x, layout_.vertex[group.firstVertex + j]);
        const PackTriple to = gathered(state.x, layout_.vertex[group.firstVertex + j + 1]);
        const RodEdge<Pack> e = edgeBetween(from, to, layout_.edge[i]);
        const Pack stretch = e.length * perRestLength_[i];
        Pack force = select(perRestLength_[i] > 0.0, k.stretch * (stretch - one), broadcast(0.0));
        if (damped_) force += k.stretch * stretchRate * (stretch - startStretch_[i]);
        for (int a = 0; a < 3; ++a) {
            gradient[row + a] -= force * e.tangent[a];
            gradient[row + 4 + a] += force * e.tangent[a];
        }
        if (!band) continue;
        const Pack across = select(perRestLength_[i] > 0.0, k.stretch * maxPack(perRestLength_[i] - one / e.length, broadcast(0.0)), broadcast(0.0));
        const Pack along = k.stretch * perRestLength_[i] * (one + stretchRate) - across;
        for (int a = 0; a < 3; ++a)
            for (int b = 0; b < 3; ++b) {
                Pack entry = along * e.tangent[a] * e.tangent[b];
                if (a == b) entry += across;
                if (b <= a) {
                    band[(row + a) * kBand + a - b] += entry;
                    band[(row + 4 + a) * kBand + a - b] += entry;
                }
                band[(row + 4 + a) * kBand + 4 + a - b] -= entry;
            }
    }

    walkGroup(g, state, [&](const Walk& at) {
        const Bend& bend = bends_[group.firstVertex + at.j];
        const RodStrain<Pack>& s = at.strain;
        const Pack half = broadcast(0.5) * bend.perLength, twistStiffness = k.twist * bend.perLength;
        std::array<Pack, 4> change;
        for (int c = 0; c < 4; ++c) change[c] = s.curvature[c] - bend.curvature[c];
        Pack twist = at.twist;
        if (damped_) {
            const std::array<Pack, 5>& start = startBend_[group.firstVertex + at.j];
            for (int c = 0; c < 4; ++c) change[c] += bendRate * (s.curvature[c] - start[c]);
            twist += twistRate * (at.twist - start[4]);
        }
        std::array<Pack, 4> moment;  // ∂E/∂κ
        for (int c = 0; c < 4; c += 2) {
            moment[c] = half * (k.bend00 * change[c] + k.bend01 * change[c + 1]);
            moment[c + 1] = half * (k.bend01 * change[c] + k.bend11 * change[c + 1]);
        }
        const Pack torque = twistStiffness * twist;
        const int row = 4 * (at.j - 1);
        for (int r = 0; r < kRodUnknowns; ++r) {
            Pack sum = torque * s.twistGradient[r];
            for (int c = 0; c < 4; ++c) sum += moment[c] * s.curvatureGradient[c][r];
            gradient[row + r] += sum;
        }
        if (!band) return;
        const Pack bending = half * (one + bendRate), twisting = twistStiffness * (one + twistRate);
        const Pack b00 = bending * k.bend00, b01 = bending * k.bend01, b11 = bending * k.bend11;
        const auto& d = s.curvatureGradient;
        for (int r = 0; r < kRodUnknowns; ++r) {
            const Pack e0 = b00 * d[0][r] + b01 * d[1][r], e1 = b01 * d[0][r] + b11 * d[1][r];
            const Pack f0 = b00 * d[2][r] + b01 * d[3][r], f1 = b01 * d[2][r] + b11 * d[3][r];
            const Pack t = twisting * s.twistGradient[r];
            for (int c = 0; c <= r; ++c)
                band[(row + r) * kBand + r - c] += e0 * d[0][c] + e1 * d[1][c] + f0 * d[2][c] + f1 * d[3][c] + t * s.twistGradient[c];
        }
        const std::array<Pack, 4>&now = s.curvature, &rest = bend.curvature;
        band[(row + 3) * kBand] += rollStiffness(b00, b01, b11, &now[0], &rest[0]);
        band[(row + 7) * kBand] += rollStiffness(b00, b01, b11, &now[2], &rest[2]);
        if (hasTorque) addTorque(torqueShare_[g] * torque, at.before, at.after, band + row * kBand);
    });
}

std::array<double, 3> Rods::energies(const FabricState& state) const
{
    std::vector<std::array<double, 3>> ofGroup(layout_.groups.size());
    parallelFor(layout_.groups.size(), [&](std::size_t g) {
        const StrandLayout::Group& group = layout_.groups[g];
        const Stiffness& k = stiffness_[g];
        Pack stretching{}, bending{}, twisting{};
        for (int j = 0; j < group.edges(); ++j) {
            const int i = group.firstEdge + j;
            const PackTriple from = gathered(state.x, layout_.vertex[group.firstVertex + j]);
            const PackTriple to = gathered(state.x, layout_.vertex[group.firstVertex + j + 1]);
            const Pack used = select(perRestLength_[i] > 0.0, broadcast(1.0), broadcast(0.0));
            const Pack strain = edgeBetween(from, to, layout_.edge[i]).length * perRestLength_[i] - used;
            const Pack restLength = select(perRestLength_[i] > 0.0, broadcast(1.0) / perRestLength_[i], broadcast(0.0));
            stretching += 0.5 * k.stretch * strain * strain * restLength;
        }
        walkGroup(static_cast<int>(g), state, [&](const Walk& at) {
            const Bend& bend = bends_[group.firstVertex + at.j];
            for (int c = 0; c < 4; c += 2) {
                const Pack d0 = at.strain.curvature[c] - bend.curvature[c], d1 = at.strain.curvature[c + 1] - bend.curvature[c + 1];
                bending += 0.25 * bend.perLength * (k.bend00 * d0 * d0 + 2.0 * k.bend01 * d0 * d1 + k.bend11 * d1 * d1);
            }
            twisting += 0.5 * k.twist * bend.perLength * at.twist * at.twist;
        });
        ofGroup[g] = {sumLanes(stretching), sumLanes(bending), sumLanes(twisting)};
    });
    std::array<double, 3> sum{};
    for (const std::array<double, 3>& e : ofGroup)
        for (int n = 0; n < 3; ++n) sum[n] += e[n];
    return sum;
}

}  // namespace sim
