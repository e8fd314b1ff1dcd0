#include "tests/physics/fabric_runs.h"

#include <gtest/gtest.h>

// Yarns that are twisted, and when they give way (fabric/rods/README.md, Energies).

namespace sim::test {
namespace {

using testing::pieceOf;

/// A straight round yarn along x of n edges of length 0.2, the first and the last clamped.
struct TwistedYarn {
    explicit TwistedYarn(int n, const Motion& ofLast = {}) : edges(n)
    {
        piece = pieceOf(strand(Vec3::Zero(), Vec3(n * kEdge, 0.0, 0.0), n), solidFibre(1.0e8), {0.03, 0.03});
        hold(ofLast);
    }
    void hold(const Motion& ofLast)
    {
        piece.pins = {pinned({0}, true), pinned({1}), pinned({edges - 1}, false, ofLast), pinned({edges}, true, ofLast)};
    }
    static constexpr double kEdge = 0.2;
    int edges;
    FabricPiece piece;
    double bentLength() const { return (edges - 1) * kEdge; }  ///< between the middles of the clamped edges [cm]
};

Motion turned(double t0, double t1, double angle)
{
    Motion motion;
    motion.addRotation(t0, t1, {Vec3::UnitX(), Vec3::Zero()}, angle, 0.0, 0.0);
    return motion;
}

/// The last edge turns as its pin does, more than once round; twist spreads evenly, and so its torque is GJ Φ/L.
TEST(TwistedYarn, SpreadsItsTwistEvenly)
{
    const double turn = 2.5 * kPi;
    TwistedYarn yarn(30, turned(0.0, 1.0, turn));
    FabricSettings settings = withoutContact();
    settings.tolerance = 1.0e-13;
    FabricRun run(yarn.piece, settings);
    run.gravity.setZero();
    for (int i = 0; i < 500; ++i) {
        run.step(0.002);
        EXPECT_NEAR(run.state.theta.back(), turn * std::min(1.0, run.time), 1.0e-12);
    }
    run.steps(500, 0.002);
    double worst = 0.0;  // of the twists between edges
    for (int e = 1; e < yarn.edges; ++e) {
        const double twist = run.state.referenceTwist[e] + run.state.theta[e] - run.state.theta[e - 1];
        worst = std::max(worst, std::abs(twist - turn / (yarn.edges - 1)));
    }
    EXPECT_LT(worst, 1.0e-13 * turn);
    const double torque = 2.0 * run.energies().twisting / turn, exact = torsionStiffness(yarn.piece) * turn / yarn.bentLength();
    EXPECT_NEAR(torque, exact, 1.0e-12 * exact);
    RecordProperty("worst", std::to_string(worst * 1e15) + "e-15");
    RecordProperty("torque", std::to_string((torque / exact - 1.0) * 1e15) + "e-15");
}

double offAxis(const FabricRun& run)
{
    double off = 0.0;
    for (const Vec3& x : run.state.x) off = std::max(off, std::hypot(x.y(), x.z()));
    return off;
}

void shake(FabricRun& run, double size)
{
    testing::Noise noise(4);
    for (std::size_t v = 0; v < run.state.x.size(); ++v)
        if (!run.fabric.pinned[v]) run.state.x[v] += size * noise.vector();
}

/// How much a slight disturbance of a twisted straight yarn grows from one while to the next. Steps are short beside
/// the slowest vibration: with a single Newton iteration longer ones would make even a stable yarn restless.
double growthAtTwist(double moment)  // in units of EI/L
{
    TwistedYarn yarn(61);
    const double twist = moment * bendingStiffness(yarn.piece) / torsionStiffness(yarn.piece);
    yarn.hold(turned(-2.0, -1.0, twist));
    FabricRun run(yarn.piece);
    run.gravity.setZero();
    for (int e = 0; e < yarn.edges; ++e) run.state.theta[e] = twist * e / (yarn.edges - 1);
    shake(run, 1.0e-6);
    const double before = run.largestIn(1000, 2.0e-3, [&] { return offAxis(run); });
    return run.largestIn(1000, 2.0e-3, [&] { return offAxis(run); }) / before;
}

/// A crimped yarn whose last edge was left spinning, as by a step that was cut short: in a long step, too, energy only falls. From the
/// free flight of its angle, one turn further, Newton ended wound up, with six times the energy.
TEST(CrimpedYarn, SpinOfItsEndDoesNotAccumulateTwist)
{
    std::vector<Vec3> path;
    for (int i = 0; i <= 20; ++i) path.emplace_back(0.144 * i, i % 2 == 0 ? 0.0 : 0.07, 0.0);
    FabricPiece piece = pieceOf(strand(path), testing::wool(), {0.048, 0.048});
    piece.material.young = 6.6e8;
    piece.pins = {pinned({0, 1}, true)};
    FabricRun run(piece);
    run.gravity.setZero();
    constexpr double h = 4.0e-3;
    run.state.omega.back() = 2.0 * kPi / h;
    double before = run.energies().total();
    for (int n = 0; n < 6; ++n) {
        run.step(h);
        const double now = run.energies().total();
        EXPECT_LT(now, before) << "step " << n;
        before = now;
    }
}

/// Clamped at both ends and not pulled, a straight yarn bears a moment of 8.987 EI/L.
TEST(TwistedYarn, BucklesAtGreenhillsMoment)
{
    const double below = growthAtTwist(0.98 * 8.987), above = growthAtTwist(1.02 * 8.987);
    EXPECT_LT(below, 1.0);
    EXPECT_GT(above, 2.0);
    RecordProperty("growth", std::to_string(below) + " " + std::to_string(above));
}

/// An upright yarn, clamped at its foot, bears a weight per length of 7.837 EI/L³.
TEST(UprightYarn, BucklesUnderItsWeight)
{
    const auto growth = [](double load) {
        Cantilever beam(60, 0.1, 0.05, 1.0e8, Vec3::UnitY());
        FabricRun run(beam.piece);
        const double weight = load * bendingStiffness(beam.piece) / std::pow(beam.effectiveLength, 3);
        run.gravity = Vec3(0.0, -weight / lineDensity(beam.piece), 0.0);
        run.steps(100, 0.004);  // it gets shorter first
        testing::Noise noise(5);
        for (int v = 2; v <= beam.tip; ++v) run.state.x[v] += 1.0e-6 * Vec3(noise(), 0.0, noise());
        const auto off = [&] { return std::hypot(run.state.x[beam.tip].x(), run.state.x[beam.tip].z()); };
        const double before = run.largestIn(600, 0.004, off);
        return run.largestIn(600, 0.004, off) / before;
    };
    // ±2 % of the height that it can have are ±6 % of the load.
    const double below = growth(0.98 * 7.837), above = growth(1.02 * 7.837);
    EXPECT_LT(below, 1.0);
    EXPECT_GT(above, 2.0);
    RecordProperty("growth", std::to_string(below) + " " + std::to_string(above));
}

/// A naturally straight yarn of n edges closed to a ring with Θ of twist: its last edge, clamped, lies on its first.
/// Holding one edge only takes away the ring's rigid motions.
struct MichellRing {
    MichellRing(int n, double thetaTotal) : edges(n), yarn(n + 1, closing(n, thetaTotal)), run(yarn.piece)
    {
        run.gravity.setZero();
        // Bent bit by bit, so that the frames are carried around without twist.
        const Rods rods(run.fabric, restState(run.fabric), run.settings);
        constexpr int kBits = 40;
        for (int k = 1; k <= kBits; ++k) {
            Vec3 x(0.0, 0.0, 0.0);
            for (int v = 0; v <= n + 1; ++v) {
                run.state.x[v] = x;
                const double a = 2.0 * kPi * v / n * k / kBits;
                x += TwistedYarn::kEdge * Vec3(std::cos(a), std::sin(a), 0.0);
            }
            rods.transportFrames(run.state);
        }
        for (int e = 0; e <= n; ++e) run.state.theta[e] = thetaTotal * e / n;
    }
    /// The last edge lies a ring's length away at rest.
    static Motion closing(int n, double thetaTotal)
    {
        Motion motion = turned(-2.0, -1.0, thetaTotal);
        motion.addTranslation(-1.0, -0.5, Vec3(-n * TwistedYarn::kEdge, 0.0, 0.0), 0.0, 0.0);
        return motion;
    }
    double offPlane() const
    {
        double largest = 0.0;
        for (const Vec3& x : run.state.x) largest = std::max(largest, std::abs(x.z()));
        return largest;
    }
    /// Share of what goes twice around in z, apart from the rigid motion that keeps the clamped edge in place [0..1].
    double shareOfMode2() const
    {
        const auto squareOfMode = [&](int k) {
            double c = 0.0, s = 0.0;
            for (int v = 1; v <= edges; ++v) {
                const double z = run.state.x[v].z(), a = 2.0 * kPi * k * v / edges;
                c += z * std::cos(a), s += z * std::sin(a);
            }
            return (k == 0 ? 1.0 : 2.0) * (c * c + s * s) / (edges * edges);
        };
        double all = 0.0;
        for (int v = 1; v <= edges; ++v) all += run.state.x[v].z() * run.state.x[v].z() / edges;
        return squareOfMode(2) / (all - squareOfMode(0) - squareOfMode(1));
    }

    int edges;
    TwistedYarn yarn;
    FabricRun run;
};

struct RingGrowth {
    double growth, ofMode2;  ///< [-]
};

RingGrowth growthOfRing(int n, double twist)
{
    MichellRing ring(n, twist);
    EXPECT_LT(ring.run.fastest(), 1.0e-12);
    shake(ring.run, 1.0e-6);
    const double radius = n * TwistedYarn::kEdge / (2.0 * kPi);
    const double time = radius * radius * std::sqrt(lineDensity(ring.yarn.piece) / bendingStiffness(ring.yarn.piece));
    const auto off = [&] { return ring.offPlane(); };
    const double before = ring.run.largestIn(2000, 0.02 * time, off), after = ring.run.largestIn(2000, 0.02 * time, off);
    return {after / before, ring.shareOfMode2()};
}

/// Θ = 2π√3 EI/GJ, and the discrete ring's threshold is 1.081 times that with 20 edges, 1.035 times with 30
/// (fabric/rods/README.md, Energies).
TEST(MichellRing, BucklesAtTheThresholdOfItsDiscreteEnergies)
{
    const TwistedYarn yarn(10);
    const double continuum = 2.0 * kPi * std::sqrt(3.0) * bendingStiffness(yarn.piece) / torsionStiffness(yarn.piece);
    EXPECT_NEAR(continuum, 14.69, 0.005);
    for (const auto& [n, factor] : {std::pair(20, 1.081), std::pair(30, 1.035)}) {
        const RingGrowth below = growthOfRing(n, 0.99 * factor * continuum), above = growthOfRing(n, 1.01 * factor * continuum);
        EXPECT_LT(below.growth, 1.0) << n;
        EXPECT_GT(above.growth, 2.0) << n;
        EXPECT_GT(above.ofMode2, 0.95) << n;
        RecordProperty("growth" + std::to_string(n),
                       std::to_string(below.growth) + " " + std::to_string(above.growth) + " " + std::to_string(above.ofMode2));
    }
}

}  // namespace
}  // namespace sim::test
