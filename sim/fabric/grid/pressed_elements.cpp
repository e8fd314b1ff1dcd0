#include "sim/fabric/grid/pressed_elements.h"

#include "sim/core/parallel.h"

namespace sim {

namespace {

constexpr std::size_t kPacksPerTask = 32;

std::size_t packsOf(std::size_t n)
{
    return (n + kLanes - 1) / kLanes;
}

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
    setLane(to.d, lane, from.d[0]);
    setLane(to.normal, lane, from.normal);
    for (int k = 0; k < 2; ++k) setLane(to.reciprocal[k], lane, from.reciprocal[k]);
    setLane(to.k, lane, from.stiffness[0]);
}

void setStress(EdgeContact<Pack>::Stress& to, int lane, const ElementContact::Stress& from)
{
    for (int k = 0; k < 2; ++k) setLane(to[k], lane, from.stress[k]);
}

void setStress(FaceContact<Pack>::Stress& to, int lane, const ElementContact::Stress& from)
{
    setLane(to, lane, from.stress[0]);
}

}  // namespace

/// body(lane, element's place in points()) for the lanes of a pack that are used.
template <class Contact>
void PressedElements<Contact>::lanesOf(std::size_t pack, auto&& body) const
{
    const std::size_t first = pack * kLanes;
    for (int l = 0; l < kLanes && first + l < points_.size(); ++l) body(l, first + l);
}

template <class Contact>
void PressedElements<Contact>::assemble(const ElementContact& contact, const VertexStiffness& stiffness,
                                        const BlockPoints& elements, const std::vector<Mat3>& missing, double dx,
                                        int firstPush)
{
    perCell_ = 1.0 / dx;
    firstPush_ = firstPush;
    points_.select(elements, [&](int e) { return contact.isEdge(e) == (kCorners == 2) && contact.stress(e).isActive; });
    onGrid_.resize(points_.size());
    const std::size_t packs = packsOf(points_.size());
    contact_.resize(packs);
    cornerSlot_.resize(packs * kLanes);
    loose_.resize(points_.size());
    anyLoose_.assign(packs, 0);
    looseElements_.clear();
    for (std::size_t s = 0; s < points_.size(); ++s) {
        const int e = points_.id[s];
        loose_[s] = -1;
        if (missing[e].isZero(0.0)) continue;
        loose_[s] = static_cast<int>(looseElements_.size());
        anyLoose_[s / kLanes] = 1;
        Loose& loose = looseElements_.emplace_back(Loose{{}, missing[e]});
        for (int k = 0; k < kCorners; ++k) loose.share[k] = contact.shares(e)[k];
    }
    parallelFor(packs, kPacksPerTask, [&](std::size_t pack) {
        contact_[pack] = Contact();
        lanesOf(pack, [&](int lane, std::size_t s) {
            const int e = points_.id[s];
            setElement(contact_[pack], lane, contact.local(e));
            for (int k = 0; k < kCorners; ++k) cornerSlot_[s][k] = stiffness.unknowns().slot[contact.corners(e)[k]];
        });
        for (std::size_t s = points_.size(); s < (pack + 1) * kLanes; ++s) cornerSlot_[s].fill(0);
    });
}

/// Gathered gradients, faces without mass moving like the mean of the corners [1/s].
template <class Contact>
Rows<Pack> PressedElements<Contact>::relative(std::size_t pack, const Moves& u) const
{
    Rows<Pack> g;
    for (int a = 0; a < kAxes; ++a)
        for (int b = 0; b < kAxes; ++b) g[a][b] = loadPack(onGrid_.of[3 * a + b].data() + pack * kLanes);
    if (anyLoose_[pack])
        lanesOf(pack, [&](int lane, std::size_t s) {
            if (loose_[s] < 0) return;
            const Loose& loose = looseElements_[loose_[s]];
            Vec3 mean = Vec3::Zero();
            for (int k = 0; k < kCorners; ++k) mean += loose.share[k] * laneOf(u[k], lane);
            for (int a = 0; a < kAxes; ++a)
                for (int b = 0; b < kAxes; ++b) g[a][b][lane] -= mean[a] * loose.missing(a, b);
        });
    for (Triple<Pack>& row : g) row = broadcast(perCell_) * row;
    return g;
}

/// Transpose of `relative`: what a pack gives to the faces, and to its corners.
template <class Contact>
void PressedElements<Contact>::store(std::size_t pack, Push push, std::vector<Vec3>& pushes)
{
    for (Triple<Pack>& row : push.onGrid) row = broadcast(perCell_) * row;
    for (int a = 0; a < kAxes; ++a)
        for (int b = 0; b < kAxes; ++b)
            std::memcpy(onGrid_.of[3 * a + b].data() + pack * kLanes, &push.onGrid[a][b], sizeof(Pack));
    lanesOf(pack, [&](int lane, std::size_t s) {
        Vec3* at = pushes.data() + firstPush_ + kCorners * s;
        for (int k = 0; k < kCorners; ++k) at[k] = laneOf(push.onCorners[k], lane);
        if (loose_[s] < 0) return;
        const Loose& loose = looseElements_[loose_[s]];
        Vec3 onMean;
        for (int a = 0; a < kAxes; ++a) onMean[a] = -laneOf(push.onGrid[a], lane).dot(loose.missing.row(a));
        for (int k = 0; k < kCorners; ++k) at[k] += loose.share[k] * onMean;
    });
}

template <class Contact>
void PressedElements<Contact>::multiply(const AlignedArray<double>& moves, std::vector<Vec3>& pushes)
{
    parallelFor(contact_.size(), kPacksPerTask, [&](std::size_t pack) {
        Moves u;
        for (int k = 0; k < kCorners; ++k)
            for (int l = 0; l < kLanes; ++l) {
                const double* from = moves.data() + cornerSlot_[pack * kLanes + l][k];
                u[k].x[l] = from[0], u[k].y[l] = from[kLanes], u[k].z[l] = from[2 * kLanes];
            }
        const Contact& contact = contact_[pack];
        store(pack, contact.push(contact.change(relative(pack, u), u)), pushes);
    });
}

template <class Contact>
void PressedElements<Contact>::impulses(const ElementContact& contact, std::vector<Vec3>& pushes)
{
    parallelFor(contact_.size(), kPacksPerTask, [&](std::size_t pack) {
        Contact at{};
        typename Contact::Stress stress{};
        lanesOf(pack, [&](int lane, std::size_t s) {
            setElement(at, lane, contact.local(points_.id[s]));
            setStress(stress, lane, contact.stress(points_.id[s]));
        });
        Push push = at.push(stress);
        for (Triple<Pack>& row : push.onGrid) row = -row;
        for (Triple<Pack>& corner : push.onCorners) corner = -corner;
        store(pack, push, pushes);
    });
}

template class PressedElements<EdgeContact<Pack>>;
template class PressedElements<FaceContact<Pack>>;

}  // namespace sim
