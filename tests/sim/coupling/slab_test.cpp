#include "sim/coupling/mixture.h"
#include "sim/fabric/pieces/generators.h"
#include "tests/sim/fabric/pieces.h"
#include "tests/sim/liquid/grid_scene.h"

#include <gtest/gtest.h>

namespace sim::test {
namespace {

constexpr double kStep = 1.0e-3;  // s
constexpr double kCell = 0.288;   // cm
constexpr double kHalfThickness = 0.018;

/// Level sheets of cloth one above the other in a grid of 16 cells each way, half a cell apart, as their vertices are: fibres fill the same
/// part of every face among them. Liquid fills what they leave, to the last drop.
struct Stack {
    explicit Stack(int sheets, double volumeFraction, double density, bool isHeld = false) : scene(Vec3i(0, 0, 0), Vec3i(16, 16, 16), kCell)
    {
        std::vector<FabricPiece> pieces;
        for (int s = 0; s < sheets; ++s) {
            const Vec3 corner = scene.corner(Vec3i(4, 8, 4)) + Vec3(0.0, 0.5 * kCell * (s - 0.5 * (sheets - 1)), 0.0);
            FabricPiece sheet = testing::pieceOf(clothGrid({{17, 17}, {0.5 * kCell, 0.5 * kCell}, corner, Vec3::UnitX(), Vec3::UnitZ()}),
                                                 testing::wool(), {kHalfThickness, kHalfThickness});
            sheet.material.volumeFraction = volumeFraction;
            sheet.material.density = density;
            if (isHeld) {
                PinGroup all;
                for (int v = 0; v < static_cast<int>(sheet.points.size()); ++v) all.vertices.push_back(v);
                sheet.pins.push_back(all);
            }
            pieces.push_back(sheet);
        }
        fabric = assembleFabric(pieces);
        distance.assign(fabric.vertexCount(), 0.0);
        state = restState(fabric);
        settings.cell = kCell;
        settings.gravity.setZero();
        settings.coupling.capillary = false;
    }
    /// Throws std::bad_optional_access where liquid and fabric share no faces.
    Mixture::SharedFaces find(Mixture& mixture)
    {
        const std::span<const double> distances = isDragByFabric(settings.coupling) ? std::span<const double>(distance) : std::span<const double>();
        const Mixture::MetFabric met{sorter.sort(scene.grid, state), state, distances, nullptr};
        return mixture.findSharedFaces(scene.cut(), settings.gravity, kStep, met, scene.liquid).value();
    }
    /// Liquid on the faces around the fabric, less what the fibres take up.
    void makeRoom()
    {
        scene.setMasses();
        FabricOnFaces faces(fabric, settings.liquid.density);
        faces.spread(sorter.sort(scene.grid, state), state, {});
        for (int b = 0; b < faces.grid().count(); ++b) {
            const int to = scene.grid.find(faces.grid().coords(b));
            if (to == BlockGrid::kNone) continue;
            for (int a = 0; a < kAxes; ++a)
                for (int c = 0; c < kBlockCells; ++c) {
                    double& mass = scene.liquid.faces.sums.block(to, FaceFields::kMass + a)[c];
                    mass = std::max(0.0, mass - settings.liquid.density * faces.solid.block(b, a)[c]);
                }
        }
    }
    /// What the liquid's loads and gravity do to free vertices.
    void moveFabric(const LiquidLoads& loads)
    {
        for (std::size_t v = 0; v < state.v.size(); ++v) {
            if (fabric.pinned[v]) continue;
            const Vec3 momentum = fabric.mass[v] * (state.v[v] + kStep * settings.gravity) + loads.impulse[v];
            state.v[v] = momentum.cwiseQuotient(Vec3::Constant(fabric.mass[v]) + loads.drag[v]);
        }
    }

    GridScene scene;
    Fabric fabric;
    std::vector<double> distance;  ///< of the liquid from each vertex [cells]
    VertexSorter sorter;
    FabricState state;
    Settings settings;
};

/// A pressure gradient drives liquid through cloth that stands still at (1 − ψ)(k/μ) ∇p, by the published law of drag on the volume of the cell
/// (coupling/README.md, Drag); Darcy's superficial velocity would be that over (1 − ψ)².
TEST(DarcyColumn, RunsAtTheVelocityOfTheModel)
{
    Stack stack(9, 0.4, 1.32);  // a stencil in its middle reaches seven
    stack.settings.coupling.drag = DragLaw::Linear;
    stack.settings.coupling.dragFraction = DragFraction::Cell;
    GridScene& scene = stack.scene;
    const Vec3 middle = scene.corner(Vec3i(8, 8, 8));
    scene.fill([&](const Vec3& x) { return (x - middle).cwiseAbs().maxCoeff() - 6.4 * kCell; });
    Mixture mixture(stack.fabric, stack.settings);
    constexpr double kSlope = 300.0;  // dyn/cm^3
    for (int n = 0; n < 60; ++n) {
        stack.makeRoom();
        const Mixture::SharedFaces shared = stack.find(mixture);
        PressureFaces faces = scene.pressureFaces(kStep);
        const Mixture::EliminatedDrag eliminated = mixture.eliminateDrag(shared, scene.field, scene.liquid, faces.coefficient());
        scene.forEachCell([&](const Vec3i& c) {
            scene.velocity(1, c) += scene.work.coefficient.block(scene.at(c).block, 1)[scene.at(c).cell] * kCell * kCell * kSlope;
        });
        const Mixture::AppliedPressure applied = mixture.applyPressure(eliminated, scene.liquid);
        mixture.recoverPhaseVelocities(applied, stack.state, scene.liquid);  // of vertices that nothing moves
    }
    const double fraction = 0.4 * 2.0 * kHalfThickness / (0.5 * kCell);
    const double expected = (1.0 - fraction) * permeability(fraction, 0.01).across / stack.settings.liquid.viscosity * kSlope;
    EXPECT_GT(expected, 0.5);
    for (const Vec3i& c : {Vec3i(8, 8, 8), Vec3i(7, 8, 8), Vec3i(8, 8, 7)}) EXPECT_NEAR(scene.velocity(1, c), expected, 1.0e-3 * expected) << c;
}

/// Fills a tank of these cells with liquid up to the 13th.
void fillTank(Stack& stack, const Vec3i& low, const Vec3i& high)
{
    GridScene& scene = stack.scene;
    stack.settings.gravity = Vec3(0.0, -981.0, 0.0);
    scene.add(tankOfCells(scene, low, high));
    scene.fill([&](const Vec3& x) { return x.y() - scene.corner(Vec3i(0, 13, 0)).y(); });
    stack.makeRoom();
}

/// A step of liquid that gravity has made faster already, up to the fabric's new velocities.
Mixture::AppliedPressure pressAndDrag(Stack& stack, Mixture& mixture)
{
    GridScene& scene = stack.scene;
    const Mixture::SharedFaces shared = stack.find(mixture);
    PressureFaces faces = scene.pressureFaces(kStep);
    const Mixture::EliminatedDrag eliminated = mixture.eliminateDrag(shared, scene.field, scene.liquid, faces.coefficient());
    scene.project(preparePressure(faces, scene.grid));
    const Mixture::AppliedPressure applied = mixture.applyPressure(eliminated, scene.liquid);
    stack.moveFabric(mixture.vertexLoads(applied));
    return applied;
}

/// A tank of liquid at rest with a sheet amid it; one step under gravity.
/// @return the largest speed that the liquid takes up [cm/s]
double standInTank(Stack& stack)
{
    fillTank(stack, Vec3i(2, 2, 2), Vec3i(14, 16, 14));
    stack.scene.setVelocities([&](const Vec3&) { return Vec3(kStep * stack.settings.gravity); });
    Mixture mixture(stack.fabric, stack.settings);
    const Mixture::AppliedPressure applied = pressAndDrag(stack, mixture);
    mixture.recoverPhaseVelocities(applied, stack.state, stack.scene.liquid);
    return stack.scene.largestError([](const Vec3&) { return Vec3::Zero().eval(); });
}

/// Fabric as dense as the liquid stays where it is, and so does the liquid.
TEST(Buoyancy, NeutralFabricStays)
{
    for (const DragLaw drag : {DragLaw::Off, DragLaw::Nonlinear}) {
        Stack stack(1, 0.4, 1.0);
        stack.settings.coupling.drag = drag;
        const double fall = 981.0 * kStep;
        EXPECT_LT(standInTank(stack), 1.0e-3 * fall);
        for (const Vec3& v : stack.state.v) EXPECT_LT(v.norm(), 1.0e-3 * fall);
    }
}

/// Liquid is at rest around fabric that pins hold, however dense that is and however strong its drag: pressure is not to count on fabric that
/// gives way.
TEST(Buoyancy, HeldFabricLeavesTheLiquidAtRest)
{
    for (const DragLaw drag : {DragLaw::Off, DragLaw::Linear}) {
        Stack stack(9, 0.4, 1.32, true);
        stack.settings.coupling.drag = drag;
        EXPECT_LT(standInTank(stack), 1.0e-5 * 981.0 * kStep);  // the pressure's solve stops at 1e-6
    }
}

/// What is denser starts to sink under the weight of its fibres less that of as much liquid.
TEST(Buoyancy, DenserFabricSinksByTheDifference)
{
    constexpr double kDensity = 1.32, kFraction = 0.02;  // thin: a dense layer would keep the liquid's pressure from being hydrostatic
    Stack stack(1, kFraction, kDensity);
    stack.settings.coupling.drag = DragLaw::Off;
    standInTank(stack);
    double momentum = 0.0, fibres = 0.0;
    for (std::size_t v = 0; v < stack.state.v.size(); ++v) {
        momentum += stack.fabric.mass[v] * stack.state.v[v].y();
        fibres += kFraction * stack.fabric.volume[v];
    }
    const double expected = -(kDensity - 1.0) * fibres * 981.0 * kStep;
    EXPECT_NEAR(momentum, expected, 0.01 * -expected);
}

/// Sheets from wall to wall sink through the liquid at the speed at which drag holds them. Fibres feel their weight less that of as
/// much of the mixture: μ/k w = ψ (1 − ψ) (ρ_s − ρ_f) g by the published law. By that of the fabric it is Darcy's law on the volume of the
/// fabric, ε of all: ε μ/k(φ) (1 − ψ) w = ψ (ρ_s − ρ_f) g.
void sinkAtTheSpeedOfDrag(DragFraction by)
{
    Stack stack(9, 0.4, 1.32);
    stack.settings.coupling.drag = DragLaw::Linear;
    stack.settings.coupling.dragFraction = by;
    GridScene& scene = stack.scene;
    fillTank(stack, Vec3i(6, 2, 6), Vec3i(10, 16, 10));  // the sheets reach farther
    scene.setVelocities([](const Vec3&) { return Vec3::Zero().eval(); });
    Mixture mixture(stack.fabric, stack.settings);
    constexpr std::size_t kPerSheet = 17 * 17;
    const std::size_t middle = stack.state.v.size() / 2;
    for (int n = 0; n < 60; ++n) {
        stack.makeRoom();
        scene.forEachCell([&](const Vec3i& c) { scene.velocity(1, c) += kStep * stack.settings.gravity.y(); });
        const Mixture::AppliedPressure applied = pressAndDrag(stack, mixture);
        for (std::size_t v = 0; v < stack.state.v.size(); v += kPerSheet)  // beyond the walls as between them
            std::fill_n(stack.state.v.begin() + v, kPerSheet, stack.state.v[v + kPerSheet / 2]);
        mixture.recoverPhaseVelocities(applied, stack.state, scene.liquid);
    }
    const LiquidSettings& liquid = stack.settings.liquid;
    const double envelope = 2.0 * kHalfThickness / (0.5 * kCell), fraction = 0.4 * envelope, weight = fraction * (1.32 - liquid.density) * 981.0;
    const double relative = by == DragFraction::Cell ? (1.0 - fraction) * weight * permeability(fraction, 0.01).across / liquid.viscosity
                                                     : weight * permeability(0.4, 0.01).across / (liquid.viscosity * envelope * (1.0 - fraction));
    EXPECT_NEAR(scene.velocity(1, Vec3i(8, 8, 8)) - stack.state.v[middle].y(), relative, 0.01 * relative);
}

TEST(Buoyancy, DenserFabricSinksAtTheSpeedOfItsDrag) { sinkAtTheSpeedOfDrag(DragFraction::Fabric); }

TEST(Buoyancy, DenserFabricSinksAtTheSpeedOfThePublishedDrag) { sinkAtTheSpeedOfDrag(DragFraction::Cell); }

}  // namespace
}  // namespace sim::test
