#include "sim/fabric/pieces/generators.h"
#include "tests/sim/coupling/wick.h"

#include <gtest/gtest.h>

#include <random>

namespace sim::test {
namespace {

FabricPiece rod(int segments, const Vec3& to) { return testing::pieceOf(strand(Vec3::Zero(), to, segments), testing::wool(), {0.05, 0.05}); }
std::vector<FabricPiece> clothAndYarn()
{
    return {testing::pieceOf(clothGrid({{9, 9}, {0.144, 0.12}, Vec3::Zero()}), testing::wool(), {0.017, 0.02}), rod(20, Vec3(1.0, 0.7, 0.2))};
}

const double kSuction = 5933.6;           // P_c, PorousLaw.SuctionAndCaptureOfTheUsualFabric [dyn/cm^2]
const double kDrag = 8.9e-3 / 2.5045e-6;  // μ over Permeability.IsThatOfTheTable at 0.4, along [g/(cm^3 s)]

/// Without a gradient of saturation nothing flows (coupling/README.md, Wicking).
TEST(Wicking, UniformSaturationStays)
{
    Wick wick(clothAndYarn());
    wick.fill([](const Vec3&) { return 0.3; });
    const std::vector<double> before = wick.state.absorbed;
    wick.run(1.0e-3, 10, Vec3::Zero());
    for (std::size_t v = 0; v < before.size(); ++v) EXPECT_NEAR(wick.state.absorbed[v], before[v], 1.0e-12 * before[v]);
}

/// Along a rod whose saturation falls evenly, the flow is A θ u with u = (1 − φ) 2 P_c ds/dx / c (coupling/README.md, Wicking).
TEST(Wicking, FlowOfALinearSaturation)
{
    constexpr int kSegments = 20;
    constexpr double kLength = 2.0, kStep = 1.0e-4;  // cm, s
    Wick wick({rod(kSegments, Vec3(kLength, 0.0, 0.0))});
    wick.fill([](const Vec3& x) { return 0.8 - 0.3 * x.x(); });
    const std::vector<double> before = wick.state.absorbed;
    wick.run(kStep, 1, Vec3::Zero());
    const double area = kPi * 0.05 * 0.05, speed = 0.6 / kDrag * 2.0 * kSuction * 0.3;
    double crossed = 0.0;  // from all vertices so far to the next
    for (int v = 0; v < kSegments; ++v) {
        crossed += before[v] - wick.state.absorbed[v];
        const double filling = 0.5 * (before[v] / wick.fabric.volume[v] + before[v + 1] / wick.fabric.volume[v + 1]);
        EXPECT_NEAR(crossed, kStep * area * filling * speed, 1.0e-4 * crossed) << v;
    }
}

/// Conservation on any mesh, in steps of many parts and with a vertex that would give more than it has (coupling/README.md, Wicking).
TEST(Wicking, KeepsMassAndMomentum)
{
    for (const double dt : {1.0e-3, 0.05}) {
        Wick wick(clothAndYarn());
        for (std::size_t v = 0; v < wick.fabric.vertexCount(); v += 7) wick.fabric.pinned[v] = 1;
        std::mt19937 random(4);
        std::uniform_real_distribution<double> unit(0.0, 1.0);
        wick.fill([&](const Vec3&) { return unit(random) < 0.3 ? 0.0 : unit(random); });
        for (Vec3& v : wick.state.v) v = Vec3(unit(random), unit(random) - 0.5, 2.0 * unit(random));
        wick.before = wick.state.v;
        for (Vec3& v : wick.before) v += Vec3(0.3, 0.0, 0.2) * unit(random);
        const double mass = wick.mass();
        const Vec3 momentum = wick.momentum();
        const std::vector<double> before = wick.state.absorbed;
        wick.run(dt, 5, Vec3(0.0, -981.0, 0.0));
        double moved = 0.0;
        for (std::size_t v = 0; v < before.size(); ++v) {
            EXPECT_GE(wick.state.absorbed[v], 0.0);
            moved += std::abs(wick.state.absorbed[v] - before[v]);
        }
        EXPECT_GT(moved, 0.1 * mass);
        EXPECT_NEAR(wick.mass(), mass, 1.0e-13 * mass);
        EXPECT_GT(wick.pinImpulse.norm(), 1.0e-6 * momentum.norm());
        EXPECT_LT((wick.momentum() + wick.pinImpulse - momentum).norm(), 1.0e-13 * momentum.norm());
    }
}

/// A step of saturation follows ds/dt = d/dx(s D ds/dx), D = (1 − φ) 2 P_c / c (coupling/README.md, Wicking), against a fine solution.
TEST(Wicking, SpreadsLikeTheOneDimensionalModel)
{
    constexpr int kSegments = 120, kFine = 4;
    constexpr double kLength = 3.0, kEnd = 0.2;  // cm, s
    Wick wick({rod(kSegments, Vec3(kLength, 0.0, 0.0))});
    const auto step = [](double x) { return x < 1.0 ? 0.9 : 0.0; };
    wick.fill([&](const Vec3& x) { return step(x.x()); });
    wick.run(1.0e-3, static_cast<int>(std::lround(kEnd / 1.0e-3)), Vec3::Zero());

    const double diffusivity = 0.6 * 2.0 * kSuction / kDrag, dx = kLength / (kSegments * kFine);
    const int cells = kSegments * kFine;
    const int steps = static_cast<int>(std::ceil(kEnd * diffusivity / (0.2 * dx * dx)));
    std::vector<double> s(cells), flux(cells + 1, 0.0);
    for (int i = 0; i < cells; ++i) s[i] = step((i + 0.5) * dx);
    for (int n = 0; n < steps; ++n) {
        for (int i = 1; i < cells; ++i) flux[i] = 0.5 * (s[i - 1] + s[i]) * diffusivity * (s[i - 1] - s[i]) / dx;
        for (int i = 0; i < cells; ++i) s[i] += kEnd / steps * (flux[i] - flux[i + 1]) / dx;
    }
    double difference = 0.0, moved = 0.0;
    for (int v = 1; v < kSegments; ++v) {
        double exact = 0.0;
        for (int i = -kFine / 2; i < kFine / 2; ++i) exact += s[v * kFine + i] / kFine;
        difference += std::abs(wick.saturation(v) - exact);
        moved += std::abs(exact - step(v * kLength / kSegments));
    }
    EXPECT_LT(difference, 0.05 * moved);
    EXPECT_GT(moved, 10.0);
}

/// A dry yarn with its end in liquid fills by the square root of time (Washburn 1921). For ds/dt = D d/dx(s ds/dx) with s = 1 at the end
/// it takes up 0.8875 √(D t) of length: twice the flow −s ds/dx = 0.4437 of the self-similar solution.
TEST(Wicking, DryYarnFillsByTheSquareRootOfTime)
{
    constexpr int kSegments = 200, kSteps = 10000;
    constexpr double kLength = 3.0, kStep = 2.0e-5;  // cm, s
    Wick wick({rod(kSegments, Vec3(kLength, 0.0, 0.0))});
    Wicking wicking(wick.fabric, wick.elements, wick.settings);
    ASSERT_EQ(wicking.substeps(kStep), 1);  // the end is full in every part of a step
    std::vector<double> filled;             // length [cm]
    const double perLength = poreVolume(wick.fabric, 1) * kSegments / kLength;
    for (int n = 0; n < kSteps; ++n) {
        wick.state.absorbed[0] = poreVolume(wick.fabric, 0);
        wicking.move(kStep, Vec3::Zero(), BlockGrid(), BlockArray<double>(), wick.before, wick.state);
        filled.push_back(wick.mass() / perLength);
    }
    EXPECT_NEAR(std::log(filled[kSteps - 1] / filled[kSteps / 4 - 1]) / std::log(4.0), 0.50, 0.02);
    const double diffusivity = 0.6 * 2.0 * kSuction / kDrag;
    EXPECT_NEAR(filled.back(), 0.8875 * std::sqrt(diffusivity * kSteps * kStep), 0.05 * filled.back());
    EXPECT_LT(wick.state.absorbed[kSegments], 1.0e-12);  // the other end is still dry
}

std::vector<FabricPiece> hangingRod() { return {rod(20, Vec3(0.0, 1.0, 0.0))}; }

TEST(Wicking, SubstepsAreStepsOfAPart)
{
    constexpr double kStep = 3.0e-5;  // s
    const Vec3 gravity(0.0, -981.0, 0.0);
    const auto wetEnd = [](const Vec3& x) { return x.y() < 0.3 ? 0.8 : 0.1; };
    Wick asked(hangingRod()), parts(hangingRod()), once(hangingRod());
    for (Wick* wick : {&asked, &parts, &once}) wick->fill(wetEnd);
    asked.settings.solver.wickingSubsteps = 3;
    ASSERT_EQ(1, Wicking(once.fabric, once.elements, once.settings).substeps(kStep));
    EXPECT_EQ(3, Wicking(asked.fabric, asked.elements, asked.settings).substeps(kStep));
    EXPECT_GT(Wicking(asked.fabric, asked.elements, asked.settings).substeps(1000.0 * kStep), 3) << "where stability asks for more";
    asked.run(kStep, 1, gravity);
    parts.run(kStep / 3.0, 3, gravity);
    once.run(kStep, 1, gravity);
    EXPECT_EQ(asked.state.absorbed, parts.state.absorbed);
    EXPECT_NE(asked.state.absorbed, once.state.absorbed);
}

/// What liquid around the fabric feels is one thing, the fibres that hold liquid in its pores another.
TEST(Wicking, GoesOnWithoutDragOutside)
{
    Wick off(hangingRod()), on(hangingRod());
    off.settings.coupling.drag = DragLaw::Off;
    on.settings.coupling.drag = DragLaw::Nonlinear;
    for (Wick* wick : {&off, &on}) {
        wick->fill([](const Vec3& x) { return x.y() < 0.3 ? 0.8 : 0.0; });
        wick->run(1.0e-3, 10, Vec3(0.0, -981.0, 0.0));
    }
    EXPECT_EQ(off.state.absorbed, on.state.absorbed);
    EXPECT_GT(off.saturation(8), 0.01) << "it rose";
}

TEST(Wicking, AtRateZeroLiquidStays)
{
    Wick wick(hangingRod());
    wick.fill([](const Vec3& x) { return x.y() < 0.3 ? 0.8 : 0.0; });
    const std::vector<double> before = wick.state.absorbed;
    wick.settings.coupling.wicking.rateScale = 0.0;
    wick.run(1.0e-3, 10, Vec3(0.0, -981.0, 0.0));
    EXPECT_EQ(before, wick.state.absorbed);
    EXPECT_TRUE(Wicking(wick.fabric, wick.elements, wick.settings).isWet(wick.state)) << "and what is too much still drips off";
}

/// In a yarn that hangs, saturation falls upwards until suction holds the weight: 2 P_c ds/dy = −ρ g (coupling/README.md, Wicking).
TEST(Wicking, ColumnAtRest)
{
    constexpr int kSegments = 15;
    constexpr double kHeight = 1.5, kGravity = 981.0;
    Wick wick({rod(kSegments, Vec3(0.0, kHeight, 0.0))});
    wick.fill([](const Vec3&) { return 0.5; });
    wick.run(2.0e-3, 5000, Vec3(0.0, -kGravity, 0.0));
    const double slope = (wick.saturation(kSegments) - wick.saturation(0)) / kHeight;
    EXPECT_NEAR(slope, -kGravity / (2.0 * kSuction), 1.0e-3 * kGravity / (2.0 * kSuction));
}

/// Nonlinear drag: the speed is the one at which drag holds the force.
TEST(Wicking, SpeedUnderAForceIsTheRootOfDrag)
{
    CouplingSettings coupling;
    const LiquidSettings water;
    const PorousLaw law({0.01, 0.4}, water, coupling);
    const double k = permeability(0.4, 0.01).along;
    for (const double force : {1.0e-3, 1.0, 981.0, 1.0e5, 1.0e8}) {
        const double u = law.speedUnder(force, k, 0.4);
        EXPECT_NEAR(law.drag(k, 0.4, u) * u, force, 1.0e-9 * force);
    }
    EXPECT_EQ(law.speedUnder(0.0, k, 0.4), 0.0);
    coupling.drag = DragLaw::Off;
    EXPECT_EQ(PorousLaw({0.01, 0.4}, water, coupling).speedUnder(1.0, k, 0.4), 0.0);
}

}  // namespace
}  // namespace sim::test
