// A paddle of one's own makes waves in a channel. A gauge stands at its other end, and the paddle tells what it takes to move it.
#include <drench/simulation.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

/// Turns to and fro about its foot, 10 degrees to each side, twice in a second, and starts gently. Time in s, turn in radians.
drench::Pose paddle(double time)
{
    const double growth = std::min(1.0, 16.0 * time * time);
    return {.turn = {0, 0, 0.17 * growth * std::sin(4.0 * 3.14159265 * time)}, .about = {0, 0, 0}};
}

/// Where the liquid is highest within half a centimetre of a place along the channel [cm].
double heightAt(const drench::Particles& liquid, double x)
{
    double height = 0.0;
    for (std::size_t p = 0; p < liquid.size(); ++p)
        if (std::abs(liquid.x[p] - x) < 0.5) height = std::max(height, liquid.y[p]);
    return height;
}

int main()
{
    drench::Scene scene("channel");  // units: cm, s, g
    scene.set("grid.cell", 0.5);
    scene.set("time.dt", 2.0e-3);
    scene.add({.shape = drench::box({0.5, 0, -1}, {12, 4, 1})});
    scene.add("channel", {.shape = drench::box({-2, 0, -1}, {12, 10, 1}), .inside = true});
    scene.add("paddle", {.shape = drench::box({-0.5, -1, -2}, {0.5, 9, 2}), .motion = paddle});

    drench::Simulation simulation(scene);
    std::printf("time [s]  height at x = 10 [cm]  pressure there at y = 1 [dyn/cm^2]  force on the paddle [dyn]\n");
    for (int n = 1; n <= 12; ++n) {
        simulation.advanceTo(0.05 * n);
        const double height = heightAt(simulation.particles(), 10), pressure = simulation.read("pressure(x, y, z)", {10, 1, 0});
        std::printf("%8.2f  %21.2f  %33.0f  %25.0f\n", simulation.time(), height, pressure, simulation.on("paddle").force.x);
    }
}
