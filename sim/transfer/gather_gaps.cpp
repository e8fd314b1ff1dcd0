#include "sim/transfer/gather.h"
#include "sim/transfer/reference.h"

#include <Eigen/Cholesky>

namespace sim {

namespace {

constexpr int kFewestFaces = 14;              ///< for a fit of mean and gradient (model-fluid 4.8)
constexpr double kWorstConditioning = 1.0e-3; ///< smallest pivot relative to the largest that still counts as regular

}  // namespace

std::array<std::array<double, 4>, kAxes> gatherWithGaps(const FaceFields& faces, const BlockArray<double, 3>& velocity, const BlockGrid& grid,
                                                        const Vec3& x, int modes)
{
    std::array<std::array<double, 4>, kAxes> out{};
    for (int axis = 0; axis < kAxes; ++axis) {
        const Stencil stencil(grid, axis, x);
        Eigen::Matrix4d normal = Eigen::Matrix4d::Zero();
        Eigen::Vector4d rhs = Eigen::Vector4d::Zero();
        int valid = 0;
        for (int k = 0; k < 3; ++k)
            for (int j = 0; j < 3; ++j)
                for (int i = 0; i < 3; ++i) {
                    const CellRef face = faceOfCell(grid, stencil.first + Vec3i(i, j, k));
                    if (!faces.valid.test(face.block, face.cell, axis)) continue;
                    ++valid;
                    const Eigen::Vector4d row(1.0, stencil.basis[0].z[i], stencil.basis[1].z[j], stencil.basis[2].z[k]);
                    const double w = stencil.weight(i, j, k);
                    normal += w * row * row.transpose();
                    rhs += w * velocity.block(face.block, axis)[face.cell] * row;
                }
        if (normal(0, 0) <= 0.0) continue;  // no face at all: the particle comes to rest
        out[axis][0] = rhs[0] / normal(0, 0);
        if (modes < 4 || valid < kFewestFaces) continue;
        const Eigen::LDLT<Eigen::Matrix4d> factor(normal);
        const Eigen::Vector4d pivots = factor.vectorD();
        if (pivots.minCoeff() < kWorstConditioning * pivots.maxCoeff()) continue;
        const Eigen::Vector4d fit = factor.solve(rhs);
        for (int r = 0; r < 4; ++r) out[axis][r] = fit[r];
    }
    return out;
}

}  // namespace sim
