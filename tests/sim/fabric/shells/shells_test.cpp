#include "sim/fabric/shells/shells.h"
#include "tests/sim/fabric/pieces.h"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>

#include <numeric>

namespace sim {
namespace {

using testing::Noise;

/// A small sheet, deformed at random.
struct CrumpledSheet {
    Fabric fabric;
    std::vector<Vec3> x;
    std::vector<int> slot;

    explicit CrumpledSheet(unsigned seed, const FabricMaterial& material = testing::wool(), double amount = 0.15, Vec2i nodes = {4, 3})
    {
        Noise noise(seed);
        ClothGrid grid{.nodes = nodes, .spacing = {0.5, 0.4}};
        FabricGeometry geometry = clothGrid(grid);
        for (Vec3& p : geometry.points) p += 0.05 * noise.vector();
        FabricPiece piece = testing::pieceOf(geometry, material, {0.05, 0.05});
        piece.warp = Vec3(1.0, 0.2, 0.7).normalized();
        fabric = testing::fabricOf(piece);
        x = fabric.rest;
        for (Vec3& p : x) p += amount * noise.vector();
        for (std::size_t v = 0; v < x.size(); ++v) slot.push_back(static_cast<int>(v / kLanes * 3 * kLanes + v % kLanes));
    }

    std::vector<double> gradient(Shells& shells, std::span<const Vec3> at, BlockMatrix* matrix = nullptr) const
    {
        std::vector<double> packed((x.size() + kLanes) * 3, 0.0), g;
        shells.startStep(at).forces(at, 1.0, slot, packed, matrix);
        for (std::size_t v = 0; v < x.size(); ++v)
            for (int a = 0; a < 3; ++a) g.push_back(packed[slot[v] + a * kLanes]);
        return g;
    }
};

double totalEnergy(const Shells& shells, std::span<const Vec3> x)
{
    const auto e = shells.energies(x);
    return e[0] + e[1];
}

struct Model {
    const char* name = "";
    FabricSettings settings = {};
    FabricMaterial material = testing::wool();
};

std::vector<Model> allModels()
{
    std::vector<Model> models(6);
    models[0].name = "stvk, shape operator";
    models[1].name = "neo-hookean, hinge angle";
    models[1].settings.membrane = MembraneModel::NeoHookean;
    models[1].settings.bending = BendingModel::Hinge;
    models[2].name = "hinge sin";
    models[2].settings.bending = BendingModel::Hinge;
    models[2].settings.hingeMeasure = HingeMeasure::Sin;
    models[3].name = "hinge tan";
    models[3].settings.bending = BendingModel::Hinge;
    models[3].settings.hingeMeasure = HingeMeasure::Tan;
    models[4].name = "neo-hookean, shape operator";
    models[4].settings.membrane = MembraneModel::NeoHookean;
    models[5].name = "warp and weft";
    models[5].material.stretchStiffness = {8.0e5, 2.0e5};
    models[5].material.shearStiffness = 3.0e4;
    models[5].material.bendingStiffness = {900.0, 250.0};
    return models;
}

TEST(Shells, GradientMatchesFiniteDifferences)
{
    for (const Model& model : allModels())
        for (unsigned seed = 0; seed < 5; ++seed) {
            CrumpledSheet sheet(seed, model.material);
            Shells shells(sheet.fabric, model.settings);
            const std::vector<double> gradient = sheet.gradient(shells, sheet.x);
            double largest = 0.0, error = 0.0;
            constexpr double kStep = 1.0e-5;  // cm
            for (std::size_t i = 0; i < gradient.size(); ++i) {
                std::vector<Vec3> up = sheet.x, down = sheet.x;
                up[i / 3][i % 3] += kStep;
                down[i / 3][i % 3] -= kStep;
                const double differences = (totalEnergy(shells, up) - totalEnergy(shells, down)) / (2.0 * kStep);
                error = std::max(error, std::abs(differences - gradient[i]));
                largest = std::max(largest, std::abs(gradient[i]));
            }
            EXPECT_LT(error, 1.0e-7 * largest) << model.name << ", seed " << seed;
        }
}

/// A sheet folded about its middle, whose threads lie there.
std::vector<Vec3> folded(const Fabric& fabric, double angle)
{
    std::vector<Vec3> x = fabric.rest;
    const Vec3 middle = std::accumulate(x.begin(), x.end(), Vec3(0.0, 0.0, 0.0)) / static_cast<double>(x.size());
    const Eigen::AngleAxisd fold(angle, Vec3::UnitZ()), turn(0.7, Vec3(1.0, -0.3, 0.4).normalized());
    for (Vec3& p : x) {
        p -= middle;
        p = turn * (p.x() > 1.0e-9 ? Vec3(fold * p) : p);
    }
    return x;
}

/// Pressed flat, either way, a fold holds no more than some times what it does when it is all but closed, 150 degrees, and its forces are still the
/// derivatives of its energy.
TEST(Shells, FoldsThatArePressedFlatHoldBoundedEnergy)
{
    ClothGrid grid{.nodes = {3, 4}, .spacing = {0.5, 0.4}};
    const Fabric fabric = testing::fabricOf(testing::pieceOf(clothGrid(grid), testing::wool(), {0.05, 0.05}));
    CrumpledSheet sheet(3, testing::wool(), 0.0, {3, 4});
    sheet.fabric = fabric;
    constexpr double kFlat = 3.14159, kStep = 1.0e-6;  // rad, cm
    for (const Model& model : allModels()) {
        Shells shells(fabric, model.settings);
        for (const double way : {-1.0, 1.0}) {
            const double closed = totalEnergy(shells, folded(fabric, way * 2.618)), flat = totalEnergy(shells, folded(fabric, way * kFlat));
            EXPECT_GT(closed, 1.0) << model.name;
            EXPECT_LT(flat, 5.0 * closed) << model.name << ", " << way;
            for (const double angle : {2.4, 2.6, 2.63, 2.9, 3.1}) {
                const std::vector<Vec3> x = folded(fabric, way * angle);
                const std::vector<double> gradient = sheet.gradient(shells, x);
                double largest = 0.0, error = 0.0;
                for (std::size_t i = 0; i < gradient.size(); ++i) {
                    std::vector<Vec3> up = x, down = x;
                    up[i / 3][i % 3] += kStep;
                    down[i / 3][i % 3] -= kStep;
                    const double differences = (totalEnergy(shells, up) - totalEnergy(shells, down)) / (2.0 * kStep);
                    error = std::max(error, std::abs(differences - gradient[i]));
                    largest = std::max(largest, std::abs(gradient[i]));
                }
                EXPECT_LT(error, 1.0e-6 * largest) << model.name << ", " << way * angle;
            }
        }
    }
}

Eigen::MatrixXd denseOf(const BlockMatrix& matrix)
{
    Eigen::MatrixXd dense = Eigen::MatrixXd::Zero(3 * matrix.rows(), 3 * matrix.rows());
    for (int row = 0; row < matrix.rows(); ++row)
        for (int e = matrix.begin(row); e < matrix.begin(row + 1); ++e)
            for (int i = 0; i < 9; ++i) {
                const int p = 3 * row + i % 3, q = 3 * matrix.column(e) + i / 3;
                dense(p, q) = matrix.block(e)[i];
                if (matrix.column(e) != row) dense(q, p) = matrix.block(e)[i];
            }
    return dense;
}

TEST(Shells, HessianIsSymmetricPositiveAndExactAtRest)
{
    for (const Model& model : allModels()) {
        CrumpledSheet sheet(11, model.material);
        Shells shells(sheet.fabric, model.settings);
        BlockMatrix matrix = shells.matrix();
        matrix.clear();
        sheet.gradient(shells, sheet.x, &matrix);
        const Eigen::MatrixXd crumpled = denseOf(matrix);
        EXPECT_LT((crumpled - crumpled.transpose()).norm(), 1.0e-12 * crumpled.norm()) << model.name;
        const Eigen::VectorXd values = Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(crumpled).eigenvalues();
        EXPECT_GT(values.minCoeff(), -1.0e-12 * values.maxCoeff()) << model.name;

        matrix.clear();
        sheet.gradient(shells, sheet.fabric.rest, &matrix);
        const Eigen::MatrixXd dense = denseOf(matrix);
        constexpr double kStep = 1.0e-6;
        double error = 0.0;
        for (int column = 0; column < dense.cols(); ++column) {
            std::vector<Vec3> up = sheet.fabric.rest, down = up;
            up[column / 3][column % 3] += kStep;
            down[column / 3][column % 3] -= kStep;
            const std::vector<double> gu = sheet.gradient(shells, up), gd = sheet.gradient(shells, down);
            for (int row = 0; row < dense.rows(); ++row) error = std::max(error, std::abs((gu[row] - gd[row]) / (2.0 * kStep) - dense(row, column)));
        }
        EXPECT_LT(error, 1.0e-5 * dense.cwiseAbs().maxCoeff()) << model.name;
    }
}

TEST(Shells, EnergyIsInvariantAndForcesBalance)
{
    for (const Model& model : allModels()) {
        CrumpledSheet sheet(13, model.material);
        Shells shells(sheet.fabric, model.settings);
        const double energy = totalEnergy(shells, sheet.x);
        std::vector<Vec3> moved = sheet.x;
        const Eigen::AngleAxisd turn(1.1, Vec3(-1.0, 2.0, 0.3).normalized());
        for (Vec3& p : moved) p = turn * p + Vec3(1.0, -2.0, 0.5);
        EXPECT_NEAR(totalEnergy(shells, moved), energy, 1.0e-12 * energy) << model.name;
        const std::vector<double> g = sheet.gradient(shells, sheet.x);
        Vec3 force = Vec3::Zero(), torque = Vec3::Zero();
        double scale = 0.0;
        for (std::size_t v = 0; v < sheet.x.size(); ++v) {
            const Vec3 f(g[3 * v], g[3 * v + 1], g[3 * v + 2]);
            force += f;
            torque += sheet.x[v].cross(f);
            scale += f.norm();
        }
        EXPECT_LT(force.norm(), 1.0e-12 * scale) << model.name;
        EXPECT_LT(torque.norm(), 1.0e-11 * scale) << model.name;
    }
}

/// A sheet rolled onto a cylinder stores ½ D κ² per area (ν = 0 and 0.3): along the threads and, the mesh being what it
/// is, across them.
TEST(Shells, ShapeOperatorHasThePlatesStiffness)
{
    for (const bool alongX : {true, false})
        for (const double nu : {0.0, 0.3}) {
            ClothGrid grid{.nodes = {41, 41}, .spacing = {0.1, 0.1}};
            FabricMaterial material = testing::wool();
            material.poisson = nu;
            const Fabric fabric = testing::fabricOf(testing::pieceOf(clothGrid(grid), material, {0.02, 0.02}));
            Shells shells(fabric, FabricSettings{});
            const double radius = 10.0, thickness = 0.04;
            std::vector<Vec3> x = fabric.rest;
            for (Vec3& p : x) {
                const double s = alongX ? p.x() : p.z();
                const double along = radius * std::sin(s / radius), up = radius * (1.0 - std::cos(s / radius));
                p = alongX ? Vec3(along, up, p.z()) : Vec3(p.x(), up, along);
            }
            const double plate = material.packing() * material.young * std::pow(thickness, 3) / (12.0 * (1.0 - nu * nu));
            const double inner = 3.8 * 3.8;  // the boundary triangles have edges without an angle; they are left out by the bounds below
            const double energy = shells.energies(x)[1], perArea = 0.5 * plate / (radius * radius);
            EXPECT_GT(energy, 0.98 * perArea * inner);
            EXPECT_LT(energy, 1.02 * perArea * 16.0);
        }
}

/// A vertex inside a regular mesh: those of the faces around it, those across one edge more, those across two edges of
/// one face.
TEST(Shells, HessianOfHingesTiesFewerVertices)
{
    const CrumpledSheet sheet(5, testing::wool(), 0.1, {9, 9});
    FabricSettings settings;
    constexpr int kMiddle = 4 * 9 + 4;
    const auto blocksInRow = [&](BendingModel bending) {
        settings.bending = bending;
        const BlockMatrix matrix = Shells(sheet.fabric, settings).matrix();
        return matrix.begin(kMiddle + 1) - matrix.begin(kMiddle) + static_cast<int>(matrix.left(kMiddle).size());
    };
    EXPECT_EQ(blocksInRow(BendingModel::ShapeOperator), 1 + 6 + 6 + 6);
    EXPECT_EQ(blocksInRow(BendingModel::Hinge), 1 + 6 + 6);
}

TEST(Shells, MeshesOfMixedOrientationAreRefused)
{
    const std::vector<Vec3i> faces = {{0, 1, 2}, {0, 1, 3}};
    EXPECT_ANY_THROW(verticesAcross(faces));
    const std::vector<Vec3i> good = {{0, 1, 2}, {1, 0, 3}};
    EXPECT_EQ(verticesAcross(good)[0][2], 3);
    EXPECT_EQ(verticesAcross(good)[1][2], 2);
}

}  // namespace
}  // namespace sim
