// Water falls on a sheet of cotton that is held by its corners: pictures of it, as PNG.
#include <drench/frames.h>

#include <cstdio>

int main()
try {
    drench::Scene scene = drench::Scene::parse(R"(
        time: {dt: 1.0e-3}
        grid: {cell: 0.2}
        liquid: {preset: water}
        porous: {fibre_diameter: 0.01, volume_fraction: 0.4}
        materials: {cotton: {young: 1.83e+7, poisson: 0.202, density: 1.32, friction_angle: 30}}
        render:
          size: [800, 600]
          camera: {look_at: [0, -0.3, 0], eye: [2.5, 5, 13], fov: 27}
          liquid: {style: surface, range: [0, 100]}
    )");
    scene.addFabric("sheet",
                    "{cloth_grid: {material: cotton, nodes: [41, 41], spacing: 0.15, origin: [-3, 0, -3], u: [1, 0, 0], v: [0, 0, 1], "
                    "radius: 0.0165}, pin: {corners: all, patch: 2}}");
    scene.add({.shape = drench::ball({0, 1.4, 0}, 1.0), .velocity = {0, -60, 0}});

    drench::Simulation simulation(scene);
    drench::Frames frames(scene);
    for (int n = 0; n <= 10; ++n) {
        simulation.advanceTo(0.01 * n);
        frames.write(simulation, drench::frameFile("frames", n));
        std::printf("%.2f s: the sheet has taken up %.2f g\n", simulation.time(), simulation.read("absorbed"));
    }
} catch (const drench::Error& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
}
