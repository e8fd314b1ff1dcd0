// Products and solutions with the stiffness of vertices and of strands, against plain loops over all of them.
#include "tests/sim/fabric/grid/grid_runs.h"

#include <gtest/gtest.h>

namespace sim::testing {
namespace {

constexpr double kStep = 2.0e-4;

TEST(GridVertexStiffness, ClothEqualsItsMatrix)
{
    const std::vector<FabricPiece> pieces = {cloth(12)};
    GridParts parts(pieces, gridSettings(TransferMethod::PolyPic));
    Noise noise(8);
    for (Vec3& x : parts.state.x) x += 0.01 * noise.vector();
    parts.assembleForces(kStep);
    Shells shells(parts.fabric, FabricSettings());
    const VertexUnknowns& unknowns = parts.stiffness.unknowns();
    AlignedArray<double> gradient(unknowns.size), in(unknowns.size), out(unknowns.size);
    BlockMatrix matrix = shells.matrix();
    matrix.clear();
    shells.startStep(parts.state.x).forces(parts.state.x, kStep, unknowns.slot, gradient, &matrix);
    const std::vector<int>& vertices = shells.vertices();
    for (int v : vertices) parts.stiffness.set(in, v, noise.vector());
    parts.stiffness.multiply(in, out);
    std::vector<Vec3> expected(matrix.rows(), Vec3::Zero());
    for (int row = 0; row < matrix.rows(); ++row)
        for (int e = matrix.begin(row); e < matrix.begin(row + 1); ++e) {
            const int column = matrix.column(e);
            const Eigen::Map<const Mat3> block(matrix.block(e));
            expected[row] += block * parts.stiffness.at(in, vertices[column]);
            if (column != row) expected[column] += block.transpose() * parts.stiffness.at(in, vertices[row]);
        }
    for (int row = 0; row < matrix.rows(); ++row)
        EXPECT_LT((parts.stiffness.at(out, vertices[row]) - expected[row]).norm(), 1e-12 * expected[row].norm());
}

/// Strands of two vertices, of more, and held ones.
TEST(TwistElimination, LeavesNoTorque)
{
    std::vector<FabricPiece> pieces;
    for (int edges : {1, 2, 7, 3}) {
        pieces.push_back(pieceOf(strand(Vec3(0.0, edges, 0.0), Vec3(0.3 * edges, edges, 0.4), edges), wool(), {0.06, 0.04}));
        PinGroup pin;
        pin.vertices = {0};
        pin.twist = edges == 7;
        pieces.back().pins = {pin};
    }
    GridParts parts(pieces, gridSettings(TransferMethod::PolyPic));
    Noise noise(8);
    for (Vec3& x : parts.state.x) x += 0.03 * noise.vector();
    parts.stiffness.rods().transportFrames(parts.state);
    parts.assembleForces(kStep);
    const std::vector<double>& inertia = parts.fabric.edges.twistInertia;
    parts.stiffness.factorTwist(inertia, kStep);
    AlignedArray<double> u(parts.stiffness.unknowns().size), torque(u.size());
    for (std::size_t v = 0; v < parts.state.x.size(); ++v) parts.stiffness.set(u, static_cast<int>(v), noise.vector());
    const std::vector<int>& slot = parts.stiffness.unknowns().twistSlot;
    const auto impulse = [&](std::size_t e) { return inertia[e] * u[slot[e]] + kStep * kStep * torque[slot[e]]; };

    for (int s : slot) u[s] = noise();
    parts.stiffness.backSubstituteTwist(u);
    parts.stiffness.multiply(u, torque);
    double size = 0.0;
    for (std::size_t e = 0; e < slot.size(); ++e) size = std::max(size, std::abs(inertia[e] * u[slot[e]]));
    ASSERT_GT(size, 0.0);
    for (std::size_t e = 0; e < slot.size(); ++e) EXPECT_NEAR(impulse(e), 0.0, 1e-10 * size) << "edge " << e;

    std::vector<double> given;
    u.fill(0.0);
    for (int s : slot) given.push_back(u[s] = noise());
    parts.stiffness.solveTwist(u);
    parts.stiffness.multiply(u, torque);
    for (std::size_t e = 0; e < slot.size(); ++e) EXPECT_NEAR(impulse(e), given[e], 1e-10) << "edge " << e;
}

TEST(StrandMatrix, ProductEqualsAPlainLoop)
{
    for (int vertices : {2, 3, 4, 30}) {
        const std::vector<FabricPiece> pieces = {pieceOf(strand(Vec3::Zero(), Vec3(3.0, 0.0, 0.0), vertices - 1), wool(), {0.05, 0.05})};
        const Fabric fabric = assembleFabric(pieces);
        const StrandLayout layout(fabric.strands);
        StrandMatrix matrix;
        matrix.resize(layout);
        Noise noise(9);
        AlignedArray<double> x(layout.rows * kLanes), y(x.size());
        for (int row = 0; row < layout.rows; ++row) {
            x[row * kLanes] = noise();
            for (int k = 0; k <= std::min(row, StrandMatrix::kBand - 1); ++k) matrix.at(row, k, 0) = noise();
        }
        matrix.multiply(layout.groups[0], reinterpret_cast<Pack*>(x.data()), reinterpret_cast<Pack*>(y.data()));
        for (int row = 0; row < layout.rows; ++row) {
            double sum = 0.0;
            for (int other = 0; other < layout.rows; ++other) {
                const int k = std::abs(row - other);
                if (k < StrandMatrix::kBand) sum += matrix.at(std::max(row, other), k, 0) * x[other * kLanes];
            }
            EXPECT_NEAR(y[row * kLanes], sum, 1e-13) << vertices << " vertices, row " << row;
        }
    }
}

}  // namespace
}  // namespace sim::testing
