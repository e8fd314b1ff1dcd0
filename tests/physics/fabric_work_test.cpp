#include "sim/core/check.h"
#include "tests/physics/fabric_runs.h"

#include <gtest/gtest.h>

#include <array>
#include <numeric>

// What holds and drives fabric gives it what the budget says, and what is far from it nothing.

namespace sim::test {
namespace {

using testing::Noise;
using testing::pieceOf;

FabricPiece yarn(Noise& noise, const Vec3& from, const Vec3& along)
{
    FabricPiece piece = pieceOf(strand(from, from + along, 8 + static_cast<int>(4.0 * std::abs(noise()))), testing::wool(), {0.03, 0.025});
    piece.material.young = std::pow(10.0, 7.0 + 0.5 * noise());
    return piece;
}

/// A clamp at rest does no work, however the yarn that it keeps from turning tilts about it.
TEST(FabricWork, PinsAtRestGiveNothing)
{
    Noise noise(5);
    for (int n = 0; n < 12; ++n) {
        FabricPiece piece = yarn(noise, Vec3::Zero(), Vec3(1.0, 0.2 * noise(), 0.2 * noise()));
        piece.pins = {pinned(n % 2 == 0 ? std::vector<int>{0} : std::vector<int>{0, 1}, true)};
        FabricSettings settings = withoutContact();
        settings.newton = 1 + n % 3;
        settings.integrator = FabricTimeIntegrator::BackwardEuler;  // by that of second order clamps' twist is booked by the mean of two ends
        FabricRun run(piece, settings);
        for (Vec3& v : run.state.v) v = 10.0 * noise.vector();
        run.solver.bookEnergy();
        for (int i = 0; i < 40; ++i) EXPECT_EQ((*run.step(2.0e-3).energyChanges)[EnergyChange::Pins], 0.0) << "yarn " << n << " step " << i;
        EXPECT_GT(run.energies().twisting, 0.0);
    }
}

/// Rise beyond the work of pins that an integrator may have, relative to the largest kinetic energy: by that of second order their work is that of the
/// mean of the forces at both ends of a step, in which stiff fabric changes them by more than a half (found: .025).
double bookedTo(FabricTimeIntegrator integrator) { return integrator == FabricTimeIntegrator::SecondOrder ? 0.03 : 0.01; }

/// The largest rise of energy beyond what pins gave, relative to the largest kinetic energy, in so many steps of h [s].
double riseBeyondPins(FabricRun& run, int steps, double h)
{
    run.solver.bookEnergy();
    double given = 0.0, kinetic = 0.0, least = run.energies().total(), rise = 0.0;
    for (int i = 0; i < steps; ++i) {
        given += (*run.step(h).energyChanges)[EnergyChange::Pins];
        const double own = run.energies().total() - given;
        rise = std::max(rise, own - least);
        least = std::min(least, own);
        kinetic = std::max(kinetic, run.energies().kinetic);
    }
    return rise / kinetic;
}

/// Yarns that are led as a whole: errors of their stiff forces, as few iterations leave them, are forces within them, which give nothing.
TEST(FabricWork, PinsThatLeadGiveWhatIsGot)
{
    Noise noise(9);
    for (int n = 0; n < 12; ++n) {
        const Vec3 along = Vec3(0.5, 0.0, 0.1 * noise());
        FabricPiece piece = yarn(noise, Vec3::Zero(), along);
        piece.radius = {0.013, 0.013};
        piece.material.density = 0.3;
        Motion motion;
        motion.addOscillation(4.0e-3, 1.0, (along + 0.05 * noise.vector()).normalized(), 0.06, 13.0 + 4.0 * noise());
        piece.pins = {pinned({0, 1}, n % 2 == 0, motion)};
        FabricSettings settings = withoutContact();
        settings.newton = 1;
        for (const FabricTimeIntegrator integrator : {FabricTimeIntegrator::BackwardEuler, FabricTimeIntegrator::SecondOrder}) {
            settings.integrator = integrator;
            FabricRun run(piece, settings);
            EXPECT_LT(riseBeyondPins(run, 60, 1.0e-3), bookedTo(integrator)) << "yarn " << n;
        }
    }
}

/// Pins that take energy from fabric take all that it loses: what it keeps of that it has from nothing, though its energy falls.
TEST(FabricWork, PinsThatBrakeTakeWhatIsLost)
{
    Noise noise(4);
    for (int n = 0; n < 16; ++n) {
        ClothGrid grid;
        grid.nodes = Vec2i(3, 5);
        grid.spacing = {0.064, 0.064};
        FabricPiece piece = pieceOf(clothGrid(grid), testing::wool(), {0.012, 0.01});
        piece.material.young = std::pow(10.0, 7.0 + 0.5 * noise());
        piece.material.density = 0.5;
        Motion motion;
        motion.addOscillation(0.0, 10.0, (Vec3::UnitY() + 0.3 * noise.vector()).normalized(), 0.05 + 0.02 * noise(), 5.0 + 2.0 * noise());
        piece.pins = {pinned({0, 1}, false, motion)};
        FabricSettings settings = withoutContact();
        settings.tolerance = 0.0;  // that of scenes
        settings.newton = 1 + n % 3;
        settings.maxHalvings = 3;
        for (const FabricTimeIntegrator integrator : {FabricTimeIntegrator::BackwardEuler, FabricTimeIntegrator::SecondOrder}) {
            settings.integrator = integrator;
            FabricRun run(piece, settings);
            run.gravity = Vec3(0.0, -90.0, 0.0);
            EXPECT_LT(riseBeyondPins(run, 60, 2.4e-3), bookedTo(integrator)) << "cloth " << n;
        }
    }
}

/// Does a run of so many steps of length h [s] end in a jam? Until then the fabric must have no energy that nothing gave.
bool endsInAJam(FabricRun& run, int steps, double h)
{
    run.solver.bookEnergy();
    double given = 0.0, kinetic = 0.0, rise = 0.0;
    const double start = run.energies().total();
    bool jams = false;
    try {
        for (int i = 0; i < steps; ++i) {
            const EnergyChanges changes = *run.step(h).energyChanges;
            given += changes[EnergyChange::Pins] + changes[EnergyChange::Obstacles];
            kinetic = std::max(kinetic, run.energies().kinetic);
            rise = std::max(rise, run.energies().total() - start - given);
        }
    } catch (const RunError& error) {
        jams = true;
        EXPECT_NE(std::string(error.what()).find("jammed"), std::string::npos) << error.what();
    }
    EXPECT_LT(rise, 0.01 * kinetic);
    return jams;
}

/// A sheet that pins lead, and the solid in its way.
struct LedSheet {
    FabricPiece piece;
    ObstacleSettings solid;
};

/// Pins draw it over a ball.
LedSheet drawnOverABall(int n)
{
    Noise noise(20 + n);
    ClothGrid grid;
    grid.nodes = Vec2i(10, 10);
    grid.spacing = {0.12, 0.12};
    LedSheet sheet{pieceOf(clothGrid(grid), testing::wool(), {0.02, 0.02}), {}};
    sheet.piece.material.young = 3.0e8;
    Motion motion;
    motion.addTranslation(0.0, 0.02, Vec3(0.2 * noise(), -3.0, 0.2 * noise()), 0.0, 0.0);
    sheet.piece.pins = {pinned({0, 9, 90, 99}, false, motion)};
    sheet.solid.name = "ball";
    sheet.solid.shape = Shape::ball(Vec3(0.54 + 0.1 * noise(), -0.4, 0.54), 0.3);
    return sheet;
}

/// Pins that turn its corners press it into a floor.
LedSheet pressedIntoAFloor(int n)
{
    Noise noise(60 + n);
    ClothGrid grid;
    grid.nodes = Vec2i(10, 7);
    grid.spacing = {0.158, 0.158};
    LedSheet sheet{pieceOf(clothGrid(grid), testing::wool(), {0.015, 0.015}), {}};
    sheet.piece.material.young = std::pow(10.0, 7.0 + 0.3 * noise());
    sheet.piece.material.density = 0.28;
    sheet.piece.material.dampingViscosity = 6.0e3;
    Motion motion;
    motion.addRotation(0.0, 0.06, {(Vec3(-0.9, 0.2, -0.3) + 0.2 * noise.vector()).normalized(), Vec3(0.71, 0.0, 0.47)}, 0.9 + 0.2 * noise(), 0.0,
                       0.0);
    std::vector<int> corners;
    for (int i : {0, 1, 2, 7, 8, 9})
        for (int j : {0, 1, 2, 4, 5, 6}) corners.push_back(10 * j + i);
    std::ranges::sort(corners);
    sheet.piece.pins = {pinned(corners, false, motion)};
    sheet.solid.name = "floor";
    sheet.solid.shape = Shape::box(Vec3(0.7, -1.28 + 0.1 * noise(), 0.5), Vec3(3.0, 1.0, 3.0));
    return sheet;
}

FabricSettings lastAttempts(int n)
{
    FabricSettings settings;
    settings.maxHalvings = n % 3;
    settings.newton = 1 + n % 2;
    return settings;
}

/// A sheet that pins tear against a solid holds no energy that nothing gave: the run ends and tells where.
TEST(FabricWork, AJamEndsTheRunWhereItGains)
{
    int jams = 0;
    for (int n = 0; n < 6; ++n) {
        SCOPED_TRACE("sheet " + std::to_string(n));
        const LedSheet sheet = drawnOverABall(n);
        FabricRun run(sheet.piece, lastAttempts(n), {sheet.solid});
        jams += endsInAJam(run, 30, 1.0e-3) ? 1 : 0;
    }
    EXPECT_GT(jams, 0);
}

/// The same where little is stretched. What a step gains too little of to matter adds up.
TEST(FabricWork, WhatFabricOwesAddsUpOverSteps)
{
    int jams = 0;
    for (int n = 0; n < 8; ++n) {
        SCOPED_TRACE("sheet " + std::to_string(n));
        const LedSheet sheet = pressedIntoAFloor(n);
        FabricRun run(sheet.piece, lastAttempts(n), {sheet.solid});
        jams += endsInAJam(run, 50, 1.25e-3) ? 1 : 0;
    }
    EXPECT_GT(jams, 0);
}

/// Yarns and a sheet that fall onto each other do so alike whether a solid moves somewhere else or not.
TEST(FabricWork, SolidsThatMoveElsewhereChangeNothing)
{
    ClothGrid grid;
    grid.nodes = Vec2i(9, 9);
    grid.spacing = {0.12, 0.12};
    FabricPiece sheet = pieceOf(clothGrid(grid), testing::wool(), {0.02, 0.02});
    sheet.pins = {pinned({0, 8, 72, 80})};
    std::vector<FabricPiece> pieces = {sheet};
    Noise noise(2);
    for (int n = 0; n < 3; ++n) {
        pieces.push_back(yarn(noise, Vec3(-0.2, 0.15 + 0.1 * n, 0.3 + 0.1 * n), Vec3(1.4, 0.05, 0.2 * n)));
        pieces.back().velocity = Vec3(0.0, -80.0, 0.0);
    }
    FabricSettings settings;
    settings.maxHalvings = 4;
    const auto endOf = [&](std::vector<ObstacleSettings> solids) {
        FabricRun run(pieces, settings, std::move(solids));
        int splits = 0;
        for (int i = 0; i < 40; ++i) splits += run.step(2.0e-3).substepSplits;
        EXPECT_GT(splits, 0);
        return run.state;
    };
    ObstacleSettings ball;
    ball.shape = Shape::ball(Vec3(30.0, 0.0, 0.0), 1.0);
    const FabricState still = endOf({ball});
    ball.motion.addOscillation(0.0, 10.0, Vec3::UnitY(), 2.0, 5.0);
    const FabricState moved = endOf({ball});
    for (std::size_t v = 0; v < still.x.size(); ++v) {
        EXPECT_EQ(still.x[v], moved.x[v]) << v;
        EXPECT_EQ(still.v[v], moved.v[v]) << v;
    }
}

}  // namespace
}  // namespace sim::test
