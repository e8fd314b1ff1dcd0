// A drop falls into a pool: a scene without a file, its liquid and its energies.
#include <drench/simulation.h>

#include <algorithm>
#include <cstdio>

int main()
try {
    drench::Scene scene("drop");  // units: cm, s, g
    scene.set("grid.cell", 0.2);
    scene.set("time.dt", 1.0e-3);
    scene.set("transfer", "polypic");
    scene.set("liquid.preset", "water");
    scene.add({.shape = drench::box({-2, 0, -2}, {2, 1.2, 2})});
    scene.add({.shape = drench::ball({0, 3.2, 0}, 0.6), .velocity = {0, -50, 0}});
    scene.add("tank", {.shape = drench::box({-2, 0, -2}, {2, 6, 2}), .inside = true});

    drench::Simulation simulation(scene);
    std::printf("time [s]  highest [cm]  fastest [cm/s]  energy [erg]\n");
    for (int n = 1; n <= 10; ++n) {
        simulation.advanceTo(0.02 * n);

        const drench::Particles liquid = simulation.particles();
        const double highest = *std::max_element(liquid.y.begin(), liquid.y.end());
        std::printf("%8.2f  %12.2f  %14.1f  %12.1f\n", simulation.time(), highest, simulation.read("speed"), simulation.energies().total());
    }
    std::printf("%zu particles, %lld steps, state %016llx\n", simulation.particles().size(), static_cast<long long>(simulation.steps()),
                static_cast<unsigned long long>(simulation.stateHash()));
} catch (const drench::Error& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
}
