#include "sim/core/vector_bits.h"
#include "sim/fabric/pieces/generators.h"
#include "tests/physics/fabric_runs.h"
#include "tests/physics/runs.h"
#include "tests/sim/fabric/pieces.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <map>
#include <set>

// What a short run of each transfer and of each solver of fabric ends with, to the last bit. A change that should change no result changes none of
// these hashes. They depend on how the compiler rounds: golden_states.csv has rows for each build that they were accepted on.

namespace sim::test {
namespace {

/// A sheet that hangs from one corner, and a yarn on it, in the way of the ball.
Scene ballOntoFabric(FabricSolver solver)
{
    Scene scene = ballIntoPool(kPoly8);
    scene.settings.fabric.solver = solver;
    FabricPiece sheet = testing::pieceOf(clothGrid({{9, 9}, {0.5, 0.5}, Vec3(6.8, 3.0, 4.5)}), testing::wool(), {0.0165, 0.018});
    sheet.pins = {pinned({0}, false)};
    FabricPiece yarn = testing::pieceOf(strand(Vec3(5.2, 3.2, 3.4), Vec3(8.3, 3.2, 5.6), 12), testing::wool(), {0.04, 0.03});
    for (FabricPiece* piece : {&sheet, &yarn}) piece->material.volumeFraction = 0.4;
    scene.fabrics = {sheet, yarn};
    return scene;
}

std::string stateAfter(int steps, const Scene& scene)
{
    Simulation simulation(scene);
    for (int step = 0; step < steps; ++step) simulation.step(1.0e9);
    return fmt::format("{:016x}", stateHash(simulation.state()));
}

using States = std::map<std::string, std::string>;  ///< of each run

States statesNow()
{
    constexpr int kSteps = 20;
    States states;
    for (const Transfer& transfer : kTransfers) states[transfer.name] = stateAfter(kSteps, ballIntoPool(transfer));
    states["fabric vertex"] = stateAfter(kSteps, ballOntoFabric(FabricSolver::Vertex));
    states["fabric grid"] = stateAfter(kSteps, ballOntoFabric(FabricSolver::Grid));
    return states;
}

/// The first columns of the rows of this build.
std::string thisBuild() { return fmt::format("{},{},{},{}", kVectorBits, GOLDEN_COMPILER, GOLDEN_PROCESSOR, GOLDEN_BUILD_TYPE); }

constexpr const char* kHead = "vector_bits,compiler,processor,build,run,state";

/// Builds and their states, by the rows `build,run,state` of the file.
std::map<std::string, States> readGoldens()
{
    std::ifstream in(GOLDEN_STATES);
    std::map<std::string, States> goldens;
    std::string line;
    std::getline(in, line);
    while (std::getline(in, line)) {
        const std::size_t state = line.rfind(','), run = line.rfind(',', state - 1);
        goldens[line.substr(0, run)][line.substr(run + 1, state - run - 1)] = line.substr(state + 1);
    }
    return goldens;
}

void writeGoldens(const std::map<std::string, States>& goldens)
{
    std::ofstream out(GOLDEN_STATES);
    out << kHead << '\n';
    for (const auto& [build, states] : goldens)
        for (const auto& [run, state] : states) out << build << ',' << run << ',' << state << '\n';
}

TEST(GoldenStates, AreThoseOfEachTransferAndSolver)
{
    std::map<std::string, States> goldens = readGoldens();
    const std::string build = thisBuild();
    const bool accepts = std::getenv("DRENCH_ACCEPT_GOLDENS") != nullptr;
    if (!accepts && !goldens.contains(build))
        GTEST_SKIP() << "there are no golden states of " << build << "; ./test --accept-goldens -R GoldenStates adds them";
    const States states = statesNow();
    std::set<std::string> different;
    for (const auto& [run, state] : states) different.insert(state);
    EXPECT_EQ(different.size(), states.size()) << "runs that end in the same state do not tell transfers apart";
    if (accepts) {
        goldens[build] = states;
        writeGoldens(goldens);
    }
    for (const auto& [run, state] : states)
        EXPECT_EQ(state, goldens[build][run]) << run << " of " << build
                                              << "; a change that should change results: ./test --accept-goldens -R GoldenStates";
}

TEST(GoldenStates, TellTheLastBitOfOneParticle)
{
    Simulation simulation(ballIntoPool(kApic));
    simulation.step(1.0e9);
    State state = simulation.state();
    const std::uint64_t before = stateHash(state);
    double& x = state.liquid.x[0][state.liquid.count / 2];
    x = std::nextafter(x, 1.0e9);
    EXPECT_NE(stateHash(state), before);
}

}  // namespace
}  // namespace sim::test
