#include "sim/fabric/pieces/generators.h"
#include "sim/simulation.h"
#include "tests/physics/fabric_runs.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

// Similar scenes have similar results. Units of time and length that are powers of two change no bit of a number's mantissa: where no law, no
// tolerance and no threshold has a time or a length of its own, the results are the same bits.

namespace sim::test {
namespace {

/// Units of a scene in those of another.
struct Units {
    double time = 1.0, length = 1.0;

    double speed() const { return length / time; }
    double acceleration() const { return speed() / time; }
    double pressure() const { return speed() * speed(); }  ///< densities stay
    double viscosity() const { return pressure() * time; }
    double tension() const { return pressure() * length; }
};

/// A sheet and a yarn across it fall on a ball; one corner of the sheet is held by a pin that moves. Without gravity they are thrown at it.
Scene fabricScene(const Units& unit, FabricSolver solver, bool hasGravity)
{
    const double L = unit.length;
    Scene scene;
    scene.name = "similar fabric";
    scene.settings.cell = 0.25 * L;
    scene.settings.fabric.solver = solver;
    scene.settings.time.mode = TimeMode::Fixed;
    scene.settings.time.dt = 1.0e-3 * unit.time;
    scene.settings.gravity = hasGravity ? Vec3(0.0, -kEarthGravity * unit.acceleration(), 0.0) : Vec3::Zero().eval();
    const FabricGeometry square = clothGrid({{9, 9}, {0.25 * L, 0.25 * L}, Vec3(-1.0 * L, 0.1 * L, -1.0 * L)});
    FabricPiece sheet = testing::pieceOf(square, testing::wool(), {0.03 * L, 0.03 * L});
    FabricPiece yarn = testing::pieceOf(strand(Vec3(-0.8, 0.2, -0.7) * L, Vec3(0.9, 0.25, 0.6) * L, 12), testing::wool(), {0.04 * L, 0.03 * L});
    sheet.pins = {pinned({0}, false, [&] {
        Motion motion;
        motion.addTranslation(0.0, 0.05 * unit.time, Vec3(0.1, 0.3, -0.2) * L, 0.0, 0.0);
        return motion;
    }())};
    for (FabricPiece* piece : {&sheet, &yarn}) {
        piece->material.young *= unit.pressure();
        piece->material.dampingViscosity = 100.0 * unit.viscosity();
        piece->velocity = Vec3(2.0, -60.0, 1.0) * unit.speed();
    }
    scene.fabrics = {sheet, yarn};
    ObstacleSettings ball;
    ball.name = "ball";
    ball.shape = Shape::ball(Vec3(0.1, -0.75, 0.05) * L, 0.7 * L);
    scene.obstacles.push_back(ball);
    return scene;
}

/// The same with a drop that meets the sheet and the ball's floor; without fabric where its solver is off.
Scene splashScene(const Units& unit, FabricSolver solver)
{
    const double L = unit.length;
    Scene scene = fabricScene(unit, solver, true);
    if (solver == FabricSolver::Off) scene.fabrics.clear();
    LiquidSettings& liquid = scene.settings.liquid;
    liquid.viscosity *= unit.viscosity();
    liquid.solveViscosity = true;
    liquid.surfaceTension *= unit.tension();
    liquid.surfaceTensionForce = true;
    liquid.volume.rate /= unit.time;
    scene.settings.coupling.capture.rate /= unit.time;
    scene.settings.transfer.dampingDt *= unit.time;
    scene.settings.porous.fibreDiameter *= L;
    SourceSettings drop;
    drop.name = "drop";
    drop.shape = Shape::ball(Vec3(0.1, 0.9, 0.0) * L, 0.6 * L);
    Emission emission;
    emission.velocity = Vec3(0.0, -60.0, 10.0) * unit.speed();
    drop.emissions.push_back(emission);
    scene.sources.push_back(drop);
    return scene;
}

std::string nameOf(FabricSolver solver) { return solver == FabricSolver::Grid ? "grid" : solver == FabricSolver::Vertex ? "vertex" : "no fabric"; }

/// Of vertices and particles, in units of the scene [cm].
std::vector<Vec3> placesAfter(int steps, const Scene& scene, const Units& unit)
{
    Simulation simulation(scene);
    for (int i = 0; i < steps; ++i) simulation.step(1.0e9 * unit.time);
    std::vector<Vec3> x = simulation.state().fabric.x;
    for (std::size_t p = 0; p < simulation.state().liquid.count; ++p) x.push_back(simulation.state().liquid.position(p));
    for (Vec3& place : x) place /= unit.length;
    return x;
}

TEST(Similarity, OfFabricIsExact)
{
    for (FabricSolver solver : {FabricSolver::Vertex, FabricSolver::Grid})
        for (bool hasGravity : {true, false}) {
            const std::vector<Vec3> here = placesAfter(60, fabricScene({}, solver, hasGravity), {});
            for (const Units& unit : {Units{128.0, 1.0}, Units{1.0 / 64.0, 1.0}, Units{1.0, 64.0}, Units{32.0, 1.0 / 256.0}})
                EXPECT_EQ(placesAfter(60, fabricScene(unit, solver, hasGravity), unit), here)
                    << nameOf(solver) << (hasGravity ? "" : " without gravity") << ", units " << unit.time << " s, " << unit.length << " cm";
        }
}

TEST(Similarity, OfLiquidAndFabricIsExact)
{
    for (FabricSolver solver : {FabricSolver::Off, FabricSolver::Vertex, FabricSolver::Grid}) {
        const std::vector<Vec3> here = placesAfter(15, splashScene({}, solver), {});
        for (const Units& unit : {Units{128.0, 1.0}, Units{1.0 / 64.0, 1.0}, Units{1.0, 64.0}, Units{32.0, 1.0 / 256.0}})
            EXPECT_EQ(placesAfter(15, splashScene(unit, solver), unit), here)
                << nameOf(solver) << ", units " << unit.time << " s, " << unit.length << " cm";
    }
}

}  // namespace
}  // namespace sim::test
