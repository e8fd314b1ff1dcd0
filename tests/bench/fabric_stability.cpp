// Runs a scene of fabric and looks at what must not happen, with a checker that shares nothing with the solver:
//   fabric_stability SCENE.yaml seconds dt young_factor [key=value ...]
// One line of a table comes out; its head with no argument. tests/bench/stability makes the whole table.

#include "sim/scene/load_scene.h"
#include "tests/physics/watched_run.h"

#include <cstdio>
#include <cstdlib>
#include <string>

namespace {

using namespace sim;

constexpr double kBetweenLooks = 2.0e-2;  // s; a whole number of steps of every length in the table

void print(const Scene& scene, double dt, double factor, double time, test::WatchedRun::Seen seen)
{
    std::ranges::sort(seen.milliseconds);
    const bool isVertex = scene.settings.fabric.solver == FabricSolver::Vertex;
    std::printf("%s,%s,%g,%g,%g,%zu,%s,%d,%d,%d,%.3g,%.3f,%d,%d,%.1f,%.1f\n", scene.name.c_str(), isVertex ? "vertex" : "grid", dt, factor, time,
                seen.milliseconds.size(), seen.isFinite ? "yes" : "no", seen.flipped, seen.undecided, seen.pierced, seen.spare,
                seen.leastAcceptedFraction, seen.substepSplits, seen.truncatedSubsteps, seen.milliseconds[seen.milliseconds.size() / 2],
                seen.milliseconds.back());
}

}  // namespace

int main(int argc, char** argv)
{
    if (argc < 5) {
        std::puts(
            "scene,solver,dt_s,young_factor,simulated_s,steps,finite,flipped,undecided,pierced,spare_cm,"
            "least_accepted_fraction,substep_splits,truncated_substeps,median_ms,max_ms");
        return argc == 1 ? 0 : 2;
    }
    const double duration = std::atof(argv[2]), dt = std::atof(argv[3]), factor = std::atof(argv[4]);
    try {
        LoadOptions options;
        options.set.assign(argv + 5, argv + argc);
        options.set.push_back("time.dt=" + std::string(argv[3]));
        Scene scene = loadScene(argv[1], options);
        for (FabricPiece& piece : scene.fabrics) piece.material.young *= factor;
        test::WatchedRun run(scene);
        const test::WatchedRun::Seen& seen = run.run(duration, kBetweenLooks);
        print(scene, dt, factor, run.simulation().state().time, seen);
    } catch (const std::exception& error) {
        std::fprintf(stderr, "%s: %s\n", argv[1], error.what());
        return 1;
    }
    return 0;
}
