#include "tests/app/runs/toy_runs.h"

namespace app {
namespace {

TEST(RunOffline, LeavesPicturesLogsAndReport)
{
    TemporaryFolder folder;
    runToy({}, folder.path());
    for (int n = 0; n <= 5; ++n) EXPECT_TRUE(std::filesystem::exists(folder / frameFileName(n))) << n;
    EXPECT_FALSE(std::filesystem::exists(folder / frameFileName(6)));
    for (const auto& entry : std::filesystem::directory_iterator(folder.path())) EXPECT_NE(entry.path().extension(), ".part");
    EXPECT_EQ(test::linesOf(folder / "steps.jsonl").size(), 15u) << "0.01 s per frame at 0.004 s: three steps each";
    EXPECT_EQ(test::linesOf(folder / "energy.csv").size(), 1u + 1u + 15u) << "header, initial state, steps";
}

TEST(RunOffline, WritesOnlyTheLogsTheSceneWants)
{
    for (const bool energy : {false, true}) {
        TemporaryFolder folder;
        LoadedScene setup = test::toySetup({});
        setup.pictures.output.energy = energy;
        setup.pictures.output.stats = !energy;
        runOffline(setup, test::toyBackends({}), {.out = folder.path(), .contentHash = "0123", .threads = 2});
        EXPECT_EQ(std::filesystem::exists(folder / "energy.csv"), energy);
        EXPECT_EQ(std::filesystem::exists(folder / "steps.jsonl"), !energy);
        EXPECT_EQ(reportOf(folder.path()).at("steps"), 15);
    }
}

TEST(RunOffline, LedgerOfEnergyTellsWhatIsNotBooked)
{
    TemporaryFolder folder;
    LoadedScene setup = test::toySetup({});
    setup.pictures.output.ledger = true;
    runOffline(setup, test::toyBackends({}), {.out = folder.path(), .contentHash = "0123", .threads = 2});
    EXPECT_EQ(test::linesOf(folder / "energy_ledger.csv").size(), 1u + 1u + 15u) << "header, initial state, steps";
    const json report = reportOf(folder.path()), ledger = report.at("energy_ledger");
    const double time = report.at("simulated_time");
    EXPECT_NEAR(ledger.at("changes").at("gravity").get<double>(), -0.75 * time, 1e-12);
    EXPECT_NEAR(ledger.at("residual").get<double>(), 0.25 * time, 1e-12) << "relative to a kinetic energy of 1";
}

TEST(RunOffline, StepLinesTellTimeStagesEnergyAndLedger)
{
    TemporaryFolder folder;
    runToy({}, folder.path());
    const auto lines = test::linesOf(folder / "steps.jsonl");
    double time = 0.0;
    for (std::size_t n = 0; n < lines.size(); ++n) {
        const json line = json::parse(lines[n]);
        EXPECT_EQ(line.at("step"), n + 1);
        time += line.at("dt").get<double>();
        EXPECT_NEAR(line.at("time").get<double>(), time, 1e-12);
        EXPECT_DOUBLE_EQ(line.at("seconds").at("pressure").get<double>(), 0.001 * static_cast<double>(n + 1));
        EXPECT_FALSE(line.at("seconds").contains("relax")) << "a stage that did not run";
        EXPECT_EQ(line.at("iterations"), n + 1);
        EXPECT_EQ(line.at("particles"), 1);
        EXPECT_NEAR(line.at("energy").at("total").get<double>(), 1.0 - time, 1e-9);
        EXPECT_EQ(line.at("ledger").at("liquid_mass"), 2.0);
        for (const char* key : {"cfl", "max_speed", "residual", "converged", "blocks", "cells"}) EXPECT_TRUE(line.contains(key)) << key;
    }
}

TEST(RunOffline, ForcesAreToldByNameInStepsAndReport)
{
    TemporaryFolder folder;
    runToy({.push = 2.0}, folder.path());
    const auto lines = test::linesOf(folder / "steps.jsonl");
    double time = 0.0, sum = 0.0;
    for (std::size_t n = 1; n <= lines.size(); ++n) {
        const json line = json::parse(lines[n - 1]), forces = line.at("forces");
        const double push = 2.0 * static_cast<double>(n), dt = line.at("dt");
        EXPECT_NEAR(forces.at("obstacles").at("wall").at("liquid").at("force").at(0).get<double>(), push, 1e-12);
        EXPECT_NEAR(forces.at("obstacles").at("wall").at("liquid").at("torque").at(2).get<double>(), -3.0 * push, 1e-12);
        EXPECT_EQ(forces.at("obstacles").at("wall").at("contact").at("force"), json({0.0, 0.0, 0.0}));
        EXPECT_NEAR(forces.at("fabrics").at("sheet").at("contact").at("force").at(0).get<double>(), -push, 1e-12);
        EXPECT_NEAR(forces.at("pins").at("sheet.0").at("force").at(0).get<double>(), push, 1e-12);
        EXPECT_NEAR(forces.at("pins").at("sheet.left").at("force").at(0).get<double>(), 2.0 * push, 1e-12);
        EXPECT_NEAR(line.at("ledger").at("momentum").at("solid_impulse").at(0).get<double>(), dt * push, 1e-12);
        EXPECT_EQ(line.at("ledger").at("momentum").at("support_residual").at(0), 0.5);
        time += dt;
        sum += dt * push;
    }
    const json wall = reportOf(folder.path()).at("forces").at("obstacles").at("wall").at("liquid");
    EXPECT_NEAR(wall.at("mean_force").at(0).get<double>(), sum / time, 1e-12);
    EXPECT_NEAR(wall.at("mean_torque").at(2).get<double>(), -3.0 * sum / time, 1e-12);
    EXPECT_NEAR(wall.at("largest_force").get<double>(), 30.0, 1e-12);
    EXPECT_NEAR(wall.at("largest_torque").get<double>(), 90.0, 1e-12);
}

TEST(RunOffline, WithoutSolidsAndFabricNothingIsSaidOfForces)
{
    TemporaryFolder folder;
    runToy({}, folder.path());
    const json line = json::parse(test::linesOf(folder / "steps.jsonl").at(0));
    EXPECT_FALSE(line.contains("forces"));
    EXPECT_FALSE(line.at("ledger").contains("momentum"));
    EXPECT_FALSE(reportOf(folder.path()).contains("forces"));
}

TEST(RunOffline, EveryStepIsInTheLogBeforeTheNextOne)
{
    TemporaryFolder folder;
    ToySettings toy;
    toy.failAtStep = 4;
    EXPECT_THROW(runToy(toy, folder.path()), sim::RunError);
    EXPECT_EQ(test::linesOf(folder / "steps.jsonl").size(), 3u);
}

TEST(RunOffline, EnergyTableBeginsWithTheInitialState)
{
    TemporaryFolder folder;
    runToy({}, folder.path());
    const auto lines = test::linesOf(folder / "energy.csv");
    EXPECT_EQ(lines[0],
              "time_s,kinetic_erg,modal_erg,potential_erg,total_erg,particles,liquid_mass_g,total_per_particle_erg,"
              "fabric_kinetic_erg,fabric_potential_erg,fabric_elastic_erg,fabric_contact_erg,published_erg");
    EXPECT_EQ(lines[1], "0,1,0,-0,1,1,2,1,0,0,0,0,0");
}

TEST(RunOffline, ReportHasWhatScriptsMeasure)
{
    TemporaryFolder folder;
    runToy({}, folder.path());
    const json report = reportOf(folder.path());
    EXPECT_EQ(report.at("status"), "done");
    EXPECT_EQ(report.at("scene"), "toy");
    EXPECT_EQ(report.at("variant"), "default");
    EXPECT_EQ(report.at("steps"), 15);
    EXPECT_EQ(report.at("frames"), 5);
    EXPECT_NEAR(report.at("simulated_time").get<double>(), 0.05, 1e-12);
    EXPECT_GT(report.at("wall_seconds").get<double>(), 0.0);
    EXPECT_NEAR(report.at("seconds_per_step").at("median").get<double>(), 0.008, 1e-12) << "steps take 1, 2, … 15 ms";
    EXPECT_NEAR(report.at("seconds_per_step").at("stages").at("pressure").get<double>(), 0.008, 1e-12);
    EXPECT_TRUE(report.at("seconds_per_step").at("stages").at("relax").is_null());
    EXPECT_GT(report.at("peak_memory_mb").get<double>(), 1.0);
    EXPECT_EQ(report.at("particles"), 1);
    EXPECT_EQ(report.at("cells"), 7);
    EXPECT_DOUBLE_EQ(report.at("iterations").at("mean").get<double>(), 8.0);
    EXPECT_EQ(report.at("iterations").at("max"), 15);
    EXPECT_EQ(report.at("mass_error"), 0.0);
    EXPECT_EQ(report.at("state_hash").get<std::string>().size(), 16u);
    EXPECT_EQ(report.at("provenance").at("threads"), 2);
    EXPECT_EQ(report.at("provenance").at("version"), DRENCH_VERSION);
    EXPECT_EQ(report.at("content_hash"), "0123");
}

TEST(RunOffline, PicturesDoNotChangeTheResult)
{
    TemporaryFolder with, without;
    const auto drawn = runToy({}, with.path());
    const auto undrawn = runOffline(test::toySetup({}), test::toyBackends({}), {.out = without.path(), .contentHash = "", .frames = false});
    EXPECT_EQ(drawn.stateHash, undrawn.stateHash);
    EXPECT_EQ(drawn.steps, undrawn.steps);
    EXPECT_FALSE(std::filesystem::exists(without / frameFileName(0)));
}

TEST(RunOffline, TheRestOfTheDurationIsSimulatedToo)
{
    TemporaryFolder folder;
    ToySettings toy;
    toy.duration = 0.055;
    const auto summary = runToy(toy, folder.path());
    EXPECT_NEAR(summary.simulatedTime, 0.055, 1e-12);
    EXPECT_EQ(summary.frames, 5);
}

TEST(RunOffline, InterruptFinishesTheFrameInHandAndLeavesAValidFolder)
{
    TemporaryFolder folder;
    int looked = 0;
    const auto summary = runToy({}, folder.path(), [&] { return ++looked == 2; });
    EXPECT_EQ(summary.status, RunStatus::Interrupted);
    const json report = reportOf(folder.path());
    EXPECT_EQ(report.at("status"), "interrupted");
    EXPECT_EQ(report.at("frames"), 2);
    EXPECT_NEAR(report.at("simulated_time").get<double>(), 0.02, 1e-12);
    EXPECT_TRUE(std::filesystem::exists(folder / frameFileName(2)));
    EXPECT_FALSE(std::filesystem::exists(folder / frameFileName(3)));
    EXPECT_EQ(test::linesOf(folder / "steps.jsonl").size(), 6u);
}

TEST(RunOffline, AFailingSimulationLeavesItsReasonAndItsFrames)
{
    TemporaryFolder folder;
    ToySettings toy;
    toy.failAtStep = 8;
    EXPECT_THROW(runToy(toy, folder.path()), sim::RunError);
    const json report = reportOf(folder.path());
    EXPECT_EQ(report.at("status"), "failed");
    EXPECT_EQ(report.at("reason"), "toy.yaml: step 3, pressure: the toy fell over");
    EXPECT_EQ(report.at("steps"), 7);
    EXPECT_TRUE(std::filesystem::exists(folder / frameFileName(2)));
}

TEST(RunOffline, AFailingRendererStopsTheRunWithItsReason)
{
    TemporaryFolder folder;
    ToySettings toy;
    toy.failAtDrawing = 2;
    toy.duration = 10.0;
    EXPECT_THROW(runToy(toy, folder.path()), std::runtime_error);
    const json report = reportOf(folder.path());
    EXPECT_EQ(report.at("reason"), "the toy has no more colours");
    EXPECT_LT(report.at("frames"), 20) << "it should have stopped long before the thousandth frame";
}

TEST(RunOffline, AFullDiskStopsTheRunWithItsReason)
{
    TemporaryFolder folder;
    ToySettings toy;
    toy.failAtWriting = 1;
    toy.duration = 10.0;
    EXPECT_THROW(runToy(toy, folder.path()), std::runtime_error);
    EXPECT_NE(reportOf(folder.path()).at("reason").get<std::string>().find("No space left"), std::string::npos);
}

TEST(RunOffline, AShorterRunLeavesNoFramesOfALongerOne)
{
    TemporaryFolder folder;
    runToy({}, folder.path());
    test::writeFile(folder / "notes.txt", "mine");
    ToySettings shorter;
    shorter.duration = 0.02;
    runToy(shorter, folder.path());
    EXPECT_TRUE(std::filesystem::exists(folder / frameFileName(2)));
    EXPECT_FALSE(std::filesystem::exists(folder / frameFileName(3)));
    EXPECT_EQ(test::contentOf(folder / "notes.txt"), "mine") << "what is not ours stays";
}

TEST(RunOffline, ASceneThatCannotBeginLeavesEarlierResultsAlone)
{
    TemporaryFolder folder;
    runToy({}, folder.path());
    auto backends = test::toyBackends({});
    backends.startSimulation = [](const LoadedScene&) -> std::unique_ptr<SimulationHandle> { throw sim::InputError("no room for a particle"); };
    EXPECT_THROW(runOffline(test::toySetup({}), backends, {.out = folder.path(), .contentHash = ""}), sim::InputError);
    EXPECT_EQ(reportOf(folder.path()).at("status"), "done");
    EXPECT_TRUE(std::filesystem::exists(folder / frameFileName(5)));
}

}  // namespace
}  // namespace app
