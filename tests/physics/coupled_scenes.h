#pragma once

#include "sim/energy_changes.h"
#include "sim/fabric/pieces/generators.h"
#include "sim/simulation.h"
#include "tests/sim/fabric/pieces.h"

#include <gtest/gtest.h>
#include <Eigen/Geometry>
#include <algorithm>
#include <functional>
#include <random>
#include <utility>

// Random scenes of liquid with fabric, and the energy that they gain from nothing.

namespace sim::test {

inline bool isDriven(const Scene& scene)
{
    const auto moves = [](const auto& what) { return !what.motion.isStatic(); };
    return std::ranges::any_of(scene.obstacles, moves) ||
           std::ranges::any_of(scene.fabrics, [&](const FabricPiece& piece) { return std::ranges::any_of(piece.pins, moves); });
}

/// Largest rise of all energy but what solids and pins have given over the least before, relative to the largest kinetic energy until then [-].
/// @param longest  that the next step may be [s]
/// @param jams     counts the runs that end where fabric is jammed, if not null; others go on to their end
inline double gainOf(
    const Scene& scene, double duration, const std::function<double()>& longest = [] { return 1.0; }, int* jams = nullptr)
{
    Simulation run(scene);
    run.bookEnergy();
    double least = run.energies().total(), kinetic = 0.0, rise = 0.0, given = 0.0;
    while (run.state().time < duration) {
        StepReport report;
        try {
            report = run.step(std::min(duration, run.state().time + longest()));
        } catch (const RunError& stop) {
            if (jams == nullptr || std::string(stop.what()).find("fabric is jammed") == std::string::npos) throw;
            ++*jams;
            break;
        }
        if (report.isReflected) continue;
        kinetic = std::max(kinetic, report.energies.kinetic + report.energies.modal + report.energies.fabric.kinetic);
        if (isDriven(scene))
            for (EnergyChange from : {EnergyChange::Pins, EnergyChange::Obstacles, EnergyChange::Solids})
                given += std::as_const(*report.energyChanges)[from];
        const double own = report.energies.total() - given;
        rise = std::max(rise, own - least);
        least = std::min(least, own);
    }
    return rise / kinetic;
}

struct Random {
    explicit Random(unsigned seed) : engine(seed) {}
    double operator()(double low, double high) { return std::uniform_real_distribution<double>(low, high)(engine); }
    Vec3 direction() { return Vec3((*this)(-1.0, 1.0), (*this)(-1.0, 1.0), (*this)(-1.0, 1.0)).normalized(); }
    std::mt19937 engine;
};

inline FabricMaterial stiff(Random& random)
{
    FabricMaterial material = testing::wool();
    material.young = std::pow(10.0, random(7.0, 8.5));
    material.density = 0.3;
    return material;
}

/// An empty scene with steps of 1 to 3 ms, in which stiff fabric moves by more than it can stretch.
inline Scene longSteps(const char* name, Random& random, FabricSolver solver)
{
    Scene scene;
    scene.name = name;
    scene.settings.cell = 0.25;
    scene.settings.time.mode = TimeMode::Fixed;
    scene.settings.time.dt = random(1.0e-3, 3.0e-3);
    scene.settings.fabric.solver = solver;
    return scene;
}

/// Yarns that swing about a pinned end, and a drop that falls into them.
inline Scene yarnsInDrop(unsigned seed, FabricSolver solver)
{
    Random random(seed);
    Scene scene = longSteps("swinging yarns", random, solver);
    scene.settings.coupling.pressureOnFabric = seed % 3 != 0;
    scene.settings.coupling.capillary = false;  // whose work is no loss of anything else
    SourceSettings source;
    source.name = "drop";
    source.shape = Shape::ball(Vec3(0.0, 1.0, 0.0), 0.6);
    Emission emission;
    emission.velocity = {0.0, -30.0, 0.0};
    source.emissions.push_back(emission);
    scene.sources.push_back(source);
    for (int n = 0; n < 2; ++n) {
        Vec3 along = random.direction();
        along.y() *= 0.3;
        const Vec3 middle(0.0, 0.3 - 0.5 * n, 0.0), half = along.normalized();
        FabricPiece yarn = testing::pieceOf(strand(middle - half, middle + half, 8), stiff(random), {0.06, 0.06});
        PinGroup hold;
        hold.vertices = {0, 1};
        yarn.pins.push_back(hold);
        yarn.velocity = 30.0 * random.direction();
        scene.fabrics.push_back(yarn);
    }
    return scene;
}

/// Stiff cloth thrown at a ball, a plate and an edge, each smaller than a cell or thinner.
inline Scene clothAtSolids(unsigned seed, FabricSolver solver)
{
    Random random(seed);
    Scene scene = longSteps("thrown cloth", random, solver);
    ClothGrid grid;
    grid.nodes = Vec2i(9, 7);
    grid.spacing = {0.12, 0.12};
    grid.origin = Vec3(-0.5, 0.5, -0.4);
    FabricPiece cloth = testing::pieceOf(clothGrid(grid), stiff(random), {0.02, 0.02});
    const Eigen::AngleAxisd turn(random(-0.7, 0.7), random.direction());
    for (Vec3& x : cloth.points) x = turn * x + Vec3(0.0, 0.3, 0.0);
    cloth.velocity = {0.0, -random(50.0, 150.0), 0.0};
    scene.fabrics.push_back(cloth);
    const auto add = [&](const char* name, const Shape& shape) {
        ObstacleSettings solid;
        solid.name = name;
        solid.shape = shape;
        scene.obstacles.push_back(solid);
    };
    Eigen::Isometry3d place = Eigen::Isometry3d::Identity();
    place.translate(Vec3(random(-0.3, 0.3), -0.3, random(-0.3, 0.3)));
    place.rotate(Eigen::AngleAxisd(random(-0.5, 0.5), random.direction()));
    add("ball", Shape::ball(Vec3(random(-0.5, 0.5), 0.1, random(-0.4, 0.4)), 0.1));
    add("plate", Shape::box(Vec3::Zero(), Vec3(0.6, 0.02, 0.6)).moved(place));
    return scene;
}

/// Largest sum of the work that solids have been booked to do on fabric, relative to the largest kinetic energy until then [-].
inline double workOfSolids(const Scene& scene, double duration)
{
    Simulation run(scene);
    run.bookEnergy();
    double kinetic = 0.0, sum = 0.0, most = 0.0;
    while (run.state().time < duration) {
        const StepReport report = run.step(duration);
        kinetic = std::max(kinetic, report.energies.fabric.kinetic);
        most = std::max(most, sum += std::as_const(*report.energyChanges)[EnergyChange::Obstacles]);
    }
    return most / kinetic;
}

/// Stiff threads and a cloth that meet at once, without anything else.
inline Scene knockedAbout(unsigned seed, FabricSolver solver)
{
    Random random(seed);
    Scene scene = longSteps("knocked about", random, solver);
    scene.settings.gravity.setZero();
    for (int n = 0; n < 5; ++n) {
        const Vec3 middle = 0.25 * random(0.0, 1.0) * random.direction() + Vec3(0.0, 0.1 * n, 0.0), half = 0.8 * random.direction();
        FabricPiece thread = testing::pieceOf(strand(middle - half, middle + half, 12), stiff(random), {0.03, 0.03});
        thread.velocity = -60.0 * middle + 20.0 * random.direction();
        scene.fabrics.push_back(thread);
    }
    ClothGrid grid;
    grid.nodes = Vec2i(8, 8);
    grid.spacing = {0.15, 0.15};
    grid.origin = Vec3(-0.5, 0.8, -0.5);
    FabricPiece cloth = testing::pieceOf(clothGrid(grid), stiff(random), {0.02, 0.02});
    cloth.velocity = {0.0, -random(30.0, 80.0), 0.0};
    scene.fabrics.push_back(cloth);
    return scene;
}

/// A weave of hard threads that hangs from a corner, and one more thread on it: pressed by nothing but what the threads do to each other.
inline Scene hardWeave(unsigned seed, FabricSolver solver)
{
    Random random(seed);
    Scene scene = longSteps("hard weave", random, solver);
    scene.settings.gravity = random(100.0, 1500.0) * random.direction();
    FabricMaterial hard = testing::wool();
    hard.young = std::pow(10.0, random(8.0, 9.0));
    hard.density = 0.2;
    hard.contactStiffness = 0.1;
    WovenYarns weave;
    weave.yarns = Vec2i(8, 6);
    weave.spacing = 0.19;
    weave.amplitude = 0.04;
    weave.weave = seed % 2 == 0 ? Weave::Twill : Weave::Plain;
    weave.borders = false;
    FabricPiece piece = testing::pieceOf(wovenYarns(weave), hard, {0.028, 0.028});
    PinGroup hold;
    hold.vertices = {0, 1};
    piece.pins.push_back(hold);
    piece.velocity = 20.0 * random.direction();
    FabricPiece thread = testing::pieceOf(strand(Vec3(-0.4, 0.3, 0.2), Vec3(1.5, 0.3, 1.0), 16), hard, {0.02, 0.02});
    thread.velocity = {0.0, -random(20.0, 60.0), 0.0};
    scene.fabrics = {piece, thread};
    return scene;
}

/// Light threads on soft pins, that a lot of thick liquid falls on.
inline Scene liquidOnSoftPins(unsigned seed, FabricSolver solver)
{
    Random random(seed);
    Scene scene = longSteps("liquid on soft pins", random, solver);
    scene.settings.liquid.viscosity = std::pow(10.0, random(0.0, 3.5));
    scene.settings.liquid.solveViscosity = true;
    scene.settings.coupling.capillary = false;
    scene.settings.fabric.contact = false;  // on the grid it holds much of what moves for a step, when threads clash, and gives it back in the next
    SourceSettings source;
    source.name = "drop";
    source.shape = Shape::ball(Vec3(0.0, 0.8, 0.0), 0.5);
    Emission emission;
    emission.velocity = {0.0, -random(10.0, 100.0), 0.0};
    source.emissions.push_back(emission);
    scene.sources.push_back(source);
    FabricMaterial light = testing::wool();
    light.young = std::pow(10.0, random(6.0, 9.0));
    light.density = 0.1;
    light.pinStiffness = std::pow(10.0, random(-2.0, 0.0));
    for (int n = 0; n < 2; ++n) {
        Vec3 half = random.direction();
        half.y() *= 0.3;
        FabricPiece thread =
            testing::pieceOf(strand(Vec3(0.1, 0.2 * n, 0.0) - 0.6 * half, Vec3(0.1, 0.2 * n, 0.0) + 0.6 * half, 4), light, {0.03, 0.02});
        PinGroup hold;
        hold.vertices = {0, 1};
        thread.pins.push_back(hold);
        scene.fabrics.push_back(thread);
    }
    return scene;
}

/// Stiff cloth among solids that move and turn, and a thread that is swung by its end through it.
inline Scene drivenCloth(unsigned seed, FabricSolver solver)
{
    Scene scene = clothAtSolids(seed, solver);
    Random random(seed + 100);
    for (ObstacleSettings& solid : scene.obstacles) {
        solid.motion.addTranslation(0.0, 0.03, random(0.2, 1.0) * random.direction(), 0.0, 0.0);
        solid.motion.addRotation(0.0, 0.03, {random.direction(), Vec3(0.0, -0.1, 0.0)}, random(-1.5, 1.5), 0.0, 0.0);
    }
    FabricPiece thread = testing::pieceOf(strand(Vec3(-0.9, 0.5, 0.1), Vec3(0.7, 0.6, -0.1), 14), stiff(random), {0.03, 0.03});
    PinGroup hold;
    hold.vertices = {0, 1};
    const Vec3 way = random(0.2, 1.5) * random.direction();
    hold.motion.addTranslation(0.0, 0.03, Vec3(-std::abs(way.x()), way.y(), way.z()), 0.0, 0.0);  // and not into the solids
    thread.pins.push_back(hold);
    scene.fabrics.push_back(thread);
    return scene;
}

/// A patchy wet sheet, or weave, of which pins lead some vertices to and fro, with a drop that it drinks; nothing weighs anything.
inline Scene wetOnMovingPins(unsigned seed, FabricSolver solver)
{
    Random random(seed);
    Scene scene = longSteps("wet on moving pins", random, solver);
    scene.settings.gravity.setZero();
    scene.settings.transfer.method = seed % 2 == 0 ? TransferMethod::Flip : TransferMethod::PolyPic;
    for (int n = 0; n < 3; ++n) {
        const Vec3 at(0.0, 0.25 * n, 0.0);
        ClothGrid grid;
        grid.nodes = Vec2i(7, 5);
        grid.spacing = {0.12, 0.12};
        grid.origin = at - Vec3(0.36, 0.0, 0.24);
        FabricPiece piece = n == 1 ? testing::pieceOf(strand(at - 0.5 * Vec3::UnitX(), at + 0.5 * Vec3::UnitX(), 9), testing::wool(), {0.03, 0.03})
                                   : testing::pieceOf(clothGrid(grid), testing::wool(), {0.02, 0.02});
        piece.wetness = 0.4 * n;
        PinGroup hold;
        for (int v = 0; v < static_cast<int>(piece.points.size()); ++v)
            if (random(0.0, 1.0) < 0.4) hold.vertices.push_back(v);
        for (double t = 0.0; t < 0.03; t += 0.01) hold.motion.addTranslation(t, t + 0.01, 0.3 * random.direction(), 0.0, 0.0);
        piece.pins.push_back(hold);
        scene.fabrics.push_back(piece);
    }
    SourceSettings source;
    source.name = "drop";
    source.shape = Shape::ball(Vec3(0.0, 0.1, 0.0), 0.3);
    source.emissions.push_back({});
    scene.sources.push_back(source);
    return scene;
}

}  // namespace sim::test
