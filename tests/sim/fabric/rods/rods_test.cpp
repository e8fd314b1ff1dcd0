#include "sim/fabric/rods/rods.h"
#include "tests/sim/fabric/pieces.h"
#include "tests/sim/fabric/rods/rod_gradient.h"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>

#include <numeric>

namespace sim {
namespace {

using testing::gradientOf;
using testing::Noise;

/// Three yarns of different length in a curved and twisted state, with a section that is turned: elliptic unless told otherwise.
struct CurvedYarns {
    FabricPiece piece;
    Fabric fabric;
    FabricSettings settings;
    FabricState rest, state;

    explicit CurvedYarns(unsigned seed, double amount = 0.3, std::array<double, 2> radius = {0.048, 0.03})
    {
        Noise noise(seed);
        std::vector<FabricGeometry> all;
        piece.material = testing::wool();
        piece.material.sectionRotation = 0.4;
        piece.radius = radius;
        for (int n : {4, 7, 3}) {
            std::vector<int> strand;
            for (int j = 0; j < n; ++j) {
                strand.push_back(static_cast<int>(piece.points.size()));
                piece.points.push_back(Vec3(j, n, 0.0) + 0.2 * noise.vector());
            }
            piece.strands.push_back(strand);
        }
        fabric = testing::fabricOf(piece);
        rest = state = restState(fabric);
        for (Vec3& x : state.x) x += amount * noise.vector();
        for (double& angle : state.theta) angle = amount * noise();
        Rods(fabric, rest, settings).transportFrames(state);
    }
};

double totalEnergy(const Rods& rods, const FabricState& state)
{
    const auto e = rods.energies(state);
    return e[0] + e[1] + e[2];
}

/// The same energy after moving one unknown, with frames carried along.
double movedEnergy(const Rods& rods, FabricState state, std::size_t unknown, double by)
{
    const std::size_t positions = 3 * state.x.size();
    if (unknown < positions) state.x[unknown / 3][unknown % 3] += by;
    else state.theta[unknown - positions] += by;
    rods.transportFrames(state);
    return totalEnergy(rods, state);
}

TEST(Rods, GradientMatchesFiniteDifferences)
{
    for (unsigned seed = 0; seed < 20; ++seed) {
        const CurvedYarns yarns(seed);
        Rods rods(yarns.fabric, yarns.rest, yarns.settings);
        const std::vector<double> gradient = gradientOf(rods, yarns.state);
        double largest = 0.0, error = 0.0;
        constexpr double kStep = 1.0e-5;  // cm or rad: truncation 1e-10 of the forces, round-off 1e-9 of them
        for (std::size_t i = 0; i < gradient.size(); ++i) {
            const double differences = (movedEnergy(rods, yarns.state, i, kStep) - movedEnergy(rods, yarns.state, i, -kStep)) / (2.0 * kStep);
            error = std::max(error, std::abs(differences - gradient[i]));
            largest = std::max(largest, std::abs(gradient[i]));
        }
        EXPECT_LT(error, 1.0e-7 * largest) << "seed " << seed;
    }
}

TEST(Rods, RestShapeIsFreeOfForceAndStaysSoWhenMovedRigidly)
{
    const CurvedYarns yarns(3, 0.0);
    Rods rods(yarns.fabric, yarns.rest, yarns.settings);
    for (double g : gradientOf(rods, yarns.state)) EXPECT_LT(std::abs(g), 1.0e-7);  // dyn; stiffnesses are 1e4
    FabricState moved = yarns.state;
    const Eigen::AngleAxisd turn(0.7, Vec3(1.0, -2.0, 0.5).normalized());
    for (Vec3& x : moved.x) x = turn * x + Vec3(3.0, 4.0, 5.0);
    for (Vec3& u : moved.reference) u = turn * u;
    for (Vec3& t : moved.tangent) t = turn * t;
    for (double g : gradientOf(rods, moved)) EXPECT_LT(std::abs(g), 1.0e-7);
}

/// Energy, and forces and torques in balance, whatever the pose.
TEST(Rods, EnergyIsInvariantAndForcesAndTorquesBalance)
{
    const CurvedYarns yarns(5);
    Rods rods(yarns.fabric, yarns.rest, yarns.settings);
    const double energy = totalEnergy(rods, yarns.state);
    FabricState moved = yarns.state;
    const Eigen::AngleAxisd turn(1.1, Vec3(-1.0, 2.0, 0.3).normalized());
    for (Vec3& x : moved.x) x = turn * x + Vec3(1.0, -2.0, 0.5);
    for (Vec3& u : moved.reference) u = turn * u;
    for (Vec3& t : moved.tangent) t = turn * t;
    EXPECT_NEAR(totalEnergy(rods, moved), energy, 1.0e-12 * energy);

    const std::vector<double> gradient = gradientOf(rods, yarns.state);
    Vec3 force = Vec3::Zero(), torque = Vec3::Zero();
    double scale = 0.0;
    for (std::size_t v = 0; v < yarns.state.x.size(); ++v) {
        const Vec3 f(gradient[3 * v], gradient[3 * v + 1], gradient[3 * v + 2]);
        force += f;
        torque += yarns.state.x[v].cross(f);
        scale += f.norm() * yarns.state.x[v].norm();
    }
    for (std::size_t e = 0; e < yarns.state.theta.size(); ++e) torque += gradient[3 * yarns.state.x.size() + e] * yarns.state.tangent[e];
    EXPECT_LT(force.norm(), 1.0e-11 * scale);
    EXPECT_LT(torque.norm(), 1.0e-10 * scale);
}

Eigen::MatrixXd denseOf(const StrandMatrix& matrix, const StrandLayout::Group& group, int lane, int rows)
{
    Eigen::MatrixXd dense = Eigen::MatrixXd::Zero(rows, rows);
    for (int r = 0; r < rows; ++r)
        for (int k = 0; k < StrandMatrix::kBand && k <= r; ++k) dense(r, r - k) = dense(r - k, r) = matrix.at(group.firstRow + r, k, lane);
    return dense;
}

/// Largest error of the first strand's matrix against differences of its gradient, in parts of its largest entry. Frames that
/// are carried along a detour come back turned, so differences have an antisymmetric part, which a matrix cannot have.
double hessianError(Rods& rods, const Fabric& fabric, const FabricState& state)
{
    StrandMatrix matrix;
    matrix.resize(rods.layout());
    gradientOf(rods, state, &matrix);
    const int strand = rods.layout().strand[0][0], n = fabric.strands.size(strand);  // the longest
    const Eigen::MatrixXd dense = denseOf(matrix, rods.layout().groups[0], 0, 4 * n - 1);
    constexpr double kStep = 1.0e-6;
    Eigen::MatrixXd differences(4 * n - 1, 4 * n - 1);
    for (int column = 0; column < 4 * n - 1; ++column) {
        const auto gradientAt = [&](double by) {
            FabricState s = state;
            if (column % 4 == 3) s.theta[fabric.strands.edgeBegin(strand) + column / 4] += by;
            else s.x[fabric.strands.vertex(strand, column / 4)][column % 4] += by;
            rods.transportFrames(s);
            return gradientOf(rods, s);
        };
        const std::vector<double> up = gradientAt(kStep), down = gradientAt(-kStep);
        for (int row = 0; row < 4 * n - 1; ++row) {
            const std::size_t i =
                row % 4 == 3 ? 3 * state.x.size() + fabric.strands.edgeBegin(strand) + row / 4 : 3 * fabric.strands.vertex(strand, row / 4) + row % 4;
            differences(row, column) = (up[i] - down[i]) / (2.0 * kStep);
        }
    }
    return (0.5 * (differences + differences.transpose()) - dense).cwiseAbs().maxCoeff() / dense.cwiseAbs().maxCoeff();
}

TEST(Rods, HessianIsPositiveAndExactAtRest)
{
    CurvedYarns yarns(7);
    Rods rods(yarns.fabric, yarns.rest, yarns.settings);
    StrandMatrix matrix;
    matrix.resize(rods.layout());
    gradientOf(rods, yarns.state, &matrix);
    const StrandLayout::Group& group = rods.layout().groups[0];
    for (int lane = 0; lane < 3; ++lane) {
        const int rows = 4 * yarns.fabric.strands.size(rods.layout().strand[0][lane]) - 1;
        const Eigen::VectorXd values = Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(denseOf(matrix, group, lane, rows)).eigenvalues();
        EXPECT_GT(values.minCoeff(), -1.0e-12 * values.maxCoeff());
    }
    EXPECT_LT(hessianError(rods, yarns.fabric, yarns.rest), 1.0e-5);
}

/// Straight rods bend with no moment at first order, so that nothing is left out but the torque's part.
TEST(Rods, HessianOfATwistedStraightRodIsExact)
{
    FabricPiece piece;
    piece.material = testing::wool();
    piece.radius = {0.2, 0.2};
    std::vector<int> strand;
    for (int j = 0; j < 7; ++j) {
        strand.push_back(j);
        piece.points.push_back(0.3 * j * Vec3(0.6, 0.0, 0.8));
    }
    piece.strands.push_back(strand);
    const Fabric fabric = testing::fabricOf(piece);
    const FabricState rest = restState(fabric);
    Rods rods(fabric, rest, FabricSettings{});
    rods.includeTwistHessian();
    FabricState twisted = rest;
    for (std::size_t e = 0; e < twisted.theta.size(); ++e) twisted.theta[e] = 0.8 * static_cast<double>(e);
    EXPECT_LT(hessianError(rods, fabric, twisted), 1.0e-6);
}

/// Newton never turns a round yarn beyond where its energy falls: as a function of one twist angle it lies below the quadratic model, also
/// where the yarn is straighter than at rest and the squares of its curvature tell little of how it holds the angle.
TEST(Rods, EnergyOfATurnLiesBelowItsModel)
{
    CurvedYarns yarns(11, 0.3, {0.048, 0.048});
    Rods rods(yarns.fabric, yarns.rest, yarns.settings);
    for (double straight : {0.0, 0.7, 0.95, 0.999}) {
        FabricState state = yarns.state;
        for (Vec3& x : state.x) x.tail<2>() *= 1.0 - straight;
        rods.transportFrames(state);
        StrandMatrix matrix;
        matrix.resize(rods.layout());
        const std::vector<double> gradient = gradientOf(rods, state, &matrix);
        const double before = totalEnergy(rods, state);
        const StrandLayout::Group& group = rods.layout().groups[0];
        for (int j = 0; j < group.edges(); ++j)
            for (int l = 0; l < kLanes; ++l) {
                const int e = rods.layout().edge[group.firstEdge + j][l];
                if (e < 0) continue;
                const std::size_t unknown = 3 * state.x.size() + e;
                const double stiffness = matrix.at(group.firstRow + 4 * j + 3, 0, l);
                for (double turn : {-3.0, -1.0, -0.3, 0.3, 1.0, 3.0}) {
                    const double model = before + gradient[unknown] * turn + 0.5 * stiffness * turn * turn;
                    EXPECT_LE(movedEnergy(rods, state, unknown, turn), model + 1.0e-9 * before) << "edge " << e << " turned by " << turn;
                }
            }
    }
}

TEST(Rods, FactorsSolveWhatTheMatrixMultiplies)
{
    const CurvedYarns yarns(9);
    Rods rods(yarns.fabric, yarns.rest, yarns.settings);
    StrandMatrix matrix;
    matrix.resize(rods.layout());
    gradientOf(rods, yarns.state, &matrix);
    const StrandLayout::Group& group = rods.layout().groups[0];
    for (int r = 0; r < group.rows(); ++r)
        for (int l = 0; l < kLanes; ++l) matrix.at(r, 0, l) += 10.0;
    Noise noise(1);
    std::vector<Pack> x(group.rows()), b(group.rows()), z(group.rows());
    for (Pack& p : x)
        for (int l = 0; l < kLanes; ++l) p[l] = noise();
    matrix.multiply(group, x.data(), b.data());
    matrix.factor(rods.layout());
    matrix.solve(group, b.data(), z.data());
    for (int r = 0; r < group.rows(); ++r)
        for (int l = 0; l < kLanes; ++l) EXPECT_NEAR(z[r][l], x[r][l], 1.0e-9);  // condition about 1e4
}

}  // namespace
}  // namespace sim
