#include "sim/fabric/rods/rods.h"

#include "sim/core/parallel.h"
#include "sim/fabric/rods/rod_walk.h"

#include <algorithm>
#include <cmath>

namespace sim {

namespace {

/// Half axes a, b of an ellipse and how they resist (fabric/rods/README.md, Energies).
struct Section {
    double a, b;
    double area() const { return kPi * a * b; }
    double alongA() const { return 0.25 * kPi * b * a * a * a; }  ///< second moment of bending in the direction of a [cm^4]
    double alongB() const { return 0.25 * kPi * a * b * b * b; }
    double torsion(TorsionModel model) const
    {
        if (model == TorsionModel::Polar) return 0.25 * kPi * a * b * (a * a + b * b);
        return kPi * a * a * a * b * b * b / (a * a + b * b);  // St-Venant
    }
};

}  // namespace

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

    twistHessianShare_.assign(layout_.groups.size(), Pack{});
    perRestLength_.resize(layout_.edge.size());
    for (std::size_t i = 0; i < layout_.edge.size(); ++i)
        for (int l = 0; l < kLanes; ++l) {
            const int e = layout_.edge[i][l];
            perRestLength_[i][l] = e >= 0 ? 1.0 / fabric.edges.restLength[e] : 0.0;
        }

    bends_.resize(layout_.vertex.size());
    for (std::size_t g = 0; g < layout_.groups.size(); ++g) {
        const StrandLayout::Group& group = layout_.groups[g];
        forEachInnerVertex(static_cast<int>(g), rest, [&](const InnerVertex& at) {
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

void Rods::includeTwistHessian() { std::ranges::fill(twistHessianShare_, broadcast(1.0)); }

void Rods::excludeTwistHessian(const std::vector<Pack>& keep)
{
    for (std::size_t g = 0; g < keep.size(); ++g) twistHessianShare_[g] *= keep[g];
}

void Rods::transportFrames(FabricState& state) const
{
    parallelFor(layout_.groups.size(), [&](std::size_t g) {
        const StrandLayout::Group& group = layout_.groups[g];
        PackVec3 from = gathered(state.x, layout_.vertex[group.firstVertex]);
        PackVec3 tangentBefore{}, referenceBefore{};
        for (int j = 0; j < group.edges(); ++j) {
            const StrandLayout::Lanes& edges = layout_.edge[group.firstEdge + j];
            const PackVec3 to = gathered(state.x, layout_.vertex[group.firstVertex + j + 1]);
            const PackVec3 tangent = edgeBetween(from, to, edges).tangent;
            const PackVec3 reference = unitAcross(transported(gathered(state.reference, edges), gathered(state.tangent, edges), tangent), tangent);
            const PackVec3 carried = j > 0 ? transported(referenceBefore, tangentBefore, tangent) : reference;
            const Pack turned = angleOf(dot(cross(carried, reference), tangent), dot(carried, reference));
            for (int l = 0; l < kLanes; ++l) {
                const int e = edges[l];
                if (e < 0) continue;
                state.tangent[e] = laneOf(tangent, l);
                state.reference[e] = laneOf(reference, l);
                if (j == 0) continue;
                // The nearest of the angles that differ by full turns, so that many turns add up.
                double& twist = state.referenceTwist[e];
                twist += std::remainder(turned[l] - twist, 2.0 * kPi);
            }
            from = to;
            tangentBefore = tangent;
            referenceBefore = reference;
        }
    });
}

Rods::Step Rods::startStep(const FabricState& state)
{
    if (!damped_) return Step(*this);
    parallelFor(layout_.groups.size(), [&](std::size_t g) {
        const StrandLayout::Group& group = layout_.groups[g];
        for (int j = 0; j < group.edges(); ++j) {
            const int i = group.firstEdge + j;
            const PackVec3 from = gathered(state.x, layout_.vertex[group.firstVertex + j]);
            const PackVec3 to = gathered(state.x, layout_.vertex[group.firstVertex + j + 1]);
            startStretch_[i] = edgeBetween(from, to, layout_.edge[i]).length * perRestLength_[i];
        }
        forEachInnerVertex(static_cast<int>(g), state, [&](const InnerVertex& at) {
            const std::array<Pack, 4>& k = at.strain.curvature;
            startBend_[group.firstVertex + at.j] = {k[0], k[1], k[2], k[3], at.twist};
        });
    });
    return Step(*this);
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
            const PackVec3 from = gathered(state.x, layout_.vertex[group.firstVertex + j]);
            const PackVec3 to = gathered(state.x, layout_.vertex[group.firstVertex + j + 1]);
            const Pack used = select(perRestLength_[i] > 0.0, broadcast(1.0), broadcast(0.0));
            const Pack strain = edgeBetween(from, to, layout_.edge[i]).length * perRestLength_[i] - used;
            const Pack restLength = select(perRestLength_[i] > 0.0, broadcast(1.0) / perRestLength_[i], broadcast(0.0));
            stretching += 0.5 * k.stretch * strain * strain * restLength;
        }
        forEachInnerVertex(static_cast<int>(g), state, [&](const InnerVertex& at) {
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
