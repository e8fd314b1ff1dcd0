#include "sim/fabric/grid/face_system.h"

#include <cmath>
#include <numeric>

namespace sim {

namespace {

// Every iteration takes a known part from the error's energy eᵀ A e. The last few parts are close to all that there was
// before them (Hestenes and Stiefel 1952; Strakos and Tichy 2002), and A is no smaller than M.
constexpr int kDelay = 4;
constexpr double kRoundOff = 1.0e-6;  ///< of the tolerance [-]

}  // namespace

/// Points gather whole rows of faces: those without mass must be 0.
void FaceSystem::clearInactive(BlockArray<double, 3>& u) const
{
    std::size_t next = 0;
    double* data = u.block(0);
    for (int row : rows_.first) {
        std::fill(data + next, data + row, 0.0);
        next = static_cast<std::size_t>(row) + kLanes;
    }
    std::fill(data + next, data + u.size(), 0.0);
}

/// r = impulses + M v − A v, with none left on twist: its rates in v take that up.
void FaceSystem::startSolve(FaceVector& v)
{
    impulses(residual_);
    multiply(v, q_);
    forEachPack([&](auto isFace, std::size_t i, Pack&) {
        residual_.pack(isFace, i) += mass(isFace, i) * v.pack(isFace, i) - q_.pack(isFace, i);
    });
    if (edges() == 0) return;
    takeUpTwist(residual_, p_);
    multiply(p_, q_);
    forEachPack([&](auto isFace, std::size_t i, Pack&) {
        residual_.pack(isFace, i) -= q_.pack(isFace, i);
        if constexpr (!isFace) v.pack(isFace, i) += p_.pack(isFace, i);
    });
}

/// v and r as far along the expected change as makes eᵀ A e least.
void FaceSystem::goAlong(const BlockArray<double, 3>& expected, FaceVector& v)
{
    p_.faces = expected;
    clearInactive(p_.faces);
    const double curvature = multiplyFollowed(p_, q_);
    if (!(curvature > 0.0)) return;
    const double part = forEachFacePack([&](std::size_t i, Pack& product) {
        product += residual_.pack(true, i) * p_.pack(true, i);
    }) / curvature;
    forEachPack([&](auto isFace, std::size_t i, Pack&) {
        v.pack(isFace, i) += part * p_.pack(isFace, i);
        if constexpr (isFace) residual_.pack(true, i) -= part * q_.pack(true, i);
    });
}

// Preconditioned by M: many vertices of one cell nearly cancel on the fields of a grid, which A's diagonal does not
// know of; where cloth is folded it asks for half as many iterations again. The eigenvalues of M⁻¹ A begin at 1 and end
// at the square of the cells that sound crosses in a step. Twist would have them far from there and is eliminated.
FaceSolveReport FaceSystem::solve(double tolerance, int maxIterations, FaceVector& v,
                                  const BlockArray<double, 3>* expected)
{
    FaceSolveReport report;
    startSolve(v);
    if (expected) goAlong(*expected, v);
    const auto inverseMass = [&](std::size_t i) {
        const Pack m = mass(true, i);
        return select(m > 0.0, 1.0 / m, broadcast(0.0));
    };
    double energy = forEachFacePack([&](std::size_t i, Pack& product) {
        const Pack r = residual_.pack(true, i), z = inverseMass(i) * r;
        p_.pack(true, i) = z;
        product += r * z;
    });
    clearInactive(p_.faces);
    std::array<double, kDelay> gains{};
    const auto speedOf = [&](double e) { return totalMass_ > 0.0 ? std::sqrt(e / totalMass_) : 0.0; };
    report.speedError = speedOf(energy);
    // Fewer iterations than the delay only where the residual is round-off.
    const auto isEnough = [&] {
        return report.speedError < (report.iterations < kDelay ? kRoundOff : 1.0) * tolerance;
    };
    while (energy > 0.0 && !isEnough() && report.iterations < maxIterations) {
        const double curvature = multiplyFollowed(p_, q_);
        if (!(curvature > 0.0)) break;
        const double step = energy / curvature;
        forEachPack([&](auto isFace, std::size_t i, Pack&) { v.pack(isFace, i) += step * p_.pack(isFace, i); });
        const double next = forEachFacePack([&](std::size_t i, Pack& product) {
            Pack& residual = residual_.pack(true, i);
            const Pack r = residual - step * q_.pack(true, i);
            residual = r;
            product += r * (inverseMass(i) * r);
        });
        gains[report.iterations++ % kDelay] = step * energy;
        report.speedError = speedOf(std::accumulate(gains.begin(), gains.end(), 0.0));
        const double ratio = next / energy;
        energy = next;
        forEachFacePack([&](std::size_t i, Pack&) {
            Pack& p = p_.pack(true, i);
            p = inverseMass(i) * residual_.pack(true, i) + ratio * p;
        });
    }
    return report;
}

}  // namespace sim
