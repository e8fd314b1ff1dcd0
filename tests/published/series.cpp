// Runs a scene and prints what the series of the published code hold, one line per step:
//   published_series SCENE.yaml VARIANT seconds [key=value ...]      (VARIANT - is none)

#include "sim/core/parallel.h"
#include "sim/scene/load_scene.h"
#include "sim/simulation.h"

#include <fmt/format.h>

#include <cstdio>
#include <cstdlib>
#include <exception>
#include <string>

namespace {

using namespace sim;

Vec3 centreOf(std::size_t n, auto&& mass, auto&& place)
{
    Vec3 moment = Vec3::Zero();
    const double all = parallelSum(n, mass);
    for (int a = 0; a < kAxes; ++a) moment[a] = parallelSum(n, [&](std::size_t i) { return mass(i) * place(i)[a]; });
    return all > 0.0 ? Vec3(moment / all) : moment;
}

void print(const Simulation& simulation, double density)
{
    const State& state = simulation.state();
    const LiquidParticles& liquid = state.liquid;
    const Fabric& fabric = simulation.fabric();
    const auto particleMass = [&](std::size_t p) { return liquid.mass[p]; };
    const auto fibreMass = [&](std::size_t v) { return fabric.mass[v]; };
    const Vec3 f = centreOf(liquid.count, particleMass, [&](std::size_t p) { return liquid.position(p); });
    const Vec3 s = centreOf(fabric.vertexCount(), fibreMass, [&](std::size_t v) { return state.fabric.x[v]; });
    const double absorbed = parallelSum(state.fabric.absorbed.size(), [&](std::size_t v) { return state.fabric.absorbed[v]; });
    fmt::print("{:.9g},{},{:.9g},{:.9g},{:.9g},{:.9g},{:.9g},{:.9g},{:.9g},{:.9g}\n", state.time, liquid.count,
               parallelSum(liquid.count, particleMass) / density, absorbed / density, f.x(), f.y(), f.z(), s.x(), s.y(), s.z());
}

}  // namespace

int main(int argc, char** argv)
{
    if (argc < 4) {
        std::fputs("usage: published_series SCENE.yaml VARIANT seconds [key=value ...]\n", stderr);
        return 2;
    }
    try {
        const std::string variant = argv[2];
        const Scene scene = loadScene(argv[1], {.variant = variant == "-" ? "" : variant, .set = {argv + 4, argv + argc}});
        Simulation simulation(scene);
        std::puts("time_s,n_fluid,vol_fluid_cm3,vol_absorbed_cm3,fcom_x,fcom_y,fcom_z,scom_x,scom_y,scom_z");
        const double end = std::atof(argv[3]);
        for (int n = 1; simulation.state().time < end * (1.0 - 1.0e-9); ++n) {
            simulation.step(std::min(end, n * scene.settings.time.dt));
            print(simulation, scene.settings.liquid.density);
        }
    } catch (const std::exception& error) {
        std::fprintf(stderr, "%s: %s\n", argv[1], error.what());
        return 1;
    }
    return 0;
}
