#include "sim/fabric/grid/face_system.h"

namespace sim {

/// Points gather whole rows of faces: those without mass must be 0.
void FaceSystem::clearInactive(BlockArray<double, 3>& u) const
{
    std::size_t next = 0;
    double* data = u.block(0);
    for (int row : rows_) {
        std::fill(data + next, data + row, 0.0);
        next = static_cast<std::size_t>(row) + kLanes;
    }
    std::fill(data + next, data + u.size(), 0.0);
}

FaceSolveReport FaceSystem::solve(double tolerance, int maxIterations, FaceVector& v)
{
    FaceSolveReport report;
    impulses(q_);
    multiply(v, z_);
    const double* mass = mass_.block(0);
    forEachPack([&](bool isFace, std::size_t i) {
        const Pack m = loadPack((isFace ? mass : inertia_.data()) + i);
        residual_.pack(isFace, i) = q_.pack(isFace, i) + (m * v.pack(isFace, i) - z_.pack(isFace, i));
        p_.pack(isFace, i) = inverse_.pack(isFace, i) * residual_.pack(isFace, i);
    });
    clearInactive(p_.faces);
    const auto speedError = [&] {
        const std::size_t n = rows_.size() + inertia_.size() / kLanes;
        return parallelMax(n, [&](std::size_t r) {
            const bool isFace = r < rows_.size();
            const std::size_t i = isFace ? static_cast<std::size_t>(rows_[r]) : (r - rows_.size()) * kLanes;
            const Pack weight =
                isFace ? 1.0 / maxPack(loadPack(mass + i), broadcast(leastMass_)) : loadPack(perTwistSpeed_.data() + i);
            const Pack error = absPack(residual_.pack(isFace, i)) * weight;
            double largest = 0.0;
            for (int l = 0; l < kLanes; ++l) largest = error[l] > largest || error[l] != error[l] ? error[l] : largest;
            return largest;
        });
    };
    const auto energyOf = [&](const FaceVector& a, const FaceVector& b) {
        return sumOverPacks([&](bool isFace, std::size_t i) { return a.pack(isFace, i) * b.pack(isFace, i); });
    };
    double energy = energyOf(residual_, p_);
    report.speedError = speedError();
    while (report.speedError > tolerance && report.iterations < maxIterations) {
        multiply(p_, q_);
        const double curvature = energyOf(p_, q_);
        if (!(curvature > 0.0)) break;
        const double step = energy / curvature;
        forEachPack([&](bool isFace, std::size_t i) {
            v.pack(isFace, i) += step * p_.pack(isFace, i);
            residual_.pack(isFace, i) -= step * q_.pack(isFace, i);
            z_.pack(isFace, i) = inverse_.pack(isFace, i) * residual_.pack(isFace, i);
        });
        ++report.iterations;
        report.speedError = speedError();
        const double next = energyOf(residual_, z_), ratio = next / energy;
        energy = next;
        forEachPack(
            [&](bool isFace, std::size_t i) { p_.pack(isFace, i) = z_.pack(isFace, i) + ratio * p_.pack(isFace, i); });
    }
    return report;
}

}  // namespace sim
