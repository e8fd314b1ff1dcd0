#include "tests/physics/fabric_runs.h"

#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

// fabric.integrator second_order: what swings keeps its energy, what meets does not rebound, what lies is at rest (fabric/vertex/README.md, Second
// order).

namespace sim::test {
namespace {

using testing::Noise;
using testing::pieceOf;

FabricSettings by(FabricTimeIntegrator integrator, bool contact = false)
{
    FabricSettings settings = withoutContact();
    settings.integrator = integrator;
    settings.contact = contact;
    settings.tolerance = contact ? 0.0 : 1.0e-8;
    return settings;
}

/// A strand that hangs from one end and was turned by 0.2 rad.
FabricPiece hangingChain(int segments = 20)
{
    const Vec3 end = 10.0 * Vec3(std::sin(0.2), -std::cos(0.2), 0.0);
    FabricPiece piece = pieceOf(strand(Vec3::Zero(), end, segments), solidFibre(2.0e7), {0.01, 0.01});
    piece.pins = {pinned({0})};
    return piece;
}

FabricPiece sheetOf(const Vec2i& nodes)
{
    ClothGrid grid;
    grid.nodes = nodes;
    grid.spacing = {0.25, 0.25};
    FabricPiece piece = pieceOf(clothGrid(grid), testing::wool(), {0.03, 0.03});
    piece.material.young = 1.0e6;
    return piece;
}

double kinetic(FabricRun& run) { return run.solver.energies(run.state, run.gravity).kinetic; }

/// Largest kinetic energy over each of two periods of 1.6 s, the second to the first.
double keptShare(FabricTimeIntegrator integrator, double h)
{
    FabricRun run(hangingChain(), by(integrator));
    const int period = static_cast<int>(std::lround(1.6 / h));
    const double first = run.largestIn(period, h, [&] { return kinetic(run); });
    return run.largestIn(2 * period, h, [&] { return run.time > 3.2 ? kinetic(run) : 0.0; }) / first;
}

TEST(SecondOrder, ChainKeepsItsSwing)
{
    EXPECT_GT(keptShare(FabricTimeIntegrator::SecondOrder, 4.0e-3), 0.97);
    EXPECT_LT(keptShare(FabricTimeIntegrator::BackwardEuler, 4.0e-3), 0.6);
}

/// Where a piece ends: one that gravity moves, or one that begins with speeds that grow with the square of the distance from its origin.
std::vector<Vec3> endOf(const FabricPiece& piece, double h, double time, double speed)
{
    FabricRun run(piece, by(FabricTimeIntegrator::SecondOrder));
    if (speed > 0.0) run.gravity.setZero();
    for (std::size_t v = 0; v < run.state.v.size(); ++v)
        if (!run.fabric.pinned[v]) run.state.v[v] = speed * run.state.x[v].squaredNorm() * Vec3(0.0, 1.0, 0.5);
    run.steps(static_cast<int>(std::lround(time / h)), h);
    return run.state.x;
}

double differenceOf(const std::vector<Vec3>& a, const std::vector<Vec3>& b)
{
    double sum = 0.0;
    for (std::size_t v = 0; v < a.size(); ++v) sum += (a[v] - b[v]).squaredNorm();
    return std::sqrt(sum / static_cast<double>(a.size()));
}

/// By differences of halved steps: of a chain's swing, and of a clamped beam that swings.
TEST(SecondOrder, PositionsAreOfSecondOrder)
{
    FabricPiece beam = pieceOf(strand(Vec3::Zero(), Vec3(2.0, 0.0, 0.3), 16), solidFibre(4.0e7), {0.04, 0.02});
    beam.pins = {pinned({0, 1})};
    struct Case {
        FabricPiece piece;
        double coarsest, time, speed;
    };
    for (const Case& c : {Case{hangingChain(10), 4.0e-3, 0.4, 0.0}, Case{beam, 5.0e-4, 0.03, 5.0}}) {
        std::array<std::vector<Vec3>, 4> x;
        for (int level = 0; level < 4; ++level) x[level] = endOf(c.piece, std::ldexp(c.coarsest, -level), c.time, c.speed);
        const std::array<double, 3> differences = {differenceOf(x[0], x[1]), differenceOf(x[1], x[2]), differenceOf(x[2], x[3])};
        EXPECT_GT(0.5 * std::log2(differences[0] / differences[2]), 1.8) << differences[0] << " " << differences[1] << " " << differences[2];
    }
}

/// Free fall, and a throw, as exact as steps are many: whatever their lengths.
TEST(SecondOrder, FallsExactlyInStepsOfAnyLength)
{
    Noise noise(11);
    FabricRun run(sheetOf({6, 5}), by(FabricTimeIntegrator::SecondOrder));
    for (Vec3& v : run.state.v) v = Vec3(20.0, 50.0, -7.0);
    const std::vector<Vec3> start = run.state.x;
    for (int n = 0; n < 40; ++n) run.step(1.0e-3 * (1.5 + noise()));
    for (std::size_t v = 0; v < start.size(); ++v) {
        const Vec3 expected = start[v] + run.time * Vec3(20.0, 50.0, -7.0) + 0.5 * run.time * run.time * run.gravity;
        EXPECT_LT((run.state.x[v] - expected).norm(), 1.0e-9);
    }
}

ObstacleSettings table(const Vec3& up)
{
    ObstacleSettings obstacle;
    obstacle.name = "table";
    Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
    pose.linear() = Eigen::Quaterniond::FromTwoVectors(Vec3::UnitY(), up).toRotationMatrix();
    obstacle.shape = Shape::box(Vec3(0.0, -5.0, 0.0), Vec3(20.0, 5.0, 20.0)).moved(pose);
    return obstacle;
}

/// Sheets turned at random meet a table turned at random, in steps that do not resolve it: no energy comes of it, little goes back, and after a second
/// nothing moves.
TEST(SecondOrder, WhatMeetsATableDoesNotReboundAndComesToRest)
{
    Noise noise(11);
    for (int n = 0; n < 12; ++n) {
        const Vec3 up = (Vec3(0.0, 1.0, 0.0) + (n % 2 ? 0.0 : 1.0) * noise.vector()).normalized();
        FabricPiece piece = sheetOf({7, 6});
        FabricRun run(piece, by(FabricTimeIntegrator::SecondOrder, true), {table(up)});
        run.gravity = -kEarthGravity * up;
        const Eigen::Quaterniond turn = Eigen::Quaterniond::FromTwoVectors(Vec3::UnitY(), (up + 0.15 * noise.vector()).normalized());
        Vec3 middle = Vec3::Zero();
        for (const Vec3& x : run.state.x) middle += x / static_cast<double>(run.state.x.size());
        for (Vec3& x : run.state.x) x = turn * (x - middle) + 0.5 * up;
        const double speed = 50.0 + 40.0 * noise(), h = n % 3 == 0 ? 4.0e-3 : 1.0e-3;
        for (Vec3& v : run.state.v) v = -speed * up;
        double energy = run.solver.energies(run.state, run.gravity).total(), back = 0.0;
        const double mass = std::accumulate(run.fabric.mass.begin(), run.fabric.mass.end(), 0.0), most = 0.5 * mass * speed * speed;
        for (int step = 0; step * h < 1.2; ++step) {
            run.step(h);
            const double now = run.solver.energies(run.state, run.gravity).total();
            EXPECT_LT(now, energy + 1.0e-3 * most) << n << " at " << run.time;
            energy = now;
            Vec3 momentum = Vec3::Zero();
            for (std::size_t v = 0; v < run.state.v.size(); ++v) momentum += run.fabric.mass[v] * run.state.v[v];
            back = std::max(back, momentum.dot(up) / mass);
        }
        EXPECT_LT(back, 0.15 * speed) << n;
        EXPECT_LT(run.fastest(), 1.0e-3) << n;
    }
}

/// Steps of other lengths change nothing of what is kept.
TEST(SecondOrder, ChainKeepsItsSwingInStepsOfAnyLength)
{
    Noise noise(3);
    FabricRun run(hangingChain(), by(FabricTimeIntegrator::SecondOrder));
    double first = 0.0, last = 0.0;
    while (run.time < 4.8) {
        run.step(2.5e-3 + 1.5e-3 * noise());
        double& most = run.time < 1.6 ? first : last;
        if (run.time < 1.6 || run.time > 3.2) most = std::max(most, kinetic(run));
    }
    EXPECT_NEAR(last / first, 1.0, 0.03);
}

/// Two sheets, a yarn between them, that meet in flight.
std::vector<FabricPiece> meeting(Noise& noise)
{
    std::vector<FabricPiece> pieces = {sheetOf({7, 6}), sheetOf({6, 8})};
    for (Vec3& x : pieces[1].points) x += Vec3(0.2 + 0.1 * noise(), 0.5, 0.1 * noise());
    const Vec3 middle(0.7, 0.25, 0.6);
    pieces.push_back(pieceOf(strand(middle - Vec3(0.6, 0.03, 0.1), middle + Vec3(0.6, 0.03 * noise(), 0.1), 8), testing::wool(), {0.04, 0.03}));
    return pieces;
}

/// What meets in flight keeps its momentum to rounding, also where it is jammed, has no more energy than before, and loses most of what it met
/// with, with either integrator.
TEST(SecondOrder, WhatMeetsInFlightKeepsItsMomentumAndGainsNothing)
{
    Noise noise(17);
    for (int n = 0; n < 10; ++n) {
        const FabricTimeIntegrator integrator = n < 5 ? FabricTimeIntegrator::SecondOrder : FabricTimeIntegrator::BackwardEuler;
        if (n == 5) noise = Noise(17);
        FabricRun run(meeting(noise), by(integrator, true));
        run.gravity = 300.0 * noise.vector();
        const double speed = 40.0 + 20.0 * noise(), h = std::pow(10.0, -3.2 + 0.4 * noise());
        const Vec3 flight = 100.0 * noise.vector();
        for (std::size_t v = 0; v < run.state.v.size(); ++v)
            run.state.v[v] = flight + Vec3(0.0, run.state.x[v].y() > 0.4 ? -speed : run.state.x[v].y() > 0.1 ? 0.0 : speed, 0.0);
        const auto momentum = [&] {
            Vec3 sum = Vec3::Zero();
            for (std::size_t v = 0; v < run.state.v.size(); ++v) sum += run.fabric.mass[v] * run.state.v[v];
            return sum;
        };
        const double mass = std::accumulate(run.fabric.mass.begin(), run.fabric.mass.end(), 0.0), met = 0.5 * mass * speed * speed;
        const Vec3 first = momentum();
        const double energy = run.solver.energies(run.state, run.gravity).total();
        double most = 0.0;
        for (int step = 0; step * h < 0.03; ++step) {
            run.step(h);
            most = std::max(most, run.solver.energies(run.state, run.gravity).total() - energy);
        }
        EXPECT_LT((momentum() - first - run.time * mass * run.gravity).norm(), 1.0e-10 * mass * speed) << n;
        EXPECT_LT(most, 1.0e-3 * met) << n;
        EXPECT_LT(run.solver.energies(run.state, run.gravity).total() - energy, -0.3 * met) << n << " they did not meet";
    }
}

}  // namespace
}  // namespace sim::test
