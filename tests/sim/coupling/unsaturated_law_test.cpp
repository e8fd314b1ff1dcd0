#include "sim/coupling/unsaturated_law.h"

#include "sim/fabric/pieces/generators.h"
#include "tests/sim/coupling/wick.h"

#include <gtest/gtest.h>

#include <random>

namespace sim::test {
namespace {

const double kDiffusivity = 0.6 * 2.0 * 5933.6 * 2.5045e-6 / 8.9e-3;  // of the linear law at S = 1, as in wicking_test.cpp [cm^2/s]

WickingSettings exponents(double a, double b)
{
    WickingSettings settings;
    settings.suctionExponent = a;
    settings.permeabilityExponent = b;
    return settings;
}

FabricPiece rod(int segments, const Vec3& to) { return testing::pieceOf(strand(Vec3::Zero(), to, segments), testing::wool(), {0.05, 0.05}); }

TEST(UnsaturatedLaw, ExponentsOfOneAreTheLinearLaw)
{
    const UnsaturatedLaw law{WickingSettings()};
    ASSERT_TRUE(law.isLinear());
    EXPECT_FALSE(UnsaturatedLaw(exponents(2.0, 1.0)).isLinear());
    EXPECT_FALSE(UnsaturatedLaw(exponents(1.0, 2.0)).isLinear());
    for (const double s : {0.0, 0.1, 0.37, 1.0}) {
        EXPECT_EQ(law.suction(s), 1.0 - s);
        EXPECT_EQ(law.permeability(s), s);
        for (const double other : {0.0, 0.2, 1.0}) EXPECT_NEAR(law.meanPermeability(s, other), 0.5 * (s + other), 1.0e-14);
    }
}

/// It is the integral of the permeability over the suction, by 20000 strips, and goes over into that of one place.
TEST(UnsaturatedLaw, MeanPermeabilityIsOverTheSuction)
{
    constexpr int kStrips = 20000;
    for (const auto& [a, b] : {std::pair(0.5, 1.0), std::pair(1.0, 4.0), std::pair(22.0, 4.0), std::pair(3.0, 9.3)}) {
        const UnsaturatedLaw law(exponents(a, b));
        for (const auto& [low, high] : {std::pair(0.0, 1.0), std::pair(0.2, 0.7), std::pair(0.5, 0.50004)}) {
            double sum = 0.0;
            for (int n = 0; n < kStrips; ++n) {
                const auto at = [&](double part) { return low + (high - low) * (n + part) / kStrips; };
                sum += law.permeability(at(0.5)) * (law.suction(at(0.0)) - law.suction(at(1.0)));
            }
            const double mean = sum / (law.suction(low) - law.suction(high));
            EXPECT_NEAR(law.meanPermeability(low, high), mean, 1.0e-5 * mean) << a << ", " << b << ": " << low << " to " << high;
            EXPECT_EQ(law.meanPermeability(low, high), law.meanPermeability(high, low));
        }
        for (const double least : {0.0, 1.0e-300, 1.0e-40}) EXPECT_LE(law.meanPermeability(least, 2.0 * least), 1.0e-20) << "where powers vanish";
    }
}

/// An even jitter of points and a new order of vertices and faces.
FabricPiece cloth(std::mt19937& random, const std::vector<int>& numbers)
{
    std::uniform_real_distribution<double> unit(0.0, 1.0);
    FabricGeometry geometry = clothGrid({{9, 9}, {0.144, 0.12}, Vec3::Zero()});
    for (Vec3& x : geometry.points) x += 0.02 * Vec3(unit(random), unit(random), unit(random));
    FabricGeometry renumbered = geometry;
    for (std::size_t v = 0; v < numbers.size(); ++v) renumbered.points[numbers[v]] = geometry.points[v];
    for (Vec3i& face : renumbered.faces)
        for (int c = 0; c < 3; ++c) face[c] = numbers[face[c]];
    std::ranges::reverse(renumbered.faces);
    return testing::pieceOf(renumbered, testing::wool(), {0.017, 0.02});
}

std::vector<int> inOrder()
{
    std::vector<int> numbers(81);
    std::iota(numbers.begin(), numbers.end(), 0);
    return numbers;
}

/// Over random meshes, exponents and fillings, in steps of many parts and with gravity.
TEST(Wicking, UnsaturatedFlowKeepsMassAndMomentum)
{
    std::mt19937 random(11);
    std::uniform_real_distribution<double> unit(0.0, 1.0);
    for (int n = 0; n < 12; ++n) {
        Wick wick({cloth(random, inOrder()), rod(20, Vec3(1.0, 0.7, 0.2))});
        wick.settings.coupling.wicking = exponents(std::pow(30.0, 2.0 * unit(random) - 0.7), 1.0 + 9.0 * unit(random));
        wick.fill([&](const Vec3&) { return unit(random) < 0.3 ? 0.0 : 1.1 * unit(random); });
        for (Vec3& v : wick.state.v) v = Vec3(unit(random), unit(random) - 0.5, 2.0 * unit(random));
        wick.before = wick.state.v;
        const double mass = wick.mass();
        const Vec3 momentum = wick.momentum();
        const std::vector<double> before = wick.state.absorbed;
        wick.run(2.0e-3, 5, Vec3(0.0, -981.0, 0.0));
        EXPECT_NE(before, wick.state.absorbed);
        EXPECT_GE(std::ranges::min(wick.state.absorbed), 0.0);
        EXPECT_NEAR(wick.mass(), mass, 1.0e-13 * mass);
        EXPECT_LT((wick.momentum() - momentum).norm(), 1.0e-13 * momentum.norm());
    }
}

/// Without gravity fillings stay between the least and the largest that there were.
TEST(Wicking, UnsaturatedFlowDoesNotOvershoot)
{
    std::mt19937 random(12);
    std::uniform_real_distribution<double> unit(0.0, 1.0);
    for (const auto& [a, b] : {std::pair(1.0, 1.0), std::pair(0.5, 1.0), std::pair(1.0, 4.0), std::pair(22.0, 4.0), std::pair(60.0, 1.0)}) {
        Wick wick({testing::pieceOf(clothGrid({{9, 9}, {0.144, 0.12}, Vec3::Zero()}), testing::wool(), {0.017, 0.02}), rod(40, Vec3(1.0, 0.7, 0.2))});
        wick.settings.coupling.wicking = exponents(a, b);
        wick.fill([&](const Vec3&) { return unit(random) < 0.3 ? 0.2 : unit(random) < 0.5 ? 1.0 : 0.2 + 0.8 * unit(random); });
        for (int n = 0; n < 50; ++n) {
            wick.run(1.0e-4, 1, Vec3::Zero());
            for (std::size_t v = 0; v < wick.state.absorbed.size(); ++v) {
                EXPECT_LE(wick.saturation(v), 1.0 + 1.0e-12) << a << ", " << b;
                EXPECT_GE(wick.saturation(v), 0.2 - 1.0e-12) << a << ", " << b;
            }
        }
    }
}

TEST(Wicking, UnsaturatedFlowKnowsNoNumbering)
{
    std::vector<int> numbers = inOrder();
    std::mt19937 random(13);
    std::ranges::shuffle(numbers, random);
    std::mt19937 one(14), other(14);
    Wick wick({cloth(one, inOrder())}), renumbered({cloth(other, numbers)});
    for (Wick* each : {&wick, &renumbered}) {
        each->settings.coupling.wicking = exponents(22.0, 4.0);
        each->fill([](const Vec3& x) { return x.x() < 0.5 ? 0.95 : 0.1; });
        each->run(1.0e-3, 20, Vec3(-300.0, 0.0, 0.0));
    }
    for (std::size_t v = 0; v < numbers.size(); ++v) EXPECT_NEAR(wick.saturation(v), renumbered.saturation(numbers[v]), 1.0e-11) << v;
}

/// Exponents next to 1 give what 1 does, and steeper laws ask for more substeps.
TEST(Wicking, UnsaturatedFlowGoesOverIntoTheLinear)
{
    Wick linear({rod(20, Vec3(0.0, 1.0, 0.0))}), near({rod(20, Vec3(0.0, 1.0, 0.0))});
    near.settings.coupling.wicking = exponents(1.0 + 1.0e-9, 1.0 + 1.0e-9);
    for (Wick* wick : {&linear, &near}) {
        wick->fill([](const Vec3& x) { return x.y() < 0.3 ? 0.8 : 0.1; });
        wick->run(1.0e-3, 50, Vec3(0.0, -981.0, 0.0));
    }
    for (std::size_t v = 0; v < linear.state.absorbed.size(); ++v) EXPECT_NEAR(linear.saturation(v), near.saturation(v), 1.0e-7);
    near.settings.coupling.wicking = exponents(10.0, 1.0);
    EXPECT_NEAR(Wicking(near.fabric, near.elements, near.settings).substeps(1.0),
                10 * Wicking(linear.fabric, linear.elements, linear.settings).substeps(1.0), 10);
}

/// In a yarn that hangs suction holds the weight: P_c times the change of S^a is that of ρ g y (coupling/README.md, Wicking).
TEST(Wicking, UnsaturatedColumnAtRest)
{
    constexpr int kSegments = 15;
    constexpr double kHeight = 1.5, kGravity = 981.0, kExponent = 3.0;
    Wick wick({rod(kSegments, Vec3(0.0, kHeight, 0.0))});
    wick.settings.coupling.wicking = exponents(kExponent, 2.0);
    wick.fill([](const Vec3&) { return 0.7; });
    wick.run(2.0e-3, 5000, Vec3(0.0, -kGravity, 0.0));
    const double change = std::pow(wick.saturation(0), kExponent) - std::pow(wick.saturation(kSegments), kExponent);
    EXPECT_NEAR(change, kGravity * kHeight / (2.0 * 5933.6), 1.0e-3 * change);
}

/// Solution of ds/dt = d/dx(a s^(a + b - 1) ds/dx), s = 1 at x = 0 and 0 far away, in units of √t.
struct Similarity {
    double uptake, front;  ///< length taken up, place where s is 0.5
};

/// From the foot of the front, s = 0, to the end, s = 1, with s as the variable: dx/ds = −a s^(a + b - 1)/q, dq/ds = x/2.
/// @return x at s = 1, or below 0
double runFrom(double foot, double a, double b, Similarity& out)
{
    constexpr int kSteps = 4000;
    constexpr double kStep = 1.0 / kSteps;
    double x = foot, q = 0.0;
    for (int n = 0; n < kSteps && x >= 0.0; ++n) {
        const double change = a * std::pow((n + 0.5) * kStep, a + b - 1.0) / (q + 0.25 * x * kStep) * kStep;
        q += 0.5 * (x - 0.5 * change) * kStep;
        x -= change;
        if (n == kSteps / 2 - 1) out.front = x;
    }
    out.uptake = 2.0 * q;
    return x;
}

Similarity similarity(double a, double b)
{
    Similarity out{};
    double low = 0.0, high = 4.0 * std::sqrt(a);
    for (int n = 0; n < 60; ++n) {
        const double middle = 0.5 * (low + high);
        (runFrom(middle, a, b, out) < 0.0 ? low : high) = middle;
    }
    runFrom(high, a, b, out);
    return out;
}

/// Uptake and front of a dry yarn with a full end, relative to the similarity solution.
Similarity filled(double a, double b, int segments)
{
    constexpr double kLength = 3.0, kStep = 1.0e-5, kTime = 0.1;  // cm, s
    Wick wick({rod(segments, Vec3(kLength, 0.0, 0.0))});
    wick.settings.coupling.wicking = exponents(a, b);
    Wicking wicking(wick.fabric, wick.elements, wick.settings);
    for (int n = 0; n < std::lround(kTime / kStep); ++n) {
        wick.state.absorbed[0] = poreVolume(wick.fabric, 0);
        wicking.move(kStep, Vec3::Zero(), BlockGrid(), BlockArray<double>(), wick.before, wick.state);
    }
    int v = 0;
    while (wick.saturation(v + 1) > 0.5) ++v;
    const double place = v + (wick.saturation(v) - 0.5) / (wick.saturation(v) - wick.saturation(v + 1)), pitch = kLength / segments;
    const Similarity exact = similarity(a, b);
    const double unit = std::sqrt(kDiffusivity * kTime);
    return {wick.mass() / (poreVolume(wick.fabric, 1) / pitch) / (exact.uptake * unit), place * pitch / (exact.front * unit)};
}

TEST(Wicking, DryYarnFillsAsTheSimilaritySolutionHasIt)
{
    EXPECT_NEAR(similarity(1.0, 1.0).uptake, 0.8875, 2.0e-3);
    for (const auto& [a, b] : {std::pair(1.0, 4.0), std::pair(4.0, 1.0), std::pair(6.0, 4.0)}) {
        const Similarity coarse = filled(a, b, 60), fine = filled(a, b, 120);
        EXPECT_NEAR(fine.uptake, 1.0, 0.04) << a << ", " << b;
        EXPECT_NEAR(fine.front, 1.0, 0.04) << a << ", " << b;
        EXPECT_LT(std::abs(fine.uptake - 1.0), 0.7 * std::abs(coarse.uptake - 1.0)) << a << ", " << b;
    }
}

}  // namespace
}  // namespace sim::test
