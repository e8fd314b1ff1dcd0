#include "sim/fabric/grid/face_system.h"

namespace sim {

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

double FaceSystem::Sums::largestLane() const
{
    double found = 0.0;
    for (int l = 0; l < kLanes; ++l) found = largest[l] > found || largest[l] != largest[l] ? largest[l] : found;
    return found;
}

/// |residual| / mass; of twist: of the surface that it turns [cm/s].
Pack FaceSystem::speedError(bool isFace, std::size_t i, Pack residual) const
{
    const Pack size = absPack(residual);
    return isFace ? size / maxPack(mass(true, i), broadcast(leastMass_)) : size * loadPack(perTwistSpeed_.data() + i);
}

FaceSolveReport FaceSystem::solve(double tolerance, int maxIterations, FaceVector& v)
{
    FaceSolveReport report;
    impulses(residual_);
    multiply(v, q_);
    Sums found = forEachPack([&](auto isFace, std::size_t i, Sums& sum) {
        Pack& r = residual_.pack(isFace, i);
        r += mass(isFace, i) * v.pack(isFace, i) - q_.pack(isFace, i);
        const Pack z = inverse_.pack(isFace, i) * r;
        p_.pack(isFace, i) = z;
        sum.product += r * z;
        sum.take(speedError(isFace, i, r));
    });
    clearInactive(p_.faces);
    double energy = sumLanes(found.product);
    report.speedError = found.largestLane();
    while (report.speedError > tolerance && report.iterations < maxIterations) {
        const double curvature = multiplyAndDot(p_, q_);
        if (!(curvature > 0.0)) break;
        const double step = energy / curvature;
        found = forEachPack([&](auto isFace, std::size_t i, Sums& sum) {
            v.pack(isFace, i) += step * p_.pack(isFace, i);
            Pack& residual = residual_.pack(isFace, i);
            const Pack r = residual - step * q_.pack(isFace, i);
            residual = r;
            sum.product += r * (inverse_.pack(isFace, i) * r);
            sum.take(speedError(isFace, i, r));
        });
        ++report.iterations;
        report.speedError = found.largestLane();
        const double next = sumLanes(found.product), ratio = next / energy;
        energy = next;
        forEachPack([&](auto isFace, std::size_t i, Sums&) {
            Pack& p = p_.pack(isFace, i);
            p = inverse_.pack(isFace, i) * residual_.pack(isFace, i) + ratio * p;
        });
    }
    return report;
}

}  // namespace sim
