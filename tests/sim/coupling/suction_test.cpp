#include "tests/sim/coupling/bath.h"

#include <gtest/gtest.h>

namespace sim::test {
namespace {

/// The bath's liquid below a height only, at rest.
void fillBelow(Bath& bath, double height)
{
    for (int b = 0; b < bath.scene.grid.count(); ++b) {
        std::fill_n(bath.scene.liquid.inside.block(b), BlockBits<>::kWords, 0);
        std::fill_n(bath.scene.liquid.faces.sums.block(b), 6 * kBlockCells, 0.0);
    }
    const Vec3 middle = bath.scene.corner(Vec3i(8, 8, 8));
    bath.scene.fill([&](const Vec3& x) { return std::max(x.y() - height, (x - middle).cwiseAbs().maxCoeff() - 6.4 * bath.scene.grid.dx); });
    bath.scene.setRandomVelocities(0.0);
}

/// Liquid under dry fabric is drawn up (coupling/README.md, Suction), by as much as the fabric is drawn down where the reaction is asked for.
TEST(Mixture, SuctionDrawsLiquidIntoEmptyPores)
{
    for (const bool hasReaction : {false, true}) {
        Bath bath(DragLaw::Off);
        for (Vec3& v : bath.state.v) v.setZero();
        bath.settings.coupling.capillary = true;
        bath.settings.coupling.capillaryReaction = hasReaction;
        double middle = 0.0;
        for (const Vec3& x : bath.state.x) middle += x.y() / static_cast<double>(bath.state.x.size());
        fillBelow(bath, middle - 0.5 * bath.scene.grid.dx);
        Mixture mixture(bath.fabric, bath.settings);
        ASSERT_TRUE(bath.find(mixture));
        bath.exchange(mixture);
        const Vec3 up = mixture.liquidMomentum(*bath.shared, bath.scene.liquid);
        EXPECT_GT(up.y(), 1.0e-4);
        EXPECT_GT(up.y(), std::abs(up.x()) + std::abs(up.z()));
        if (hasReaction) EXPECT_LT(bath.momentum(mixture).norm(), 1.0e-13 * up.norm());
        else EXPECT_EQ(bath.fabricMomentum(), Vec3::Zero().eval());
    }
}

/// A face with hardly any fabric beside much liquid: what is drawn through it, the vertices that draw have to bear, not the little on the face.
TEST(Mixture, ReactionOfSuctionMovesNoFaceFasterThanTheVerticesThatDraw)
{
    testing::Noise noise(11);
    for (int n = 0; n < 12; ++n) {
        Bath bath(DragLaw::Off);
        const double dx = bath.scene.grid.dx, beyond = std::pow(10.0, -1.0 - n % 4) * dx;
        Vec3 shift = dx * noise.vector();
        const int axis = n % kAxes;  // along it a vertex reaches a face by as little
        shift[axis] += (std::ceil(bath.state.x[0][axis] / dx) - 0.5) * dx + beyond - bath.state.x[0][axis] - shift[axis];
        for (Vec3& x : bath.state.x) x += shift;
        for (Vec3& v : bath.state.v) v.setZero();
        bath.settings.coupling.capillary = bath.settings.coupling.capillaryReaction = true;
        fillBelow(bath, bath.scene.corner(Vec3i(8, 8, 8)).y() + dx * noise());
        Mixture mixture(bath.fabric, bath.settings);
        ASSERT_TRUE(bath.find(mixture));
        const Mixture::AppliedPressure applied = mixture.applyPressure(bath.eliminateDragWithoutPressure(mixture), bath.scene.liquid);
        double fastest = 0.0;  // cm/s
        const LiquidLoads& loads = mixture.vertexLoads(applied);
        for (std::size_t v = 0; v < bath.fabric.vertexCount(); ++v)
            fastest = std::max(fastest, loads.impulse[v].cwiseAbs().maxCoeff() / bath.fabric.mass[v]);
        ASSERT_GT(fastest, 0.0);
        FabricOnFaces fabric = bath.onFaces();
        const FaceLoads onFaces = mixture.faceLoads(applied);
        double fastestFace = 0.0;
        Vec3 sum = Vec3::Zero();
        for (int b = 0; b < fabric.grid().count(); ++b)
            for (int a = 0; a < kAxes; ++a)
                for (int c = 0; c < kBlockCells; ++c) {
                    const double mass = fabric.mass.block(b, a)[c], impulse = onFaces.impulse.block(b, a)[c];
                    sum[a] += impulse;
                    if (mass > 0.0) fastestFace = std::max(fastestFace, std::abs(impulse) / mass);
                    else EXPECT_EQ(impulse, 0.0);
                }
        EXPECT_LE(fastestFace, fastest * (1.0 + 1.0e-9)) << n;
        mixture.recoverPhaseVelocities(applied, FabricFaces{fabric.grid(), fabric.velocity}, bath.scene.liquid);
        const Vec3 drawn = mixture.liquidMomentum(*bath.shared, bath.scene.liquid);
        EXPECT_LT((sum + drawn).norm(), 1.0e-12 * drawn.norm());
    }
}

TEST(Mixture, FullPoresDoNotSuck)
{
    Bath bath(DragLaw::Off);
    bath.settings.coupling.capillary = true;
    for (Vec3& v : bath.state.v) v.setZero();
    bath.scene.setRandomVelocities(0.0);  // fabric amid liquid: every cell that it reaches is full
    Mixture mixture(bath.fabric, bath.settings);
    ASSERT_TRUE(bath.find(mixture));
    bath.exchange(mixture);
    EXPECT_LT(mixture.liquidMomentum(*bath.shared, bath.scene.liquid).norm(), 1.0e-12);
}

}  // namespace
}  // namespace sim::test
