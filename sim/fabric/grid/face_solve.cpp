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

FaceSolveReport FaceSystem::solve(double tolerance, int maxIterations, FaceVector& v)
{
    FaceSolveReport report;
    impulses(residual_);
    multiply(v, q_);
    double energy = forEachPack([&](auto isFace, std::size_t i, Pack& product) {
        Pack& r = residual_.pack(isFace, i);
        r += mass(isFace, i) * v.pack(isFace, i) - q_.pack(isFace, i);
        const Pack z = inverse_.pack(isFace, i) * r;
        p_.pack(isFace, i) = z;
        product += r * z;
    });
    clearInactive(p_.faces);
    std::array<double, kDelay> gains{};
    const auto speedOf = [&](double e) { return totalMass_ > 0.0 ? std::sqrt(e / totalMass_) : 0.0; };
    report.speedError = speedOf(energy);
    // Fewer iterations than the delay only where the residual is round-off.
    const auto isEnough = [&] { return report.speedError < (report.iterations < kDelay ? kRoundOff : 1.0) * tolerance; };
    while (energy > 0.0 && !isEnough() && report.iterations < maxIterations) {
        const double curvature = multiplyAndDot(p_, q_);
        if (!(curvature > 0.0)) break;
        const double step = energy / curvature;
        const double next = forEachPack([&](auto isFace, std::size_t i, Pack& product) {
            v.pack(isFace, i) += step * p_.pack(isFace, i);
            Pack& residual = residual_.pack(isFace, i);
            const Pack r = residual - step * q_.pack(isFace, i);
            residual = r;
            product += r * (inverse_.pack(isFace, i) * r);
        });
        gains[report.iterations++ % kDelay] = step * energy;
        report.speedError = speedOf(std::accumulate(gains.begin(), gains.end(), 0.0));
        const double ratio = next / energy;
        energy = next;
        forEachPack([&](auto isFace, std::size_t i, Pack&) {
            Pack& p = p_.pack(isFace, i);
            p = inverse_.pack(isFace, i) * residual_.pack(isFace, i) + ratio * p;
        });
    }
    return report;
}

}  // namespace sim
