#include "sim/fabric/grid/face_system.h"

#include <cmath>

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

/// Sets r = impulses + M v − A v, and the twist of v to the rates that leave none in r.
void FaceSystem::startSolve(FaceVector& v)
{
    impulses(residual_);
    forEachPack([&](auto isFace, std::size_t i, Pack&) { residual_.pack(isFace, i) += mass(isFace, i) * v.pack(isFace, i); });
    solveTwist(residual_, p_);
    gather(v.faces);
    stiffness_.backSubstituteTwist(in_);
    forEachTwist([&](std::size_t e, int slot) { v.twist[e] = in_[slot] += p_.twist[e]; });
    completeProduct(v, q_);
    forEachPack([&](auto isFace, std::size_t i, Pack&) { residual_.pack(isFace, i) -= q_.pack(isFace, i); });
}

/// Moves v along the expected change to where eᵀ A e is least, and updates the residual.
void FaceSystem::projectInitialGuess(const BlockArray<double, 3>& expected, FaceVector& v)
{
    forEachFacePack([&](std::size_t i, Pack&) { p_.pack(true, i) = select(mass(true, i) > 0.0, loadPack(expected.block(0) + i), broadcast(0.0)); });
    clearInactive(p_.faces);
    const double curvature = applySchurComplement(p_, q_);
    if (!(curvature > 0.0)) return;
    const double part = forEachFacePack([&](std::size_t i, Pack& product) { product += residual_.pack(true, i) * p_.pack(true, i); }) / curvature;
    forEachPack([&](auto isFace, std::size_t i, Pack&) {
        v.pack(isFace, i) += part * p_.pack(isFace, i);
        if constexpr (isFace) residual_.pack(true, i) -= part * q_.pack(true, i);
    });
}

// Preconditioned by M: many vertices of one cell nearly cancel on the fields of a grid, which A's diagonal does not
// know of; where cloth is folded it asks for half as many iterations again. The eigenvalues of M⁻¹ A begin at 1 and end
// at the square of the cells that sound crosses in a step. Twist would have them far from there and is eliminated.
// That none is below 1 bounds the error by what the iterations found, without looking ahead (Meurant and Tichy 2013,
// "On computing quadrature-based bounds for the A-norm of the error in conjugate gradients": Gauss-Radau).
FaceSolveReport FaceSystem::solve(const FaceTolerance& tolerance, FaceVector& v, const BlockArray<double, 3>* expected)
{
    FaceSolveReport report;
    startSolve(v);
    if (expected) projectInitialGuess(*expected, v);
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
    double bound = 1.0;  // of the error's eᵀ A e, relative to rᵀ M⁻¹ r
    const auto speedError = [&] { return totalMass_ > 0.0 ? std::sqrt(bound * energy / totalMass_) : 0.0; };
    report.speedError = speedError();
    while (energy > 0.0 && report.speedError > tolerance.after(report.iterations) && report.iterations < tolerance.maxIterations) {
        const double curvature = applySchurComplement(p_, q_);
        if (!(curvature > 0.0)) break;
        const double step = energy / curvature;
        forEachPack([&](auto isFace, std::size_t i, Pack&) { v.pack(isFace, i) += step * p_.pack(isFace, i); });
        const double next = forEachFacePack([&](std::size_t i, Pack& product) {
            Pack& residual = residual_.pack(true, i);
            const Pack r = residual - step * q_.pack(true, i);
            residual = r;
            product += r * (inverseMass(i) * r);
        });
        const double ratio = next / energy, gap = bound - step;
        bound = gap > 0.0 ? gap / (gap + ratio) : 1.0;
        energy = next;
        ++report.iterations;
        report.speedError = speedError();
        forEachFacePack([&](std::size_t i, Pack&) {
            Pack& p = p_.pack(true, i);
            p = inverseMass(i) * residual_.pack(true, i) + ratio * p;
        });
    }
    report.errorWork = -forEachFacePack([&](std::size_t i, Pack& work) { work += residual_.pack(true, i) * v.pack(true, i); });
    return report;
}

void FaceSystem::balanceMomentum(const BlockArray<double, 3>& start, std::span<const int> groupOfBlock, int groups, FaceVector& v)
{
    impulses(q_);
    left_.assign(groups, Vec3::Zero());
    moving_.assign(groups, Vec3::Zero());
    for (int b = 0; b < blocks(); ++b) {
        const int group = groupOfBlock[b];
        if (group < 0) continue;
        for (int a = 0; a < kAxes; ++a) {
            const double *m = mass_.block(b, a), *impulse = q_.faces.block(b, a), *first = start.block(b, a), *last = v.faces.block(b, a);
            for (int c = 0; c < kBlockCells; ++c)
                if (m[c] > 0.0) left_[group][a] += impulse[c] + m[c] * (first[c] - last[c]), moving_[group][a] += m[c];
        }
    }
    parallelFor(blocks(), 8, [&](std::size_t n) {
        const int b = static_cast<int>(n), group = groupOfBlock[b];
        if (group < 0) return;
        for (int a = 0; a < kAxes; ++a) {
            const double *m = mass_.block(b, a), change = left_[group][a] / moving_[group][a];
            double* u = v.faces.block(b, a);
            for (int c = 0; c < kBlockCells; ++c)
                if (m[c] > 0.0) u[c] += change;
        }
    });
}

}  // namespace sim
