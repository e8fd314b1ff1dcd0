#include "sim/fabric/contact/contact_parts.h"

namespace sim {

using namespace contact;

/// body(seeker, pair, direction from the seeker to the other) for the active pairs that may have bridges: yarns seek yarns, vertices faces.
template <class Body>
void FabricContact::Parts::forEachSeeker(Body&& body) const
{
    const Primitives& primitives = list.primitives();
    for (std::size_t i = 0; i < active.size(); ++i) {
        if (!(frictionPairs[i].bridge > 0.0)) continue;
        const int a = active.between[i][0], b = active.between[i][1];
        const bool areEdges = primitives.kind(a) == PairKind::EdgeEdge;
        if (areEdges && (primitives.strand[a] < 0 || primitives.strand[b] < 0)) continue;
        body(a, i, Vec3(-active.normal[i]));
        if (areEdges) body(b, i, active.normal[i]);
    }
}

/// A seeker's part of the force of a pair's bridge [dyn]. Yarns that cross touch along their width.
double FabricContact::Parts::bridgeForceOf(int seeker, std::size_t i, std::span<const Vec3> x) const
{
    const Primitives& primitives = list.primitives();
    const std::array<int, 4>& v = active.vertices[i];
    const std::array<double, 4>& c = active.weights[i];
    if (primitives.kind(seeker) == PairKind::VertexFace) return cohesion->onFace(v[0], {v[1], v[2], v[3]}, {-c[1], -c[2], -c[3]});
    const int other = active.between[i][active.between[i][0] == seeker ? 1 : 0];
    const Vec3 first = x[v[1]] - x[v[0]], second = x[v[3]] - x[v[2]];
    const double length = (active.between[i][0] == seeker ? first : second).norm();
    const double along = std::abs(first.normalized().dot(second.normalized()));
    return std::min(1.0, along + 2.0 * primitives.radius[other] / length) * cohesion->onYarn(seeker);
}

/// Each vertex and yarn edge has a bridge to what is nearest, and one to what is nearest on its other side.
void FabricContact::Parts::findBridges(std::span<const Vec3> x)
{
    for (std::vector<int>* best : {&nearest, &opposite}) best->assign(list.primitives().firstFace(), -1);
    const auto isNearer = [&](std::size_t i, int than) {
        return than < 0 || frictionPairs[i].apart.squaredNorm() < frictionPairs[than].apart.squaredNorm();
    };
    const auto direction = [&](int seeker, int i) -> Vec3 { return active.between[i][0] == seeker ? Vec3(-active.normal[i]) : active.normal[i]; };
    forEachSeeker([&](int seeker, std::size_t i, const Vec3&) {
        if (isNearer(i, nearest[seeker])) nearest[seeker] = static_cast<int>(i);
    });
    forEachSeeker([&](int seeker, std::size_t i, const Vec3& towards) {
        if (towards.dot(direction(seeker, nearest[seeker])) < 0.0 && isNearer(i, opposite[seeker])) opposite[seeker] = static_cast<int>(i);
    });
    forEachSeeker([&](int seeker, std::size_t i, const Vec3&) {
        const int slot = static_cast<int>(i);
        if (slot == nearest[seeker] || slot == opposite[seeker]) frictionPairs[i].pull += bridgeForceOf(seeker, i, x);
    });
    for (std::size_t i = 0; i < active.size(); ++i) active.force[i] += frictionPairs[i].pull * active.normal[i];
}

}  // namespace sim
