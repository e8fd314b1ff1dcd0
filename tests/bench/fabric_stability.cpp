// Runs a scene of fabric and looks at what must not happen, with a checker that shares nothing with the solver:
//   fabric_stability SCENE.yaml seconds dt young_factor [key=value ...]
// One line of a table comes out; its head with no argument. tests/bench/stability makes the whole table.

#include "sim/scene/load_scene.h"
#include "sim/simulation.h"
#include "tests/physics/crossings.h"

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <limits>
#include <optional>
#include <string>
#include <vector>

namespace {

using namespace sim;

constexpr double kBetweenLooks = 1.0e-2;  // s

struct Seen {
    std::size_t steps = 0;
    bool isFinite = true;
    int flipped = 0, undecided = 0, pierced = 0, halvings = 0, shortened = 0;
    double leastShare = 1.0, spare = std::numeric_limits<double>::infinity();
    std::vector<double> milliseconds;
};

bool isFinite(const FabricState& state)
{
    return std::ranges::all_of(state.x, [](const Vec3& x) { return x.allFinite(); }) &&
           std::ranges::all_of(state.v, [](const Vec3& v) { return v.allFinite(); });
}

void advance(Simulation& simulation, double until, Seen& seen)
{
    while (simulation.state().time < until * (1.0 - 1.0e-12)) {
        const auto begin = std::chrono::steady_clock::now();
        const StepReport report = simulation.step(until);
        const std::chrono::duration<double, std::milli> took = std::chrono::steady_clock::now() - begin;
        seen.milliseconds.push_back(took.count());
        ++seen.steps;
        seen.halvings += report.fabric.halvings;
        seen.shortened += report.fabric.shortened;
        seen.leastShare = std::min(seen.leastShare, report.fabric.takenFraction);
    }
}

void look(const std::optional<test::Crossings>& crossings, const Simulation& simulation, Seen& seen)
{
    const std::vector<Vec3>& x = simulation.state().fabric.x;
    seen.isFinite = seen.isFinite && isFinite(simulation.state().fabric);
    if (!seen.isFinite) return;
    if (crossings) {
        const auto [flipped, undecided] = crossings->count(x);
        seen.flipped = std::max(seen.flipped, flipped);
        seen.undecided = std::max(seen.undecided, undecided);
        seen.spare = std::min(seen.spare, crossings->nearness(x).spare);
    }
    if (simulation.fabric().faces.size() > 0)
        seen.pierced = std::max(seen.pierced, test::piercedFaces(simulation.fabric(), x));
}

void print(const Scene& scene, double dt, double factor, double time, Seen seen)
{
    std::ranges::sort(seen.milliseconds);
    const bool isVertex = scene.settings.fabric.solver == FabricSolver::Vertex;
    std::printf("%s,%s,%g,%g,%g,%zu,%s,%d,%d,%d,%.3g,%.3f,%d,%d,%.1f,%.1f\n", scene.name.c_str(),
                isVertex ? "vertex" : "grid", dt, factor, time, seen.steps, seen.isFinite ? "yes" : "no", seen.flipped,
                seen.undecided, seen.pierced, seen.spare, seen.leastShare, seen.halvings, seen.shortened,
                seen.milliseconds[seen.milliseconds.size() / 2], seen.milliseconds.back());
}

}  // namespace

int main(int argc, char** argv)
{
    if (argc < 5) {
        std::puts("scene,solver,dt_s,young_factor,simulated_s,steps,finite,flipped,undecided,pierced,spare_cm,"
                  "least_share_taken,halvings,shortened,median_ms,max_ms");
        return argc == 1 ? 0 : 2;
    }
    const double duration = std::atof(argv[2]), dt = std::atof(argv[3]), factor = std::atof(argv[4]);
    try {
        LoadOptions options;
        options.set.assign(argv + 5, argv + argc);
        options.set.push_back("time.dt=" + std::string(argv[3]));
        Scene scene = loadScene(argv[1], options);
        for (FabricPiece& piece : scene.fabrics) piece.material.young *= factor;
        Simulation simulation(scene);
        std::optional<test::Crossings> crossings;
        if (simulation.fabric().strands.count() > 0) crossings.emplace(simulation.fabric(), Vec3::UnitY());
        Seen seen;
        for (int frame = 1; frame * kBetweenLooks < duration * (1.0 + 1.0e-9) && seen.isFinite; ++frame) {
            advance(simulation, frame * kBetweenLooks, seen);
            look(crossings, simulation, seen);
        }
        print(scene, dt, factor, simulation.state().time, seen);
    } catch (const std::exception& error) {
        std::fprintf(stderr, "%s: %s\n", argv[1], error.what());
        return 1;
    }
    return 0;
}
