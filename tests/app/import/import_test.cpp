#include "tests/app/import/imported.h"

#include "sim/core/units.h"

#include <gmock/gmock.h>

namespace app {
namespace {

using sim::Vec3;
using test::countFabric;
using test::FabricCounts;
using test::Imported;
using test::ownScene;
using ::testing::HasSubstr;
using ::testing::Not;

constexpr double kDegree = sim::kPi / 180.0;

TEST(Import, SheetBecomesAGridOfTheSameTriangles)
{
    const Imported sheet(ownScene("sheet"));
    const sim::Scene scene = sheet.scene();
    EXPECT_EQ(countFabric(scene), (FabricCounts{.vertices = 20, .faces = 24, .held = 8, .pieces = 1}));
    const sim::FabricPiece& cloth = scene.fabrics[0];
    EXPECT_EQ(cloth.kind, "cloth_grid");
    EXPECT_EQ(cloth.velocity, Vec3(0.0, 0.0, -2.0));
    for (const int v : cloth.pins[0].vertices) EXPECT_GE(cloth.points[v][1], 1.25 - 1.0e-12) << "the two upper columns are held";
    // The file's first face goes from (y 0.5, z 0) up and then along z: its normal is +x.
    for (const sim::Vec3i& f : cloth.faces)
        EXPECT_GT((cloth.points[f[1]] - cloth.points[f[0]]).cross(cloth.points[f[2]] - cloth.points[f[0]])[0], 0.0) << "faces keep their side";
    EXPECT_THAT(sheet.yaml(), HasSubstr("pin: {edge: y+, patch: 2}"));
}

TEST(Import, SettingsArriveInTheirUnits)
{
    const sim::Scene scene = Imported(ownScene("sheet")).scene();
    const sim::Settings& s = scene.settings;
    EXPECT_EQ(s.time.dt, 1.0e-3);
    EXPECT_EQ(s.time.integrator, sim::TimeIntegrator::Plain);
    EXPECT_EQ(s.cell, 0.25);
    EXPECT_EQ(s.gravity, Vec3(10.0, -981.0, 0.0)) << "all pulls together";
    EXPECT_EQ(s.transfer.method, sim::TransferMethod::Apic) << "apic of 2018";
    EXPECT_EQ(s.transfer.affineDamping, 0.1);
    EXPECT_EQ(s.transfer.dampingDt, 1.0e-3);
    EXPECT_EQ(s.fabricTransfer.stretchDamping, 0.5);
    EXPECT_EQ(s.fabricTransfer.rotationDamping, 0.2);
    EXPECT_EQ(s.fabricTransfer.velocityDamping, 0.3);
    EXPECT_NEAR(s.liquid.contactAngle, 90.0 * kDegree, 1.0e-12);
    EXPECT_EQ(s.liquid.density, 0.92);
    EXPECT_EQ(s.liquid.wallFriction, 0.5);
    EXPECT_EQ(s.liquid.particleSpacing, 0.3);
    EXPECT_NEAR(s.liquid.relax.rate, 0.1 / (4.0 * 1.0e-3), 1.0e-12);
    EXPECT_EQ(s.liquid.relax.range, 1.5);
    EXPECT_TRUE(s.liquid.solveViscosity && s.liquid.surfaceTensionForce);
    EXPECT_EQ(s.liquid.viscositySubsteps, 3);
    EXPECT_EQ(s.liquid.curvatureSmoothing, 5);
    EXPECT_NEAR(s.porous.volumeFraction, 0.5, 1.0e-12) << "of fibres of 0.01 cm with pores of 0.005 cm";
    EXPECT_EQ(s.coupling.drag, sim::DragLaw::Linear);
    EXPECT_EQ(s.coupling.dragExponent, 1.2);
    EXPECT_EQ(s.coupling.capture.law, sim::CaptureLaw::Published);
    EXPECT_EQ(s.coupling.capture.publishedRateFactor, 6.0);
    EXPECT_EQ(s.coupling.dragFraction, sim::DragFraction::Cell);
    EXPECT_FALSE(s.coupling.pressureOnFabric || s.coupling.wicking.pressure);
    EXPECT_EQ(s.fabric.solver, sim::FabricSolver::Grid);
    EXPECT_EQ(s.fabric.hingeMeasure, sim::HingeMeasure::Tan);
    EXPECT_FALSE(s.fabric.twist);
    EXPECT_EQ(s.solver.maxIterations, 300);
}

TEST(Import, MaterialsOf2018AreRead)
{
    const sim::Scene scene = Imported(ownScene("sheet")).scene();
    const sim::FabricPiece& cloth = scene.fabrics.at(0);
    EXPECT_EQ(cloth.material.young, 2.0e6);
    EXPECT_EQ(cloth.material.density, 1.4);
    EXPECT_EQ(cloth.material.dampingViscosity, 12.0);
    EXPECT_TRUE(cloth.material.dampBending);
    EXPECT_FALSE(cloth.material.dampStretching) << "without accumulateViscousOnlyForBendingModes=0 bending alone is damped";
    EXPECT_EQ(cloth.material.contactStiffness, 0.05);
    EXPECT_EQ(cloth.material.pinStiffness, 0.07);
    EXPECT_EQ(cloth.material.frictionAngle, 0.0) << "friction_angle is not read";
    EXPECT_EQ(cloth.radius, (std::array{0.03, 0.018})) << "biradius does not follow radius";
    // 20 particles with 4e-4 cm^3 each, in 0.75 cm^2 of cloth 0.048 cm thick with half of it pores.
    EXPECT_NEAR(cloth.wetness, 20.0 * 4.0e-4 / (0.75 * 0.048 * 0.5), 1.0e-12);
}

TEST(Import, OptionsDecideOtherwise)
{
    const sim::Scene scene =
        Imported(ownScene("sheet"), {.strictFork = true, .trustFrictionAngle = true, .roundSections = true, .vertexSolver = true}).scene();
    EXPECT_EQ(scene.settings.transfer.method, sim::TransferMethod::Pic);
    EXPECT_EQ(scene.settings.fabric.solver, sim::FabricSolver::Vertex);
    EXPECT_NEAR(scene.fabrics.at(0).material.frictionAngle, 20.0 * kDegree, 1.0e-12);
    EXPECT_EQ(scene.fabrics.at(0).radius, (std::array{0.03, 0.03}));
    EXPECT_EQ(scene.settings.coupling.cohesion.strength, 0.002) << "the default of the file's cohesionCoeff";
    EXPECT_TRUE(scene.settings.coupling.cohesion.fabric && scene.settings.coupling.cohesion.obstacle);
}

TEST(Import, LiquidObstacleAndDomainOfTheSheet)
{
    const sim::Scene scene = Imported(ownScene("sheet")).scene();
    ASSERT_EQ(scene.sources.size(), 1u);
    EXPECT_EQ(scene.sources[0].emissions.at(0).velocity, Vec3(150.0, 0.0, 0.0));
    EXPECT_EQ(scene.sources[0].fill.pattern, sim::FillSettings::Pattern::Reference);
    EXPECT_NEAR(scene.sources[0].shape.distance({-1.0, 1.9, 0.4}), 0.5, 1.0e-9);
    EXPECT_NEAR(scene.obstacles.at(0).shape.distance({1.5, 0.0, 0.4}), -0.5, 1.0e-9);
    ASSERT_TRUE(scene.domain);
    EXPECT_NEAR(scene.domain->distance({7.5, 0.0, 0.0}), 1.0, 1.0e-9) << "core 6 and rounding 0.5";
}

TEST(Import, WeaveIsRecognisedWhereverItLies)
{
    const Imported weave(ownScene("weave"));
    const sim::Scene scene = weave.scene();
    EXPECT_EQ(countFabric(scene), (FabricCounts{.vertices = 62, .edges = 71, .held = 4, .pieces = 1}));
    EXPECT_EQ(scene.fabrics[0].kind, "woven_yarns");
    EXPECT_THAT(weave.yaml(), HasSubstr("weave: twill"));
    EXPECT_THAT(weave.yaml(), HasSubstr("v: [0, 0.6, 0.8]"));
    EXPECT_THAT(weave.yaml(), HasSubstr("pin: {corners: all}"));
    EXPECT_EQ(scene.settings.transfer.method, sim::TransferMethod::PolyPic);
    EXPECT_EQ(scene.settings.transfer.modes, 8);
    EXPECT_EQ(scene.settings.fabricTransfer.modes, 8);
    EXPECT_THAT(weave.report, HasSubstr("scalarModes=11"));
    EXPECT_EQ(scene.fabrics[0].material.volumeFraction, 0.5);
    EXPECT_NEAR(scene.fabrics[0].material.frictionAngle, 89.0 * kDegree, 1.0e-12);
    EXPECT_FALSE(scene.obstacles.at(0).collide) << "useLevelSetForce=0";
    const Vec3 corner = Vec3(2.0, -2.0, 0.0) + Eigen::AngleAxisd(30.0 * kDegree, Vec3::UnitZ()) * Vec3(3.0, 0.5, 3.0);
    EXPECT_NEAR(scene.obstacles[0].shape.distance(corner), 0.0, 1.0e-9) << "rw is in radians";
    EXPECT_THAT(weave.report, HasSubstr("the material of line 8 is of no fabric"));
}

TEST(Import, SourcesOfAGroupAreOneAndSpansAreKept)
{
    const sim::Scene scene = Imported(ownScene("bodies")).scene();
    ASSERT_EQ(scene.sources.size(), 2u) << "one of a ball and a box, one jet; sampled=0 gives nothing";
    EXPECT_LT(scene.sources[0].shape.distance({-0.4, 3.0, 0.0}), 0.0);
    EXPECT_LT(scene.sources[0].shape.distance({0.8, 3.3, 0.3}), 0.0);
    const auto& spans = scene.sources[1].emissions;
    ASSERT_EQ(spans.size(), 2u);
    EXPECT_EQ(spans[0].from, 0.1);
    EXPECT_EQ(spans[0].maxVolume, 2.5);
    EXPECT_EQ(spans[1].velocity, Vec3(5.0, 0.0, 0.0));
    EXPECT_NEAR(scene.sources[1].shape.distance({-2.0, 3.8, 0.0}), 0.0, 1.0e-9) << "the capsule was turned from x to y";
}

TEST(Import, ObstaclesAreSolidWhereTheFileSays)
{
    const sim::Scene scene = Imported(ownScene("bodies")).scene();
    ASSERT_EQ(scene.obstacles.size(), 3u);
    const sim::Shape& tank = scene.obstacles[0].shape;
    EXPECT_GT(tank.distance({0.0, 2.0, 0.0}), 0.0) << "its room";
    EXPECT_LT(tank.distance({3.9, -1.5, 3.5}), 0.0) << "the ball in its corner";
    EXPECT_LT(tank.distance({0.0, 8.0, 0.0}), 0.0) << "outside";
    EXPECT_NEAR(scene.obstacles[1].shape.distance({2.0, 0.0, 0.95}), 0.1, 1.0e-9)
        << "the cylinder was turned from y to z; half length and corner add up";
    EXPECT_NEAR(scene.obstacles[2].shape.distance({-1.3, 0.0, 1.0}), 0.2, 0.02) << "the cube of the file, half as large";
    ASSERT_TRUE(scene.domain);
    EXPECT_GT(scene.domain->distance({0.0, -1.5, 0.0}), 0.0) << "a terminator without inside deletes within";
    EXPECT_LT(scene.domain->distance({5.0, 5.0, 5.0}), 0.0);
}

TEST(Import, ScriptsBecomeMotions)
{
    const sim::Scene scene = Imported(ownScene("bodies")).scene();
    const sim::Motion &lifted = scene.obstacles.at(1).motion, &turned = scene.obstacles.at(2).motion;
    EXPECT_NEAR((lifted.transform(0.9) * Vec3(2.0, 0.0, 0.5) - Vec3(3.0, 1.0, 0.5)).norm(), 0.0, 1.0e-9);
    EXPECT_NEAR((lifted.transform(2.0) * Vec3(2.0, 0.0, 0.5) - Vec3(3.5, 1.0, 0.0)).norm(), 0.0, 1.0e-9)
        << "without an origin it turns about itself, where it is by then";
    EXPECT_NEAR((turned.transform(1.0) * Vec3(-2.0, 0.0, 1.0) - Vec3(2.0, 0.0, 1.0)).norm(), 0.0, 1.0e-9) << "half a turn about the scene's origin";
    EXPECT_NEAR((turned.transform(1.125) * Vec3(-2.0, 0.0, 1.0) - Vec3(2.3, 0.0, 1.0)).norm(), 0.0, 1.0e-9) << "then it swings";
}

TEST(Import, WhatNoGeneratorMakesGoesToFiles)
{
    const Imported odd(ownScene("odd"));
    EXPECT_EQ(countFabric(odd.scene()), (FabricCounts{.vertices = 55, .edges = 35, .faces = 3, .held = 1, .pieces = 4}));
    const sim::Scene scene = odd.scene();
    EXPECT_EQ(scene.fabrics.at(3).points.at(0), Vec3(0.0, -3.0123456789012, 0.0)) << "to the last digit";
    EXPECT_EQ(scene.fabrics.at(3).radius, (std::array{0.011, 0.012})) << "of its particles, not of the material";
    for (const char* file : {"odd_cloth0.obj", "odd_yarns2.obj", "odd_yarns3.obj"}) EXPECT_TRUE(std::filesystem::exists(odd.folder() / file)) << file;
    EXPECT_THAT(odd.report, HasSubstr("no vertex is further from its particle than"));
}

TEST(Import, ImportedScenesRun)
{
    for (const char* name : {"sheet", "weave", "bodies", "odd"}) {
        const Imported imported(ownScene(name));
        const LoadedScene setup = imported.setup();
        const auto simulation = imported.start(setup);
        const double end = 5.0 * setup.scene.settings.time.dt;
        while (simulation->state().time < end * (1.0 - 1.0e-9)) simulation->step(end);
        EXPECT_NEAR(simulation->state().time, end, 1.0e-9) << name;
    }
}

TEST(Import, ReportNamesWhatIsNotInTheScene)
{
    const Imported odd(ownScene("odd"));
    for (const char* words :
         {"1 vertices join cloth and yarns", "radii of their own", "velocities of their own", "fixed=2", "(m, vol) of 1 particles", "theta, omega",
          "springforce, the first in line 85", "the pose of line 86", "1 particles belong to no cloth and no yarn and have no mass",
          "1 particles with a mass belong", "1 particles of liquid are listed", "liquidinfo/misspelt", "scene/unheardof"})
        EXPECT_THAT(odd.report, HasSubstr(words));
    EXPECT_EQ(odd.report, test::contentOf(odd.folder() / "odd.import.txt"));
    const Imported sheet(ownScene("sheet"));
    for (const char* words :
         {"apic=1", "biradius is not given", "friction_angle=20", "2 particles belong to no cloth", "drag by air", "cohesion of wet fabric",
          "liquidinfo/halfThickness", "StrandParameters/haircolor", "not from levelsetYoungModulus", "scene/collision", "bucketinfo@kernelorder"})
        EXPECT_THAT(sheet.report, HasSubstr(words));
    EXPECT_THAT(sheet.report, Not(HasSubstr("misspelt")));
}

TEST(Import, ThreadsPerAreaGiveTheFractionOf2018)
{
    test::TemporaryFolder folder;
    std::string text = test::contentOf(ownScene("sheet"));
    text.replace(text.find("<multiLevel"), 0, "<fabricThreadCount value=\"80\"/>");
    test::writeFile(folder / "threads.xml", text);
    EXPECT_NEAR(Imported(folder / "threads.xml").scene().settings.porous.volumeFraction, sim::kPi * 1.0e-4 * 80.0 / (8.0 * 0.02), 1.0e-12);
    EXPECT_NEAR(Imported(folder / "threads.xml", {.legacyThreadCount = false}).scene().settings.porous.volumeFraction, 0.5, 1.0e-12);
}

}  // namespace
}  // namespace app
