#include "sim/fabric/grid/active_elements.h"

#include "sim/core/parallel.h"

namespace sim {

namespace {

constexpr std::size_t kPacksPerTask = 32;

std::size_t packsOf(std::size_t n) { return (n + kLanes - 1) / kLanes; }

void setLane(Symmetric<Pack>& to, int lane, const Mat3& m)
{
    to.xx[lane] = m(0, 0), to.yy[lane] = m(1, 1), to.zz[lane] = m(2, 2);
    to.xy[lane] = m(0, 1), to.yz[lane] = m(1, 2), to.zx[lane] = m(2, 0);
}

void setElement(EdgeContact<Pack>& to, int lane, const ElementContact::Local& from)
{
    for (int k = 0; k < 2; ++k) setLane(to.d[k], lane, from.d[k]);
    setLane(to.reciprocal, lane, from.reciprocal[0]);
    setLane(to.k00, lane, from.stiffness[0]);
    setLane(to.k11, lane, from.stiffness[2]);
    for (int a = 0; a < kAxes; ++a) setLane(to.k01[a], lane, from.stiffness[1].row(a));
}

void setElement(FaceContact<Pack>& to, int lane, const ElementContact::Local& from)
{
    setLane(to.d[0], lane, from.d[0]);
    setLane(to.normal, lane, from.normal);
    for (int k = 0; k < 2; ++k) setLane(to.reciprocal[k], lane, from.reciprocal[k]);
    setLane(to.k, lane, from.stiffness[0]);
}

}  // namespace

/// body(lane, element's place in points()) for the lanes of a pack that are used.
template <class Contact>
void ActiveElements<Contact>::lanesOf(std::size_t pack, auto&& body) const
{
    const std::size_t first = pack * kLanes;
    for (int l = 0; l < kLanes && first + l < points_.size(); ++l) body(l, first + l);
}

template <class Contact>
void ActiveElements<Contact>::assemble(const ElementContact& contact, const VertexStiffness& stiffness, const BlockPoints& elements,
                                       const std::vector<Mat3>& missing, double dx, int firstForce)
{
    firstForce_ = firstForce;
    points_.select(elements, [&](int e) { return contact.isEdge(e) == (kCorners == 2) && contact.stress(e).isActive; });
    across_.resize(points_.size());
    rateOrStress_.resize(points_.size());
    const std::size_t packs = packsOf(points_.size());
    contact_.resize(packs);
    cornerSlot_.resize(packs * kLanes);
    partial_.resize(points_.size());
    anyPartial_.assign(packs, 0);
    partialElements_.clear();
    for (std::size_t s = 0; s < points_.size(); ++s) {
        const int e = points_.id[s];
        partial_[s] = -1;
        if (missing[e].isZero(0.0)) continue;
        partial_[s] = static_cast<int>(partialElements_.size());
        anyPartial_[s / kLanes] = 1;
        PartialStencil& partial = partialElements_.emplace_back();
        for (int k = 0; k < kCorners; ++k) partial.share[k] = contact.shares(e)[k];
        for (int k = 0; k < kDirections; ++k) partial.missing[k] = missing[e] * (contact.local(e).d[k] / dx);
    }
    parallelFor(packs, kPacksPerTask, [&](std::size_t pack) {
        contact_[pack] = Contact();
        lanesOf(pack, [&](int lane, std::size_t s) {
            const int e = points_.id[s];
            setElement(contact_[pack], lane, contact.local(e));
            for (int i = 0; i < 3 * kDirections; ++i) across_.of[i][s] = contact.local(e).d[i / 3][i % 3] / dx;
            for (int k = 0; k < kCorners; ++k) cornerSlot_[s][k] = stiffness.unknowns().slot[contact.corners(e)[k]];
        });
        for (std::size_t s = points_.size(); s < (pack + 1) * kLanes; ++s) cornerSlot_[s].fill(0);
    });
}

/// Rates of the directions [1/s], faces without mass moving like the mean of the corners.
template <class Contact>
auto ActiveElements<Contact>::ratesAt(std::size_t pack, const Corners& u) const -> Across
{
    Across w;
    for (int k = 0; k < kDirections; ++k)
        for (int a = 0; a < kAxes; ++a) w[k][a] = loadPack(rateOrStress_.of[3 * k + a].data() + pack * kLanes);
    if (anyPartial_[pack])
        lanesOf(pack, [&](int lane, std::size_t s) {
            if (partial_[s] < 0) return;
            const PartialStencil& partial = partialElements_[partial_[s]];
            Vec3 mean = Vec3::Zero();
            for (int k = 0; k < kCorners; ++k) mean += partial.share[k] * laneOf(u[k], lane);
            for (int k = 0; k < kDirections; ++k)
                for (int a = 0; a < kAxes; ++a) w[k][a][lane] -= mean[a] * partial.missing[k][a];
        });
    return w;
}

/// Transpose of ratesAt: stores the stresses of a pack on the faces, and its forces on the corners.
template <class Contact>
void ActiveElements<Contact>::store(std::size_t pack, const Across& stress, Corners nodalResponse, std::vector<Vec3>& nodalForces)
{
    for (int k = 0; k < kDirections; ++k)
        for (int a = 0; a < kAxes; ++a) std::memcpy(rateOrStress_.of[3 * k + a].data() + pack * kLanes, &stress[k][a], sizeof(Pack));
    lanesOf(pack, [&](int lane, std::size_t s) {
        Vec3* at = nodalForces.data() + firstForce_ + kCorners * s;
        for (int k = 0; k < kCorners; ++k) at[k] = laneOf(nodalResponse[k], lane);
        if (partial_[s] < 0) return;
        const PartialStencil& partial = partialElements_[partial_[s]];
        Vec3 onMean = Vec3::Zero();
        for (int k = 0; k < kDirections; ++k) onMean -= laneOf(stress[k], lane).cwiseProduct(partial.missing[k]);
        for (int k = 0; k < kCorners; ++k) at[k] += partial.share[k] * onMean;
    });
}

template <class Contact>
void ActiveElements<Contact>::multiply(const AlignedArray<double>& moves, std::vector<Vec3>& nodalForces)
{
    parallelFor(contact_.size(), kPacksPerTask, [&](std::size_t pack) {
        Corners u;
        for (int k = 0; k < kCorners; ++k)
            for (int l = 0; l < kLanes; ++l) {
                const double* from = moves.data() + cornerSlot_[pack * kLanes + l][k];
                u[k].x[l] = from[0], u[k].y[l] = from[kLanes], u[k].z[l] = from[2 * kLanes];
            }
        const Contact& contact = contact_[pack];
        const Across stress = contact.change(ratesAt(pack, u), u);
        store(pack, stress, contact.nodalResponse(stress), nodalForces);
    });
}

template <class Contact>
void ActiveElements<Contact>::impulses(const ElementContact& contact, std::vector<Vec3>& nodalForces)
{
    parallelFor(contact_.size(), kPacksPerTask, [&](std::size_t pack) {
        Across stress{};
        lanesOf(pack, [&](int lane, std::size_t s) {
            for (int k = 0; k < kDirections; ++k) setLane(stress[k], lane, -contact.stress(points_.id[s]).stress[k]);
        });
        store(pack, stress, contact_[pack].nodalResponse(stress), nodalForces);
    });
}

template class ActiveElements<EdgeContact<Pack>>;
template class ActiveElements<FaceContact<Pack>>;

}  // namespace sim
