#include "tests/physics/fabric_runs.h"

#include <gtest/gtest.h>

// Fabric that hangs and stretches, and how it swings (fabric/rods/README.md, Energies).

namespace sim::test {
namespace {

using testing::pieceOf;

/// A yarn so thin that it hangs like a chain; the points given are its vertices at rest.
FabricPiece chain(const FabricGeometry& geometry) { return pieceOf(geometry, solidFibre(2.0e7), {0.001, 0.001}); }

/// Sag and the cosh law of a chain of length 10 whose ends are a distance apart.
struct Catenary {
    double span, a, sag;
};

TEST(HangingChain, FollowsTheCatenary)
{
    constexpr double kLength = 10.0;
    constexpr int kEdges = 40;
    // Newton's only iteration in a quiet step starts from where gravity alone would lead, gh² away: what that stretches
    // an edge must be small beside the strain of the chain, 1e-4.
    constexpr double kStep = 3.0e-4;
    for (const Catenary& exact : {Catenary{8.0, 3.38202, 2.65438}, Catenary{5.0, 1.14820, 3.98194}}) {
        FabricPiece piece = chain(strand(Vec3::Zero(), Vec3(kLength, 0.0, 0.0), kEdges));
        Motion draw;
        draw.addTranslation(0.0, 1.0, Vec3(exact.span - kLength, 0.0, 0.0), 0.3, 0.3);
        piece.pins = {pinned({0}), pinned({kEdges}, false, draw)};
        FabricSettings settings = withoutContact();
        settings.tolerance = 1.0e-8;
        FabricRun run(piece, settings);
        run.steps(3400, kStep);
        ASSERT_TRUE(run.settle(kStep, 15.0, 1.0e-4, 12000));

        const auto height = [&](double x) { return exact.a * (std::cosh((x - 0.5 * exact.span) / exact.a) - std::cosh(0.5 * exact.span / exact.a)); };
        double worst = 0.0;
        for (const Vec3& x : run.state.x) worst = std::max(worst, std::abs(x.y() - height(x.x())));
        EXPECT_LT(worst, 0.005 * exact.sag) << "span " << exact.span;
        EXPECT_NEAR(-run.state.x[kEdges / 2].y(), exact.sag, 0.005 * exact.sag);

        const double weight = lineDensity(piece) * kEarthGravity;
        const Vec3 pull = run.tension(0) * (run.state.x[1] - run.state.x[0]).normalized();
        const double ownHalf = 0.5 * weight * kLength / kEdges;  // what hangs on the pin itself
        EXPECT_NEAR(-pull.y() + ownHalf, 0.5 * weight * kLength, 0.001 * weight * kLength);
        EXPECT_NEAR(pull.x(), weight * exact.a, 0.005 * weight * exact.a);
        RecordProperty("span" + std::to_string(int(exact.span)), std::to_string(-run.state.x[kEdges / 2].y()) + " worst " +
                                                                     std::to_string(worst / exact.sag) + " H " +
                                                                     std::to_string(pull.x() / (weight * exact.a)));
    }
}

/// The yarn of the published scenes, 14.256 long, under its own weight.
TEST(HangingYarn, StretchesByItsWeight)
{
    constexpr double kLength = 14.256;
    constexpr int kEdges = 30;
    FabricPiece piece = pieceOf(strand(Vec3::Zero(), Vec3(0.0, -kLength, 0.0), kEdges), testing::wool(), {0.048, 0.048});
    piece.pins.push_back(pinned({0}));
    FabricRun run(piece);
    ASSERT_TRUE(run.settle(0.002, 100.0, 1.0e-9));
    const double stretch = (-run.state.x[kEdges].y() - kLength) / kLength;
    const FabricMaterial& m = piece.material;
    const double exact = m.envelopeDensity() * kEarthGravity * kLength / (2.0 * m.young * m.packing());
    EXPECT_NEAR(exact, 3.50e-4, 0.005e-4);
    EXPECT_NEAR(stretch, exact,
                1.0e-5 * exact);  // each edge carries what hangs at its middle: exact but for the solver
    RecordProperty("stretch", std::to_string(stretch * 1.0e4));
}

/// A strip pulled by a heavy lower edge, its sides free: force of the St. Venant-Kirchhoff membrane, and how it gets
/// narrower.
TEST(HangingCloth, PullsAndNarrowsAsTheMembraneDoes)
{
    constexpr int kAcross = 9, kAlong = 33;
    constexpr double kWidth = 1.0, kThickness = 0.02, kYoung = 1.0e6, kPoisson = 0.3;
    ClothGrid grid;
    grid.nodes = Vec2i(kAcross, kAlong);
    grid.spacing = {kWidth / (kAcross - 1), kWidth / (kAcross - 1)};
    grid.v = -Vec3::UnitY();
    FabricPiece piece = pieceOf(clothGrid(grid), solidFibre(kYoung, kPoisson), {0.5 * kThickness, 0.5 * kThickness});
    std::vector<int> upper;
    for (int i = 0; i < kAcross; ++i) upper.push_back(i);
    piece.pins.push_back(pinned(upper));
    const double target = 1.1 * 0.5 * (1.1 * 1.1 - 1.0) * kYoung * kThickness * kWidth;  // dyn, at λ = 1.1
    FabricRun run(piece, withoutContact(), {}, [&](Fabric& fabric) {
        for (int i = 0; i < kAcross; ++i) {
            const bool isCorner = i == 0 || i + 1 == kAcross;
            fabric.mass[(kAlong - 1) * kAcross + i] += target / kEarthGravity / (kAcross - 1) * (isCorner ? 0.5 : 1.0);
        }
    });
    ASSERT_TRUE(run.settle(0.005, 30.0, 1.0e-3));
    // In the middle, a width and a half from either end.
    const int row = kAlong / 2, middle = row * kAcross + kAcross / 2;
    const std::vector<Vec3>& x = run.state.x;
    const double stretch = (x[middle - kAcross] - x[middle + kAcross]).norm() / (2.0 * grid.spacing[1]);
    const double across = (x[row * kAcross + kAcross - 1] - x[row * kAcross]).norm() / kWidth;
    double below = 0.0;
    for (int v = (row + 1) * kAcross; v < kAlong * kAcross; ++v) below += run.fabric.mass[v];
    for (int i = 0; i < kAcross; ++i) below += 0.5 * run.fabric.mass[row * kAcross + i];
    const double force = below * kEarthGravity;
    const double green = 0.5 * (stretch * stretch - 1.0), greenAcross = 0.5 * (across * across - 1.0);
    // What the clamped end holds has died out to a few thousandths here.
    EXPECT_NEAR(kYoung * kThickness * kWidth * stretch * green, force, 0.005 * force);
    EXPECT_NEAR(greenAcross, -kPoisson * green, 0.01 * kPoisson * green);
    RecordProperty("force", std::to_string(kYoung * kThickness * kWidth * stretch * green / force) + " at " + std::to_string(stretch));
    RecordProperty("poisson", std::to_string(-greenAcross / green));
}

/// Frequency of what passes 0, from the first passing after `from` on [Hz].
template <class Value>
double frequency(FabricRun& run, double h, double from, double until, Value&& value)
{
    std::vector<double> passings;
    double before = value();
    while (run.time < until) {
        run.step(h);
        const double now = value();
        if (before * now < 0.0 && run.time > from) passings.push_back(run.time - h * now / (now - before));
        before = now;
    }
    return (static_cast<double>(passings.size()) - 1.0) / (2.0 * (passings.back() - passings.front()));
}

/// Backward Euler takes energy out but shifts the frequency only by the square of ωh; the step is 1/600 of a period.
TEST(YarnCantilever, VibratesAtItsFrequency)
{
    constexpr int kEdges = 40;
    constexpr double kLength = 10.0;
    const Cantilever beam(kEdges, kLength / kEdges, 0.2, 1.0e8);
    const double exact = 0.55959 / (beam.effectiveLength * beam.effectiveLength) * std::sqrt(bendingStiffness(beam.piece) / lineDensity(beam.piece));
    FabricRun run(beam.piece);
    run.gravity.setZero();
    for (int v = 2; v <= beam.tip; ++v) {
        const double s = (run.state.x[v].x() - beam.clamp.x()) / beam.effectiveLength;
        run.state.v[v] = Vec3(0.0, 5.0 * s * s, 0.0);  // nearly the first mode; others die out faster
    }
    const double found = frequency(run, 1.0 / (600.0 * exact), 0.6 / exact, 4.2 / exact, [&] { return run.state.x[beam.tip].y(); });
    EXPECT_NEAR(found, exact, 0.02 * exact);
    RecordProperty("ratio", std::to_string(found / exact));
}

TEST(HangingChain, SwingsAtItsFrequency)
{
    constexpr int kEdges = 40;
    constexpr double kLength = 10.0;
    FabricPiece piece = chain(strand(Vec3::Zero(), Vec3(0.0, -kLength, 0.0), kEdges));
    piece.pins.push_back(pinned({0}));
    FabricRun run(piece);
    for (int v = 1; v <= kEdges; ++v) run.state.v[v] = Vec3(0.5 * std::pow(v / double(kEdges), 2), 0.0, 0.0);
    const double exact = 1.2024 * std::sqrt(kEarthGravity / kLength) / (2.0 * kPi);
    const double found = frequency(run, 1.0 / (600.0 * exact), 1.1 / exact, 5.2 / exact, [&] { return run.state.x[kEdges].x(); });
    EXPECT_NEAR(found, exact, 0.02 * exact);
    RecordProperty("ratio", std::to_string(found / exact));
}

}  // namespace
}  // namespace sim::test
