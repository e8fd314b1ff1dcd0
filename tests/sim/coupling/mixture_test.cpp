#include "tests/sim/coupling/bath.h"

#include "sim/coupling/mixture.h"
#include "tests/sim/fabric/pieces.h"
#include "tests/sim/liquid/grid_scene.h"

#include <gtest/gtest.h>

namespace sim::test {
namespace {

/// What drag takes from one phase it gives to the other, and it makes no energy.
TEST(Mixture, DragKeepsMomentumAndMakesNoEnergy)
{
    Bath bath;
    Mixture mixture(bath.fabric, bath.settings);
    ASSERT_TRUE(reachesLiquid(bath.scene.grid, bath.state));
    ASSERT_TRUE(bath.find(mixture));
    const Vec3 liquidBefore = mixture.liquidMomentum(*bath.shared, bath.scene.liquid), fabricBefore = bath.fabricMomentum();
    const double size = fabricBefore.norm() + liquidBefore.norm();
    const auto energy = [&] {
        double sum = 0.0;
        for (std::size_t v = 0; v < bath.state.v.size(); ++v) sum += 0.5 * bath.fabric.mass[v] * bath.state.v[v].squaredNorm();
        return sum + mixture.kinetic(*bath.shared, bath.scene.liquid.faces.velocity);
    };
    const double before = energy();

    bath.exchange(mixture);

    const Vec3 moved = bath.fabricMomentum() - fabricBefore;
    EXPECT_GT(moved.norm(), 1.0e-3 * size);
    EXPECT_LT((mixture.liquidMomentum(*bath.shared, bath.scene.liquid) + bath.fabricMomentum() - liquidBefore - fabricBefore).norm(), 1.0e-13 * size);
    EXPECT_LT(energy(), before);
}

/// The same where the fabric's velocities are on faces (coupling/README.md, Mixture).
TEST(Mixture, DragOnFacesKeepsMomentumAndMakesNoEnergy)
{
    Bath bath;
    GridScene& scene = bath.scene;
    Mixture mixture(bath.fabric, bath.settings);
    ASSERT_TRUE(bath.find(mixture));
    FabricOnFaces fabric = bath.onFaces();
    const Vec3 liquidBefore = mixture.liquidMomentum(*bath.shared, scene.liquid);
    const double energyBefore = mixture.kinetic(*bath.shared, scene.liquid.faces.velocity);
    const Mixture::AppliedPressure applied = mixture.applyPressure(bath.eliminateDragWithoutPressure(mixture), scene.liquid);
    const FaceLoads loads = mixture.faceLoads(applied);
    Vec3 gained = Vec3::Zero();
    double gainedEnergy = 0.0;
    for (int b = 0; b < fabric.grid().count(); ++b)
        for (int a = 0; a < kAxes; ++a)
            for (int c = 0; c < kBlockCells; ++c) {
                const double mass = fabric.mass.block(b, a)[c];
                double& u = fabric.velocity.block(b, a)[c];
                if (!(mass > 0.0)) continue;
                const double before = u;
                u = (mass * u + loads.impulse.block(b, a)[c]) / (mass + loads.drag.block(b, a)[c]);
                gained[a] += mass * (u - before);
                gainedEnergy += 0.5 * mass * (u * u - before * before);
            }
    mixture.recoverPhaseVelocities(applied, FabricFaces{fabric.grid(), fabric.velocity}, scene.liquid);
    const Vec3 lost = liquidBefore - mixture.liquidMomentum(*bath.shared, scene.liquid);
    EXPECT_GT(gained.norm(), 1.0e-3 * liquidBefore.norm());
    EXPECT_LT((gained - lost).norm(), 1.0e-13 * (liquidBefore.norm() + gained.norm()));
    EXPECT_LT(mixture.kinetic(*bath.shared, scene.liquid.faces.velocity) + gainedEnergy, energyBefore);
}

/// Pressure moves both phases: what both get is minus its gradient over all the room.
TEST(Mixture, PressureActsOnAllTheRoom)
{
    Bath bath(DragLaw::Off);
    Mixture mixture(bath.fabric, bath.settings);
    GridScene& scene = bath.scene;
    ASSERT_TRUE(bath.find(mixture));
    PressureFaces faces = scene.pressureFaces(kStep);
    const Vec3 before = bath.fabricMomentum() + mixture.liquidMomentum(*bath.shared, scene.liquid);
    const Mixture::EliminatedDrag eliminated = mixture.eliminateDrag(*bath.shared, scene.field, scene.liquid, faces.coefficient());
    // A pressure that falls evenly along x: what solvePressure would leave on the faces.
    constexpr double kSlope = 300.0;  // dyn/cm^3
    double room = 0.0;
    scene.forEachCell([&](const Vec3i& c) {
        const CellRef ref = scene.at(c);
        const double k = scene.work.coefficient.block(ref.block, 0)[ref.cell], dx = scene.grid.dx;
        scene.velocity(0, c) += k * dx * dx * kSlope;
        if (k > 0.0 && mixture.isShared(*bath.shared, 0, c)) room += dx * dx * dx;
    });
    bath.finish(mixture, eliminated);
    const Vec3 after = bath.fabricMomentum() + mixture.liquidMomentum(*bath.shared, scene.liquid);
    EXPECT_NEAR((after - before).x(), kStep * kSlope * room, 1.0e-10 * kStep * kSlope * room);
    EXPECT_NEAR((after - before).y(), 0.0, 1.0e-10 * kStep * kSlope * room);
}

/// A change of the mixture's velocity changes the momentum of both phases by the masses that pairs tell: where there is little liquid on a face,
/// hardly that of the liquid. Liquid alone to answer for both was thrown at 1e6 cm/s.
TEST(Mixture, PairsAnswerWithTheMassOfBothPhases)
{
    for (unsigned seed = 1; seed <= 8; ++seed) {
        const auto momentumAfter = [&](double change, Vec3& told) {
            Bath bath(seed % 2 == 0 ? DragLaw::Nonlinear : DragLaw::Linear);
            GridScene& scene = bath.scene;
            testing::Noise noise(seed);
            for (int b = 0; b < scene.grid.count(); ++b)  // down to almost nothing
                for (int i = 0; i < 3 * kBlockCells; ++i) scene.liquid.faces.sums.block(b)[i] *= std::pow(10.0, -3.0 + 3.0 * noise());
            Mixture mixture(bath.fabric, bath.settings);
            EXPECT_TRUE(bath.find(mixture));
            const Mixture::EliminatedDrag eliminated = bath.eliminateDragWithoutPressure(mixture);
            const auto massesBefore = scene.liquid.faces.sums;
            scene.forEachCell([&](const Vec3i& c) {
                for (int a = 0; a < kAxes; ++a)
                    if (mixture.isShared(eliminated, a, c)) scene.velocity(a, c) += change * noise();
            });
            BlockArray<double, 3> changes;
            changes.resize(scene.grid.count());
            mixture.toMassesOfBoth(eliminated, scene.liquid, changes);
            told = Vec3::Zero();
            scene.forEachCell([&](const Vec3i& c) {
                const CellRef ref = scene.at(c);
                for (int a = 0; a < kAxes; ++a)
                    if (mixture.isShared(eliminated, a, c))
                        told[a] += scene.liquid.faces.sums.block(ref.block, FaceFields::kMass + a)[ref.cell] * changes.block(ref.block, a)[ref.cell];
            });
            mixture.fromMassesOfBoth(eliminated, scene.liquid);
            for (std::size_t i = 0; i < massesBefore.size(); ++i) EXPECT_DOUBLE_EQ(scene.liquid.faces.sums.block(0)[i], massesBefore.block(0)[i]);
            bath.finish(mixture, eliminated);
            return bath.momentum(mixture);
        };
        constexpr double kChange = 5.0;  // cm/s
        Vec3 none, told;
        const Vec3 without = momentumAfter(0.0, none), with = momentumAfter(kChange, told);
        EXPECT_LT(none.norm(), 1.0e-12 * told.norm());
        EXPECT_LT((with - without - told).norm(), 1.0e-10 * (told.norm() + without.norm())) << seed;
    }
}

TEST(Mixture, FarFabricIsLeftAlone)
{
    Bath bath;
    for (Vec3& x : bath.state.x) x.x() += 100.0;
    EXPECT_FALSE(reachesLiquid(bath.scene.grid, bath.state));
}

/// A vertex shares faces with the liquid from outside of its blocks: the stencil reaches over their edge.
TEST(Mixture, FabricBesideTheLiquidsBlocksCounts)
{
    Bath bath;
    const double edge = bath.scene.corner(Vec3i(16, 0, 0)).x();  // of the last block
    for (Vec3& x : bath.state.x) x.x() = edge + 0.4 * bath.scene.grid.dx;
    EXPECT_TRUE(reachesLiquid(bath.scene.grid, bath.state));
    for (Vec3& x : bath.state.x) x.x() = edge + 2.1 * bath.scene.grid.dx;
    EXPECT_FALSE(reachesLiquid(bath.scene.grid, bath.state));
}

}  // namespace
}  // namespace sim::test
