#include "sim/coupling/mixture.h"
#include "tests/sim/fabric/pieces.h"
#include "tests/sim/liquid/grid_scene.h"

#include <gtest/gtest.h>

namespace sim::test {
namespace {

using testing::Noise;

constexpr double kStep = 1.0e-3;  // s

/// Cloth and yarns in the middle of liquid that moves at random.
struct Bath {
    explicit Bath(DragLaw law = DragLaw::Nonlinear) : scene(Vec3i(0, 0, 0), Vec3i(16, 16, 16))
    {
        testing::Noise noise(7);
        const Vec3 middle = scene.corner(Vec3i(8, 8, 8));
        FabricPiece cloth = testing::pieceOf(clothGrid({{9, 9}, {0.144, 0.144}, middle}), testing::wool(), {0.017, 0.017});
        FabricPiece yarn = testing::pieceOf(strand(middle - Vec3(0.5, 0.3, 0.2), middle + Vec3(0.6, 0.1, 0.4), 8), testing::wool(), {0.05, 0.03});
        cloth.material.volumeFraction = yarn.material.volumeFraction = 0.4;
        fabric = assembleFabric(std::vector<FabricPiece>{cloth, yarn});
        around = LiquidAround(fabric.vertexCount());
        state = restState(fabric);
        for (Vec3& v : state.v) v = 20.0 * noise.vector();
        scene.fill([&](const Vec3& x) { return (x - middle).cwiseAbs().maxCoeff() - 6.4 * scene.grid.dx; });
        scene.setRandomVelocities(20.0);
        settings.cell = scene.grid.dx;
        settings.gravity.setZero();
        settings.coupling.drag = law;
        settings.coupling.capillary = false;
    }
    Vec3 fabricMomentum() const
    {
        Vec3 sum = Vec3::Zero();
        for (std::size_t v = 0; v < state.v.size(); ++v) sum += fabric.mass[v] * state.v[v];
        return sum;
    }
    /// The fabric under the liquid's loads alone.
    void moveFabric(const LiquidLoads& loads)
    {
        for (std::size_t v = 0; v < state.v.size(); ++v) {
            const Vec3 inertia = Vec3::Constant(fabric.mass[v]) + loads.drag[v];
            state.v[v] = (fabric.mass[v] * state.v[v] + loads.impulse[v]).cwiseQuotient(inertia);
        }
    }

    Vec3 momentum(const Mixture& mixture) const { return fabricMomentum() + mixture.liquidMomentum(*shared, scene.liquid); }
    /// A step of the two without pressure.
    void exchange(Mixture& mixture) { finish(mixture, eliminateDragWithoutPressure(mixture)); }
    /// Moves the fabric under the liquid's loads alone, and separates the phases.
    void finish(Mixture& mixture, const Mixture::EliminatedDrag& eliminated)
    {
        const Mixture::AppliedPressure applied = mixture.applyPressure(eliminated, scene.liquid);
        moveFabric(mixture.vertexLoads(applied));
        mixture.recoverPhaseVelocities(applied, state, scene.liquid);
    }
    Mixture::EliminatedDrag eliminateDragWithoutPressure(Mixture& mixture)
    {
        BlockArray<double, 3> noPressure;
        noPressure.resize(scene.grid.count());
        for (int b = 0; b < scene.grid.count(); ++b) std::fill_n(noPressure.block(b), 3 * kBlockCells, 0.0);
        return mixture.eliminateDrag(*shared, scene.field, scene.liquid, noPressure);
    }
    bool find(Mixture& mixture)
    {
        vertices.sort(scene.grid, state);
        shared = mixture.findSharedFaces(scene.cut(), Vec3::Zero(), kStep, state, nullptr, scene.liquid);
        return shared.has_value();
    }

    GridScene scene;
    Fabric fabric;
    LiquidAround around{0};  ///< 0 from all vertices
    SortedVertices vertices;
    FabricState state;
    Settings settings;
    std::optional<Mixture::SharedFaces> shared;  ///< of the last find()
};

/// What drag takes from one phase it gives to the other, and it makes no energy.
TEST(Mixture, DragKeepsMomentumAndMakesNoEnergy)
{
    Bath bath;
    Mixture mixture(bath.fabric, bath.around, bath.settings, bath.vertices);
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
    Mixture mixture(bath.fabric, bath.around, bath.settings, bath.vertices);
    ASSERT_TRUE(bath.find(mixture));
    FabricOnFaces fabric(bath.fabric, bath.settings.liquid.density, nullptr, bath.vertices);
    fabric.spread(bath.state);
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
    Mixture mixture(bath.fabric, bath.around, bath.settings, bath.vertices);
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
            Mixture mixture(bath.fabric, bath.around, bath.settings, bath.vertices);
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
        Mixture mixture(bath.fabric, bath.around, bath.settings, bath.vertices);
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
        Mixture mixture(bath.fabric, bath.around, bath.settings, bath.vertices);
        ASSERT_TRUE(bath.find(mixture));
        const Mixture::AppliedPressure applied = mixture.applyPressure(bath.eliminateDragWithoutPressure(mixture), bath.scene.liquid);
        double fastest = 0.0;  // cm/s
        const LiquidLoads& loads = mixture.vertexLoads(applied);
        for (std::size_t v = 0; v < bath.fabric.vertexCount(); ++v)
            fastest = std::max(fastest, loads.impulse[v].cwiseAbs().maxCoeff() / bath.fabric.mass[v]);
        ASSERT_GT(fastest, 0.0);
        FabricOnFaces fabric(bath.fabric, bath.settings.liquid.density, nullptr, bath.vertices);
        fabric.spread(bath.state);
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
    Mixture mixture(bath.fabric, bath.around, bath.settings, bath.vertices);
    ASSERT_TRUE(bath.find(mixture));
    bath.exchange(mixture);
    EXPECT_LT(mixture.liquidMomentum(*bath.shared, bath.scene.liquid).norm(), 1.0e-12);
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
